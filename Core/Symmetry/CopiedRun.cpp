// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/CopiedRun.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Evaluation/QuadQuality.h"
#include "Features/CreaseCurves.h"
#include "Features/FeatureFilter.h"
#include "Features/FeatureNetwork.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/SmallDetails.h"
#include "Prepare/Prepare.h"
#include "Prepare/RepairText.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace quadrille
{

/// Sources of the faces of images, in the store.
struct StoredImages
{
  std::vector<Index> face;          ///< per face of an image: of the whole, under it
  std::vector<FaceWeights> weights; ///< of the corners of the image
};

namespace
{

constexpr std::size_t kImageChunk = 1024;
/// Times as many quads as were asked for, at most, where the part is too narrow for them.
constexpr std::size_t kMostTimesQuads = 4;
constexpr FaceWeights kWholeFace{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };

} // namespace

std::string shareText(double share)
{
  std::ostringstream text;
  text << std::setprecision(2) << share;
  return text.str();
}

void requestCutFeatures(Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  std::vector<Index> featuresAt(mesh.vertexCount(), 0);
  std::vector<Index> next;
  const auto take = [&](Index h)
  {
    for (const Index side : { h, mesh.twin[h] })
    {
      mesh.flags.edit()[side] |= kRequestedFeature;
    }
    next.push_back(h);
  };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h) || !mesh.isFeature(h))
    {
      continue;
    }
    ++featuresAt[mesh.origin[h]];
    const double from = plane.height(mesh.position[mesh.origin[h]]);
    const double to = plane.height(mesh.position[mesh.target(h)]);
    if (h < mesh.twin[h] && std::min(from, to) <= tolerance && std::max(from, to) >= -tolerance)
    {
      take(h);
    }
  }
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  while (!next.empty())
  {
    const Index h = next.back();
    next.pop_back();
    for (const Index v : { mesh.origin[h], mesh.target(h) })
    {
      if (featuresAt[v] != 2)
      {
        continue;
      }
      Index g = outgoing[v];
      do
      {
        if (!mesh.isBoundary(g) && mesh.isFeature(g) && (mesh.flags[g] & kRequestedFeature) == 0)
        {
          take(g);
        }
        g = mesh.rotateCounterclockwise(g);
      } while (g != kInvalidIndex && g != outgoing[v]);
    }
  }
}

std::vector<std::uint8_t> irregularOf(const Mesh& mesh, const std::vector<int>& turns)
{
  const std::vector<int> regular = regularTurns(mesh);
  std::vector<std::uint8_t> irregular(regular.size(), 0);
  for (std::size_t v = 0; v < regular.size(); ++v)
  {
    irregular[v] = turns[v] != regular[v] ? 1 : 0;
  }
  return irregular;
}

SymmetricResult CopiedRun::run(SurfaceInput& input)
{
  prepare(input);
  choose();
  cut();
  remeshAndCopy();
  RemeshResult& result = made_.remeshed;
  if (isStopped() && !result.status.ok())
  {
    // With more quads there might have been some.
    throw Cancelled();
  }
  result.notices.insert(result.notices.begin(), notices_.begin(), notices_.end());
  result.reused.insert(result.reused.begin(), reused_.begin(), reused_.end());
  result.stages = laps_.all();
  return std::move(made_);
}

void CopiedRun::prepare(SurfaceInput& input)
{
  const double start = secondsNow();
  report(options_.progress, 0, "Preparing the symmetry");
  checkOptions(options_);
  if (store_ != nullptr)
  {
    key_ =
      KeyMaker(contentHash(input, options_.threads)).add(options_.featureAngle.value_or(0)).key();
    whole_ = store_->find<SearchedSurface>(key_);
  }
  if (whole_ != nullptr)
  {
    checkRequests(input);
    PreparedSurface& surface = whole_->surface;
    surface.valenceRequests.clear();
    surface.unusedValences = 0;
    collectRequests(input, surface, options_.threads);
    reused_.emplace_back("whole");
  }
  else
  {
    PrepareOptions prepareOptions;
    prepareOptions.featureAngle = options_.featureAngle;
    prepareOptions.threads = options_.threads;
    whole_ = std::make_shared<SearchedSurface>(prepareSurface(input, prepareOptions));
    poll();
    if (store_ != nullptr)
    {
      store_->put(key_, whole_, whole_->bytes());
    }
    lap("whole", start, input.polygonOffsets.size() - 1, surface().mesh.faceCount());
  }
  for (const std::string& sentence : repairSentences(surface().repair))
  {
    notices_.push_back("input: " + sentence);
  }
  made_.diagonal = surface().boundingBoxDiagonal;
  tolerance_ = kMirrorTolerance * made_.diagonal;
  input = {};
}

void CopiedRun::tell(const std::string& text, const std::string& help)
{
  if (made_.deviation.rms / made_.diagonal > kLeastSymmetric)
  {
    throw InvalidInput("the surface is not symmetric (" + text + "; the limit is " +
      shareText(kLeastSymmetric) + "): " + help);
  }
  notices_.push_back(text);
}

void CopiedRun::withFeatures(const std::function<void(Mesh&)>& act)
{
  Mesh mesh = whole_->surface.mesh;
  const double sizedArea = mesh.sizing.empty() ? surface().area : quadrille::sizedArea(mesh);
  const double edgeLength = targetEdgeLength(options_, sizedArea, made_.diagonal);
  FeatureFilterReport filtered = removeUnresolvedFeatures(mesh, edgeLength, options_.threads);
  if (judgesCreases(options_))
  {
    removeFalseCreases(mesh, edgeLength, options_.threads, filtered);
  }
  simplifyFeatureNetwork(mesh, edgeLength, filtered);
  act(mesh);
}

/// Where the part is one quad wide, with twice as many quads.
void CopiedRun::remeshAndCopy()
{
  for (std::size_t more = 1;; more *= 2)
  {
    countTry(Try::TwiceTheQuads, more > 1 ? 1 : 0);
    remeshPart(more);
    for (const StageRecord& record : made_.remeshed.stages)
    {
      laps_.add(record.stage, record.seconds, record.elementsIn, record.elementsOut);
    }
    const bool isCrowded = made_.remeshed.status.ok() && !copy();
    const bool hasLed = more > 1 && made_.remeshed.status.ok() && !isCrowded;
    countTryLed(Try::TwiceTheQuads, hasLed ? 1 : 0);
    if (!isCrowded || isStopped() || more == kMostTimesQuads)
    {
      break;
    }
  }
}

void CopiedRun::remeshPart(std::size_t more)
{
  RemeshOptions options = options_;
  options.progress = subProgress(options_.progress, 0.1, 0.95);
  options.knownMap = 0; // it would be that of a whole
  if (maySimplify(options))
  {
    options.smallDetails = SmallDetails::Resolve; // holes on the cuts go through to the other side
  }
  double beside = 0, lengthShare = 1;
  if (options_.quads)
  {
    options.quads = more * ((*options_.quads + copies() - 1) / copies());
    beside = std::round(
      quadsBeside(std::sqrt(surface().area / static_cast<double>(copies() * *options.quads))));
    *options.quads += static_cast<std::size_t>(beside);
  }
  else
  {
    const double asked =
      options_.edgeLength ? *options_.edgeLength : options_.relativeEdgeLength * made_.diagonal;
    options.edgeLength = asked / std::sqrt(static_cast<double>(more));
    beside = quadsBeside(*options.edgeLength);
    const double share =
      surface().area / (static_cast<double>(copies()) * *options.edgeLength * *options.edgeLength);
    if (beside > 0)
    {
      lengthShare = std::sqrt(share / (share + beside));
      *options.edgeLength *= lengthShare;
    }
  }
  options.maximumNumberOfQuads = std::max<std::size_t>(1, options_.maximumNumberOfQuads / copies());
  made_.remeshed =
    store_ != nullptr ? remesh(part_.input, options, *store_) : remesh(part_.input, options);
  made_.remeshed.targetQuads -=
    std::min(static_cast<std::size_t>(beside), made_.remeshed.targetQuads - 1);
  made_.remeshed.targetQuads *= copies();
  made_.remeshed.targetEdgeLength /= lengthShare;
  made_.remeshed.curves = outcomes(made_.remeshed.curves);
}

/// A triangle of the part's surface, in weights of the corners of a face of the whole.
FaceWeights CopiedRun::weightsInWhole(Index f) const
{
  const PreparedSurface& made = made_.remeshed.surface;
  const Index t = made.sourcePolygon[f];
  const FaceWeights corners = part_.cornerWeights(t);
  FaceWeights inPart = kWholeFace;
  if (!made.refinedEntry.empty() && made.refinedEntry[f] != kInvalidIndex)
  {
    inPart = made.cornerWeights[made.refinedEntry[f]];
  }
  FaceWeights weights{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::array<double, 3>& corner = corners[cornerOf(t, made.sourcePoints[f][k])];
      for (std::size_t j = 0; j < 3; ++j)
      {
        weights[i][j] += inPart[i][k] * corner[j];
      }
    }
  }
  return weights;
}

/// Of triangle t of the part: the corner at this point, or, where repair has moved it, the one nearest to it.
std::size_t CopiedRun::cornerOf(Index t, Index point) const
{
  const SurfaceInput& input = part_.input;
  const Vector3& p = input.points[point];
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i)
  {
    const auto distance = [&](std::size_t k)
    { return (input.points[input.polygonPoints[3 * t + k]] - p).squaredNorm(); };
    best = distance(i) < distance(best) ? i : best;
  }
  return best;
}

SourceLocation CopiedRun::locateInWhole(Index f, const std::array<double, 3>& weights) const
{
  const FaceWeights corners = weightsInWhole(f);
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < 3; ++k)
  {
    sum[k] = weights[0] * corners[0][k] + weights[1] * corners[1][k] + weights[2] * corners[2][k];
  }
  return surface().locate(part_.face[made_.remeshed.surface.sourcePolygon[f]], sum);
}

Index CopiedRun::polygonOf(Index f) const
{
  return surface().sourcePolygon[part_.face[made_.remeshed.surface.sourcePolygon[f]]];
}

void CopiedRun::locatePart(const QuadMesh& quads)
{
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    made_.pointSources.push_back(locateInWhole(quads.sourceFace[p], quads.sourceWeights[p]));
  }
  for (const Index f : quads.quadSourceFace)
  {
    made_.quadPolygons.push_back(polygonOf(f));
  }
}

void CopiedRun::takeQuads(DoubledQuads quads, const MirrorFit& fit)
{
  made_.pointSources.insert(made_.pointSources.end(), fit.images.begin(), fit.images.end());
  made_.quadPolygons.insert(
    made_.quadPolygons.end(), fit.quadPolygons.begin(), fit.quadPolygons.end());
  made_.movedPoints = fit.moved;
  made_.farthestMoved = fit.farthest;
  if (fit.moved > 0)
  {
    tellMoved(quads, fit);
  }
  (made_.rotation ? made_.rotatedPoint : made_.mirrorPoint) = std::move(quads.image);
  made_.remeshed.quads = std::move(quads.quads);
}

void CopiedRun::tellMoved(const DoubledQuads& copied, const MirrorFit& fit)
{
  const QuadMesh& quads = copied.quads;
  const std::size_t part = copied.halfQuads;
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
  notices_.push_back(std::to_string(fit.moved) + " " + (made_.rotation ? "turned" : "mirrored") +
    " points were put onto the surface, up to " + shareText(fit.farthest / made_.diagonal) +
    " of the diagonal away, from " + placeText(fit.place) +
    (back > front ? "; " + std::to_string(back - front) +
          " quads there are turned over or flat at a corner: the surface is not symmetric there"
                  : ""));
}

/// The surface of the part and its images, with the map.
void CopiedRun::takeSurface(CopiedMesh copied)
{
  RemeshResult& result = made_.remeshed;
  const StoredImages images = imageSources(copied);
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
    addFace(f, part_.face[result.surface.sourcePolygon[f]], weightsInWhole(f));
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
StoredImages CopiedRun::imageSources(const CopiedMesh& copied)
{
  const ResultKey key = keyOf(combineHashes(key_, made_.remeshed.surface.hash));
  if (const auto stored = store_ != nullptr ? store_->find<StoredImages>(key) : nullptr)
  {
    return *stored;
  }
  StoredImages images;
  const Index count = copied.mesh.faceCount() - copied.partFaces;
  images.face.resize(count);
  images.weights.resize(count);
  parallelFor(count, kImageChunk, options_.threads,
    [&](std::size_t begin, std::size_t end)
    {
      NearImage near;
      for (std::size_t f = begin; f < end; ++f)
      {
        findImageSource(
          copied.mesh, copied.partFaces + static_cast<Index>(f), near, images.weights[f]);
        images.face[f] = near.face;
      }
    });
  if (store_ != nullptr)
  {
    store_->put(
      key, std::make_shared<StoredImages>(images), bytesOf(images.face) + bytesOf(images.weights));
  }
  return images;
}

/// near: of the face before, where it is near.
void CopiedRun::findImageSource(
  const Mesh& mesh, Index f, NearImage& near, FaceWeights& weights) const
{
  const Mesh& whole = surface().mesh;
  std::array<Vector3, 3> corners;
  for (Index i = 0; i < 3; ++i)
  {
    corners[i] = mesh.position[mesh.origin[3 * f + i]];
  }
  const Vector3 centre = (corners[0] + corners[1] + corners[2]) / 3;
  const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!climb(near, centre, normal))
  {
    const auto facing = whole_->faces.at(centre, normal);
    const NearestTriangle::Place place = facing ? *facing : *whole_->faces.at(centre);
    near = { place.triangle, centre, place.distance };
  }
  const Index found = near.face;
  weights = {};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const auto distance = [&](Index k)
    { return (whole.position[whole.origin[3 * found + k]] - corners[i]).squaredNorm(); };
    Index best = 0;
    for (const Index k : { 1U, 2U })
    {
      best = distance(k) < distance(best) ? k : best;
    }
    weights[i][best] = 1;
  }
}

/// From face to face, nearer to the place each time: a small part of the time of a search in the tree, where the
/// place is beside the surface. False where that ends too far away or on the other side of a wall: the distance can
/// have grown by no more than the way from where it was found.
bool CopiedRun::climb(NearImage& near, const Vector3& p, const Vector3& normal) const
{
  if (near.face == kInvalidIndex)
  {
    return false;
  }
  Index face = near.face;
  const Mesh& whole = surface().mesh;
  double distance = whole_->faces.on(face, p).distance;
  for (bool moves = true; moves;)
  {
    moves = false;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      const Index next = whole.isBoundary(h) ? face : Mesh::face(whole.twin[h]);
      const double nearer = whole_->faces.on(next, p).distance;
      if (nearer < distance)
      {
        face = next;
        distance = nearer;
        moves = true;
        break;
      }
    }
  }
  const Vector3 across = whole.edgeVector(3 * face).cross(whole.edgeVector(3 * face + 1));
  const double farther = std::min((p - near.searched).norm(), 2 * made_.deviation.rms);
  const bool isNear = distance <= 1.25 * near.distance + farther + 1e-3 * tolerance_;
  if (isNear && across.dot(normal) > 0)
  {
    near.face = face;
    return true;
  }
  return false;
}

void CopiedRun::certifyWhole()
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
void CopiedRun::ownFrame()
{
  RemeshResult& result = made_.remeshed;
  const std::vector<Vector3>& positions = result.surface.mesh.position;
  Vector3 low = positions.front();
  Vector3 high = low;
  for (const Vector3& p : positions)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  result.frame = {};
  result.frame.centre = low / 2 + high / 2;
  result.frame.unit = (high - low).maxCoeff();
  result.framePositions.clear();
  for (const Vector3& p : positions)
  {
    result.framePositions.push_back(Vector3((p - result.frame.centre) / result.frame.unit));
  }
}

void CopiedRun::tellTopology(const TopologySummary& made, const char* sides)
{
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
    notices_.push_back(std::string(sides) + text(made) + ", but the input has " + text(asked) +
      ": " +
      (copies() == 2 && !made_.rotation
          ? "its two sides are not alike (turn the normal round to keep the other one)"
          : "its parts are not alike"));
  }
}

void CopiedRun::lap(const char* stage, double start, std::size_t in, std::size_t out)
{
  laps_.add(stage, secondsNow() - start, in, out);
}

} // namespace quadrille
