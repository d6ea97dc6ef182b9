// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Symmetry.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Evaluation/QuadQuality.h"
#include "Mesh/ContentHash.h"
#include "Mesh/CreaseCurves.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/FeatureNetwork.h"
#include "Mesh/MirrorCut.h"
#include "Mesh/RepairText.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"
#include "Pipeline/MirrorDouble.h"
#include "Pipeline/MirrorFit.h"
#include "Pipeline/MirrorRequests.h"
#include "Pipeline/SizedSurface.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

constexpr std::size_t kImageChunk = 1024;
/// Times as many quads as were asked for, at most, where the half is too narrow for them.
constexpr std::size_t kMostQuads = 4;
/// The image of a feature may be farther from its counterpart than the image of the surface from the surface.
constexpr double kFeatureReach = 3;

using FaceWeights = std::array<std::array<double, 3>, 3>;
constexpr FaceWeights kWholeFace{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };

/// A plane in the store.
struct StoredPlane
{
  MirrorPlane plane;
  MirrorDeviation deviation;
};

/// Sources of the faces behind the plane, in the store.
struct StoredImages
{
  std::vector<Index> face;          ///< per face of the half: of the whole, under its image
  std::vector<FaceWeights> weights; ///< of the corners of the image
};

ResultKey planeKey(ResultKey surface, const MirrorPlane& plane)
{
  KeyMaker key(surface);
  for (int i = 0; i < 3; ++i)
  {
    key.add(plane.origin[i]).add(plane.normal[i]);
  }
  return key.key();
}

void requirePlane(const MirrorPlane& plane)
{
  const double length = plane.normal.stableNorm();
  if (!plane.origin.allFinite() || !(length > 0 && std::isfinite(length)))
  {
    throw InvalidInput("the normal of the mirror plane must be a finite vector other than zero, "
                       "and its origin finite: give another plane, or have it found");
  }
}

std::string shareText(double share)
{
  std::ostringstream text;
  text << std::setprecision(2) << share;
  return text.str();
}

/// A face under a place, and the last place that was searched for in the tree.
struct NearImage
{
  Index face = kInvalidIndex;
  Vector3 searched = Vector3::Zero();
  double distance = 0; ///< from there
};

/// Gives a mesh other flags for a while.
class FlagsScope
{
public:
  explicit FlagsScope(Mesh& mesh) : mesh_(mesh), before_(mesh.flags) {}
  ~FlagsScope() { mesh_.flags = std::move(before_); }
  FlagsScope(const FlagsScope&) = delete;
  FlagsScope& operator=(const FlagsScope&) = delete;

private:
  Mesh& mesh_;
  std::vector<std::uint8_t> before_;
};

/// Features that meet the plane count as requested, up to where they end or meet others: each half of one may be too
/// short for the quads though it is not as a whole.
void requestCutFeatures(Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  std::vector<Index> featuresAt(mesh.vertexCount(), 0);
  std::vector<Index> next;
  const auto take = [&](Index h)
  {
    for (const Index side : { h, mesh.twin[h] })
    {
      mesh.flags[side] |= kRequestedFeature;
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

/// One run: each step leaves what the next ones need.
class SymmetricRun
{
public:
  SymmetricRun(const RemeshOptions& options, const SymmetryOptions& symmetry, ResultStore* store)
    : options_(options), symmetry_(symmetry), store_(store)
  {
  }

  SymmetricResult run(SurfaceInput& input)
  {
    prepare(input);
    choosePlane();
    cut();
    remeshAndDouble();
    RemeshResult& result = made_.remeshed;
    result.notices.insert(result.notices.begin(), notices_.begin(), notices_.end());
    result.reused.insert(result.reused.begin(), reused_.begin(), reused_.end());
    result.stages = laps_.all();
    return std::move(made_);
  }

private:
  const PreparedSurface& surface() const { return whole_->surface; }

  MirrorTask task() const
  {
    return { *whole_, made_.plane, tolerance_, made_.deviation.maximum, options_.threads };
  }

  void prepare(SurfaceInput& input)
  {
    const double start = secondsNow();
    report(options_.progress, 0, "Preparing the mirror symmetry");
    checkOptions(options_);
    if (symmetry_.plane)
    {
      requirePlane(*symmetry_.plane);
    }
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

  void choosePlane()
  {
    const double start = secondsNow();
    report(options_.progress, 0.02, "Looking for the mirror plane");
    std::optional<MirrorPlane> given = symmetry_.plane;
    if (given)
    {
      given->normal.stableNormalize();
    }
    const ResultKey key = given ? planeKey(key_, *given) : KeyMaker(key_).add(1.0).key();
    auto stored = store_ != nullptr ? store_->find<StoredPlane>(key) : nullptr;
    if (stored == nullptr)
    {
      stored = std::make_shared<StoredPlane>();
      stored->plane = given ? *given : findMirrorPlane(whole_->faces, options_.threads);
      stored->deviation = mirrorDeviation(whole_->faces, stored->plane, options_.threads);
      if (store_ != nullptr)
      {
        store_->put(key, stored, sizeof(StoredPlane));
      }
      lap("plane", start, surface().mesh.faceCount(), 1);
    }
    else
    {
      reused_.emplace_back("plane");
    }
    made_.plane = stored->plane;
    made_.deviation = stored->deviation;
    tellPlane();
  }

  void tellPlane()
  {
    const MirrorDeviation& deviation = made_.deviation;
    const double rms = deviation.rms / made_.diagonal;
    const std::string text = std::string("mirror plane ") + (symmetry_.plane ? "given" : "found") +
      ": through " + placeText(made_.plane.origin) + " with normal " +
      placeText(made_.plane.normal) + "; the mirror image is " + shareText(rms) +
      " of the diagonal from the surface in the mean (root of squares), and at most " +
      shareText(deviation.maximum / made_.diagonal) + ", for " + placeText(deviation.place);
    if (rms > kLeastSymmetric)
    {
      throw InvalidInput("the surface is not symmetric (" + text + "; the limit is " +
        shareText(kLeastSymmetric) + "): give another plane, or switch the symmetry off");
    }
    notices_.push_back(text);
  }

  void cut()
  {
    const double start = secondsNow();
    report(options_.progress, 0.08, "Cutting the surface in half");
    double front = 0, back = 0;
    for (const Vector3& p : surface().mesh.position)
    {
      front = std::max(front, made_.plane.height(p));
      back = std::min(back, made_.plane.height(p));
    }
    if (!(front > tolerance_ && back < -tolerance_))
    {
      throw InvalidInput(std::string("nothing of the surface lies ") +
        (front > tolerance_ ? "behind" : "in front of") + " the mirror plane through " +
        placeText(made_.plane.origin) + " with normal " + placeText(made_.plane.normal) +
        ": move the plane, or have it found");
    }
    Mesh& mesh = whole_->surface.mesh;
    {
      const FlagsScope scope(mesh);
      const double sizedArea = mesh.sizing.empty() ? surface().area : quadrille::sizedArea(mesh);
      const double edgeLength = targetEdgeLength(options_, sizedArea, made_.diagonal);
      FeatureFilterReport filtered = removeUnresolvedFeatures(mesh, edgeLength);
      if (judgesCreases(options_))
      {
        removeFalseCreases(mesh, edgeLength, options_.threads, filtered);
      }
      simplifyFeatureNetwork(mesh, edgeLength, filtered);
      requestCutFeatures(mesh, made_.plane, tolerance_);
      half_ = cutByMirror(mesh, made_.plane, tolerance_);
    }
    for (const std::string& notice : askOfHalf(task(), half_))
    {
      notices_.push_back(notice);
    }
    curves_ = askCurvesOfHalf(task());
    half_.input.curves = curves_.curves;
    half_.input.regularElsewhere = surface().regularElsewhere;
    lap("cut", start, surface().mesh.faceCount(), half_.face.size());
  }

  /// Where the half is one quad wide from plane to plane, with twice as many quads.
  void remeshAndDouble()
  {
    for (std::size_t more = 1;; more *= 2)
    {
      remeshHalf(more);
      for (const StageRecord& record : made_.remeshed.stages)
      {
        laps_.add(record.stage, record.seconds, record.elementsIn, record.elementsOut);
      }
      const bool isCrowded = made_.remeshed.status.ok() && !doubleUp();
      if (!isCrowded || more == kMostQuads)
      {
        break;
      }
    }
  }

  void remeshHalf(std::size_t more)
  {
    RemeshOptions options = options_;
    options.progress = subProgress(options_.progress, 0.1, 0.95);
    options.knownMap = 0; // it would be that of a whole
    if (maySimplify(options))
    {
      options.smallDetails = SmallDetails::Resolve; // holes in the plane are cuts through the whole
    }
    if (options_.quads)
    {
      options.quads = more * ((*options_.quads + 1) / 2);
    }
    else
    {
      const double asked =
        options_.edgeLength ? *options_.edgeLength : options_.relativeEdgeLength * made_.diagonal;
      options.edgeLength = asked / std::sqrt(static_cast<double>(more));
    }
    options.maximumNumberOfQuads = std::max<std::size_t>(1, options_.maximumNumberOfQuads / 2);
    made_.remeshed =
      store_ != nullptr ? remesh(half_.input, options, *store_) : remesh(half_.input, options);
    made_.remeshed.targetQuads *= 2;
    made_.remeshed.curves = outcomesOfWhole(task(), curves_, made_.remeshed.curves);
  }

  /// Whether the quads and their images are a mesh.
  bool doubleUp()
  {
    const double start = secondsNow();
    report(options_.progress, 0.95, "Mirroring the quads");
    RemeshResult& result = made_.remeshed;
    const DoubledMesh doubled = doubleMesh(result.surface.mesh, made_.plane, tolerance_);
    DoubledQuads quads = doubleQuads(result.quads, doubled, made_.plane);
    result.status = quads.status;
    if (!quads.status.ok())
    {
      notices_.push_back(quads.status.message);
      result.quads = {};
      return false;
    }
    locateHalf(result.quads);
    const MirrorFit fit = fitImages(quads, *whole_, tolerance_,
      kFeatureReach * made_.deviation.maximum + tolerance_, options_.threads);
    takeQuads(std::move(quads), fit);
    doubleSurface(doubled);
    tellTopology(doubled.mesh);
    lap("mirror", start, result.quads.quads.size() / 2, result.quads.quads.size());
    return true;
  }

  /// A triangle of the surface in front, in weights of the corners of a face of the whole.
  FaceWeights weightsInWhole(Index f) const
  {
    const PreparedSurface& made = made_.remeshed.surface;
    const Index t = made.sourcePolygon[f];
    const FaceWeights corners = half_.cornerWeights(surface().mesh, t);
    FaceWeights inHalf = kWholeFace;
    if (!made.refinedEntry.empty() && made.refinedEntry[f] != kInvalidIndex)
    {
      inHalf = made.cornerWeights[made.refinedEntry[f]];
    }
    FaceWeights weights{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const std::array<double, 3>& corner = corners[cornerOf(t, made.sourcePoints[f][k])];
        for (std::size_t j = 0; j < 3; ++j)
        {
          weights[i][j] += inHalf[i][k] * corner[j];
        }
      }
    }
    return weights;
  }

  /// Of triangle t of the half: the corner at this point, or, where repair has moved it, the one nearest to it.
  std::size_t cornerOf(Index t, Index point) const
  {
    const SurfaceInput& input = half_.input;
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

  SourceLocation locateInWhole(Index f, const std::array<double, 3>& weights) const
  {
    const FaceWeights corners = weightsInWhole(f);
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      sum[k] = weights[0] * corners[0][k] + weights[1] * corners[1][k] + weights[2] * corners[2][k];
    }
    return surface().locate(half_.face[made_.remeshed.surface.sourcePolygon[f]], sum);
  }

  Index polygonOf(Index f) const
  {
    return surface().sourcePolygon[half_.face[made_.remeshed.surface.sourcePolygon[f]]];
  }

  void locateHalf(const QuadMesh& quads)
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

  void takeQuads(DoubledQuads quads, const MirrorFit& fit)
  {
    made_.pointSources.insert(made_.pointSources.end(), fit.images.begin(), fit.images.end());
    made_.quadPolygons.insert(
      made_.quadPolygons.end(), fit.quadPolygons.begin(), fit.quadPolygons.end());
    made_.mirrorPoint = std::move(quads.image);
    made_.movedPoints = fit.moved;
    made_.farthestMoved = fit.farthest;
    if (fit.moved > 0)
    {
      tellMoved(quads.quads, fit);
    }
    made_.remeshed.quads = std::move(quads.quads);
  }

  void tellMoved(const QuadMesh& quads, const MirrorFit& fit)
  {
    const std::size_t half = quads.quads.size() / 2;
    const auto inverted = [&](std::size_t first)
    {
      const auto begin = quads.quads.begin() + static_cast<std::ptrdiff_t>(first);
      return evaluateQuads(quads.points, { begin, begin + static_cast<std::ptrdiff_t>(half) })
        .nonPositiveJacobians;
    };
    const std::size_t front = inverted(0);
    const std::size_t back = inverted(half);
    made_.isAlike = back <= front;
    notices_.push_back(std::to_string(fit.moved) +
      " mirrored points were put onto the surface, up to " +
      shareText(fit.farthest / made_.diagonal) + " of the diagonal away, from " +
      placeText(fit.place) +
      (back > front ? "; " + std::to_string(back - front) +
            " quads there are turned over or flat at a corner: the surface is not symmetric there"
                    : ""));
  }

  /// The surface in front and its image, with the map.
  void doubleSurface(const DoubledMesh& doubled)
  {
    RemeshResult& result = made_.remeshed;
    const StoredImages images = imageSources(doubled);
    PreparedSurface both;
    const Index half = doubled.halfFaces;
    both.refinedEntry.assign(2 * std::size_t{ half }, kInvalidIndex);
    const auto addFace = [&](Index f, Index inWhole, const FaceWeights& weights)
    {
      both.sourcePolygon.push_back(surface().sourcePolygon[inWhole]);
      both.sourcePoints.push_back(surface().sourcePoints[inWhole]);
      if (weights != kWholeFace)
      {
        both.refinedEntry[f] = static_cast<Index>(both.cornerWeights.size());
        both.cornerWeights.push_back(weights);
      }
    };
    for (Index f = 0; f < half; ++f)
    {
      pollNowAndThen(f);
      addFace(f, half_.face[result.surface.sourcePolygon[f]], weightsInWhole(f));
    }
    for (Index f = 0; f < half; ++f)
    {
      pollNowAndThen(f);
      addFace(half + f, images.face[f], images.weights[f]);
    }
    both.mesh = doubled.mesh;
    both.repair = surface().repair;
    both.repair.refinedFaces += result.surface.repair.refinedFaces;
    both.repair.closedHandles += result.surface.repair.closedHandles;
    both.repair.filledHoles += result.surface.repair.filledHoles;
    both.facets = result.surface.facets;
    both.area = 2 * result.surface.area;
    both.boundingBoxDiagonal = made_.diagonal;
    both.hash = planeKey(result.surface.hash, made_.plane);
    result.surface = std::move(both);
    result.uv = doubleMap(doubled, std::move(result.uv));
    result.turns = doubleTurns(doubled, result.turns);
    result.mapKey = planeKey(result.mapKey, made_.plane);
    certifyWhole();
    if (options_.mergeCharts)
    {
      result.charts = mergeCharts(result.surface.mesh, result.uv);
      ownFrame();
    }
  }

  /// Of the images of the half's faces: the face of the whole under the centre, and the nearest of its corners.
  StoredImages imageSources(const DoubledMesh& doubled)
  {
    const ResultKey key = planeKey(combineHashes(key_, made_.remeshed.surface.hash), made_.plane);
    if (const auto stored = store_ != nullptr ? store_->find<StoredImages>(key) : nullptr)
    {
      return *stored;
    }
    StoredImages images;
    images.face.resize(doubled.halfFaces);
    images.weights.resize(doubled.halfFaces);
    parallelFor(doubled.halfFaces, kImageChunk, options_.threads,
      [&](std::size_t begin, std::size_t end)
      {
        NearImage near;
        for (std::size_t f = begin; f < end; ++f)
        {
          findImageSource(
            doubled.mesh, doubled.halfFaces + static_cast<Index>(f), near, images.weights[f]);
          images.face[f] = near.face;
        }
      });
    if (store_ != nullptr)
    {
      store_->put(key, std::make_shared<StoredImages>(images),
        bytesOf(images.face) + bytesOf(images.weights));
    }
    return images;
  }

  /// near: of the face before, where it is near.
  void findImageSource(const Mesh& mesh, Index f, NearImage& near, FaceWeights& weights) const
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
  bool climb(NearImage& near, const Vector3& p, const Vector3& normal) const
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

  void certifyWhole()
  {
    RemeshResult& result = made_.remeshed;
    if (options_.method == MapMethod::Seamless)
    {
      return; // nothing of it is whole, and what the half has is what its image has
    }
    const std::vector<int> regular = regularTurns(result.surface.mesh);
    std::vector<std::uint8_t> integer(regular.size(), 0);
    for (std::size_t v = 0; v < regular.size(); ++v)
    {
      integer[v] = result.turns[v] != regular[v] ? 1 : 0;
    }
    result.certificate =
      certify(result.surface.mesh, result.uv, result.turns, integer, options_.threads);
  }

  /// The map is as good in any frame: that of the box, with nothing turned.
  void ownFrame()
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
      result.framePositions.emplace_back((p - result.frame.centre) / result.frame.unit);
    }
  }

  void tellTopology(const Mesh& mesh)
  {
    const TopologySummary made = summarizeTopology(mesh, options_.threads);
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
      notices_.push_back("the half in front of the mirror plane and its image have " + text(made) +
        ", but the input has " + text(asked) +
        ": its two sides are not alike (turn the normal round to keep the other one)");
    }
  }

  void lap(const char* stage, double start, std::size_t in, std::size_t out)
  {
    laps_.add(stage, secondsNow() - start, in, out);
  }

  const RemeshOptions& options_;
  const SymmetryOptions& symmetry_;
  ResultStore* store_;
  ResultKey key_ = 0;
  double tolerance_ = 0;
  std::shared_ptr<SearchedSurface> whole_;
  MirrorHalf half_;
  HalfCurves curves_;
  SymmetricResult made_;
  std::vector<std::string> notices_, reused_;
  StageRecords laps_;
};

} // namespace

SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store)
{
  PollScope poll(options.progress);
  RemeshOptions ownOptions = options;
  ownOptions.progress = poll.callback();
  try
  {
    return SymmetricRun(ownOptions, symmetry, store).run(input);
  }
  catch (const Cancelled&)
  {
    SymmetricResult stopped;
    stopped.remeshed.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
    return stopped;
  }
}

} // namespace quadrille
