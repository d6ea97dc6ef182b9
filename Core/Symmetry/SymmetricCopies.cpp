// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// From the quads of the part to those of the whole: SymmetryRun::copy.
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Evaluation/QuadQuality.h"
#include "Mesh/ContentHash.h"
#include "Mesh/PointSets.h"
#include "Symmetry/MidLine.h"
#include "Symmetry/PartSources.h"
#include "Symmetry/Seams.h"
#include "Symmetry/SymmetryRun.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace quadrille
{

namespace
{

/// Of quads the part, for its sources only.
QuadMesh partOf(const CopiedQuads& copied)
{
  QuadMesh part;
  const QuadMesh& all = copied.quads;
  const auto first = [](const auto& values, std::size_t count)
  { return std::vector(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)); };
  part.points = first(all.points, copied.partPoints);
  part.sourceFace = first(all.sourceFace, copied.partPoints);
  part.sourceWeights = first(all.sourceWeights, copied.partPoints);
  part.quadSourceFace = first(all.quadSourceFace, copied.partQuads);
  return part;
}

} // namespace

bool SymmetryRun::copy()
{
  const double start = secondsNow();
  report(options_.progress, 0.95, isMirror() ? "Mirroring the quads" : "Turning the quads");
  RemeshResult& result = made_.remeshed;
  result.givenUpFeatures.insert(
    result.givenUpFeatures.end(), asked_.givenUp.begin(), asked_.givenUp.end());
  CopiedMesh whole = copyMesh(result.surface.mesh, result.turns, isometry_, tolerance_);
  QuadMesh part = std::move(result.quads);
  result.quads = {};
  CutQuads cut;
  std::vector<std::uint8_t> moved(part.points.size(), 0);
  CopiedQuads quads;
  if (asked_.midLine)
  {
    quads = quadsAcross(result, options_, isometry_, whole);
    part = partOf(quads);
    moved.assign(part.points.size(), 0);
  }
  else
  {
    if (isMirror())
    {
      cut = cutInPlane(part, whole);
    }
    else
    {
      WedgeSeams seams = pairSeams(part, result.surface.mesh, part_.input.seams, isometry_);
      if (!seams.status.ok())
      {
        result.status = seams.status;
        return true;
      }
      cut = cutAlongSeams(part, std::move(seams.pairs));
      moved = fitSeams(part, cut, isometry_, *whole_, tolerance_);
    }
    quads = copyQuads(part, whole, cut, isometry_);
  }
  result.status = quads.status;
  if (!quads.status.ok())
  {
    return false;
  }
  locatePart(part, cut, moved);
  takeQuads(std::move(quads));
  if (!asked_.midLine)
  {
    whole.uv = copyMap(whole, isometry_, std::move(result.uv));
  }
  takeSurface(std::move(whole));
  tellTopology();
  const std::size_t count = result.quads.quads.size();
  lap(isMirror() ? "mirror" : "turn", start, count / copies(), count);
  return true;
}

/// Where the points and quads of the part lie on the input. Of two points that are each other's images, on both sides
/// of a wedge, the second one is that of the next wedge.
void SymmetryRun::locatePart(
  const QuadMesh& part, const CutQuads& cut, const std::vector<std::uint8_t>& moved)
{
  const PartSources sources(*whole_, part_, made_.remeshed.surface);
  std::vector<std::uint8_t> isOfNext(part.points.size(), 0);
  for (const SamePoints& pair : cut.pairs)
  {
    isOfNext[pair.second] = pair.first != pair.second ? 1 : 0;
  }
  for (std::size_t p = 0; p < part.points.size(); ++p)
  {
    if (isOfNext[p] == 0 && moved[p] == 0)
    {
      made_.pointSources.push_back(sources.locate(part.sourceFace[p], part.sourceWeights[p]));
    }
    else if (isOfNext[p] == 0)
    {
      const NearestTriangle::Place place = *whole_->faces.at(part.points[p]);
      made_.pointSources.push_back(surface().locate(place.triangle, place.weights));
    }
  }
  for (const Index f : part.quadSourceFace)
  {
    made_.quadPolygons.push_back(surface().sourcePolygon[sources.faceOf(f)]);
  }
}

/// Images are put onto the surface.
void SymmetryRun::takeQuads(CopiedQuads quads)
{
  const FittedImages fit = fitImages(quads, *whole_, tolerance_,
    kReachOfDeviation * made_.deviation.maximum + tolerance_, options_.threads);
  made_.pointSources.insert(made_.pointSources.end(), fit.images.begin(), fit.images.end());
  made_.quadPolygons.insert(
    made_.quadPolygons.end(), fit.quadPolygons.begin(), fit.quadPolygons.end());
  made_.movedPoints = fit.moved;
  made_.farthestMoved = fit.farthest;
  if (fit.moved > 0)
  {
    tellMoved(quads, fit);
  }
  (isMirror() ? made_.mirrorPoint : made_.rotatedPoint) = std::move(quads.image);
  made_.remeshed.quads = std::move(quads.quads);
}

void SymmetryRun::tellMoved(const CopiedQuads& copied, const FittedImages& fit)
{
  const QuadMesh& quads = copied.quads;
  const std::size_t part = copied.partQuads;
  const auto inverted = [&](std::size_t first, std::size_t count)
  {
    const auto begin = quads.quads.begin() + static_cast<std::ptrdiff_t>(first);
    return evaluateQuads(quads.points, { begin, begin + static_cast<std::ptrdiff_t>(count) })
      .nonPositiveJacobians;
  };
  const std::size_t images = quads.quads.size() - part;
  const std::size_t front = inverted(0, part) * (images / part);
  const std::size_t back = inverted(part, images);
  made_.isAlike = back <= front;
  told_.notices.push_back(std::to_string(fit.moved) + " " + (isMirror() ? "mirrored" : "turned") +
    " points were put onto the surface, up to " + shareText(fit.farthest / made_.diagonal) +
    " of the diagonal away, from " + placeText(fit.place) +
    (back > front ? "; " + std::to_string(back - front) +
          " quads there are turned over or flat at a corner: the surface is not symmetric there"
                  : ""));
}

/// The surface of the part and its images, with the map.
void SymmetryRun::takeSurface(CopiedMesh copied)
{
  RemeshResult& result = made_.remeshed;
  const ImageSources images = imageSources(copied);
  const PartSources sources(*whole_, part_, result.surface);
  PreparedSurface all;
  const Index part = copied.partFaces;
  all.refinedEntry.assign(copied.mesh.faceCount(), kInvalidIndex);
  const auto addFace = [&](Index f, Index inWhole, const FaceWeights& weights)
  {
    all.sourcePolygon.push_back(surface().sourcePolygon[inWhole]);
    all.sourcePoints.push_back(surface().sourcePoints[inWhole]);
    if (weights != kWholeFace)
    {
      all.refinedEntry.edit()[f] = static_cast<Index>(all.cornerWeights.size());
      all.cornerWeights.push_back(weights);
    }
  };
  for (Index f = 0; f < part; ++f)
  {
    pollNowAndThen(f);
    addFace(f, sources.faceOf(f), sources.weightsOf(f));
  }
  for (Index f = part; f < copied.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    addFace(f, images.face[f - part], images.weights[f - part]);
  }
  all.mesh = std::move(copied.mesh);
  all.repair = surface().repair;
  all.repair.refinedFaces += result.surface.repair.refinedFaces;
  all.repair.closedHandles += result.surface.repair.closedHandles;
  all.repair.filledHoles += result.surface.repair.filledHoles;
  all.facets = result.surface.facets;
  all.area = static_cast<double>(copies()) * result.surface.area;
  all.boundingBoxDiagonal = made_.diagonal;
  all.hash = keyOf(result.surface.hash);
  result.surface = std::move(all);
  result.uv = std::move(copied.uv);
  result.turns = std::move(copied.turns);
  result.mapKey = keyOf(result.mapKey);
  certifyWhole();
  if (options_.mergeCharts)
  {
    result.charts = mergeCharts(result.surface.mesh, result.uv);
    ownFrame();
  }
}

/// Of the images of the part's faces: the face of the whole under the centre, and the nearest of its corners.
ImageSources SymmetryRun::imageSources(const CopiedMesh& copied) const
{
  const PreparedSurface& made = made_.remeshed.surface;
  const ResultKey key = keyOf(combineHashes(key_, made.hash));
  if (const auto stored = store_ != nullptr ? store_->find<ImageSources>(key) : nullptr)
  {
    return *stored;
  }
  ImageSources images = PartSources(*whole_, part_, made)
                          .ofImages(copied, made_.deviation.rms, tolerance_, options_.threads);
  if (store_ != nullptr)
  {
    store_->put(
      key, std::make_shared<ImageSources>(images), bytesOf(images.face) + bytesOf(images.weights));
  }
  return images;
}

void SymmetryRun::certifyWhole()
{
  RemeshResult& result = made_.remeshed;
  if (options_.method == MapMethod::Seamless)
  {
    return; // nothing of it is whole, and what the part has is what its images have
  }
  result.certificate = certify(result.surface.mesh, result.uv, result.turns,
    irregularOf(result.surface.mesh, result.turns), options_.threads);
}

/// The map is as good in any frame: that of the box, with nothing turned.
void SymmetryRun::ownFrame()
{
  RemeshResult& result = made_.remeshed;
  const std::vector<Vector3>& positions = result.surface.mesh.position;
  const PointBox box = boxOfPoints(positions, options_.threads);
  result.frame = {};
  result.frame.centre = box.low / 2 + box.high / 2;
  result.frame.unit = (box.high - box.low).maxCoeff();
  result.framePositions.clear();
  for (const Vector3& p : positions)
  {
    result.framePositions.push_back(Vector3((p - result.frame.centre) / result.frame.unit));
  }
}

/// Of the surface, or, where it is not joined, of the quads.
TopologySummary SymmetryRun::madeTopology() const
{
  const RemeshResult& result = made_.remeshed;
  if (isMirror())
  {
    return summarizeTopology(result.surface.mesh, options_.threads);
  }
  const QuadQuality quality = evaluateQuads(result.quads.points, result.quads.quads);
  TopologySummary made;
  made.components = static_cast<Index>(quality.components);
  made.boundaryLoops = static_cast<Index>(quality.boundaryLoops);
  made.eulerCharacteristic = quality.eulerCharacteristic;
  return made;
}

void SymmetryRun::tellTopology()
{
  const TopologySummary made = madeTopology();
  const TopologySummary asked = summarizeTopology(surface().mesh, options_.threads);
  const auto closed = static_cast<long long>(2 * made.components) - made.eulerCharacteristic -
    static_cast<long long>(made.boundaryLoops);
  made_.remeshed.smallParts.handles = static_cast<std::size_t>(std::max(0LL, closed / 2));
  made_.remeshed.surface.components = made.components;
  if (made.components != asked.components || made.boundaryLoops != asked.boundaryLoops ||
    made.eulerCharacteristic != asked.eulerCharacteristic)
  {
    const auto text = [](const TopologySummary& topology)
    {
      return std::to_string(topology.components) + " components, " +
        std::to_string(topology.boundaryLoops) + " boundary loops and Euler characteristic " +
        std::to_string(topology.eulerCharacteristic);
    };
    made_.isAlike = false;
    told_.notices.push_back(
      std::string(isMirror() ? "the half in front of the mirror plane and its image have "
                             : "the turned quads have ") +
      text(made) + ", but the input has " + text(asked) + ": " +
      (isMirror() ? "its two sides are not alike (turn the normal round to keep the other one)"
                  : "its parts are not alike"));
  }
}

} // namespace quadrille
