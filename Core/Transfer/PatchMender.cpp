// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchMender.h"

#include "Base/ChartRotation.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "GridMap/MapCheck.h"
#include "Numerics/Untangler.h"
#include "Transfer/ConeStart.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace quadrille
{

namespace
{

/// Rings of faces round the inverted ones, in the order of the attempts.
constexpr std::array<int, 4> kGrowth{ 2, 4, 8, 16 };
constexpr std::size_t kMaximumPatchFaces = 10000;
/// Faces times steps of the untangler: of one try, and of all tries besides half the faces of the mesh.
constexpr std::size_t kWorkPerTry = 200000;
constexpr std::size_t kMaximumWork = 1000000;
constexpr std::size_t kLeastSteps = 30;
constexpr std::size_t kMostUntanglingSteps = 250;
/// References flatter than this (2 area / longest edge squared) are replaced by equilateral ones.
constexpr double kFlattestReference = 0.1;
/// Faces of a chunk of the pass over the mesh; their uv fit a second level cache.
constexpr std::size_t kMendChunk = 1 << 14;
/// Defects that a wrong winding of positive triangles counts for.
constexpr std::size_t kLostTurn = 16;
/// A patch vertex with more faces than this stays where it is.
constexpr std::size_t kMaximumFan = 256;

/// Which shapes the untangler aims at: those of the surface, or, where slivers keep it from converging, the same
/// for all triangles.
enum class Reference
{
  Surface,
  Equilateral
};

/// How a vertex of a patch may move.
enum class Freedom
{
  Fixed,
  AlongU, ///< in the chart of its first corner
  AlongV,
  Plane
};

/// A corner of a vertex and the rotation from the chart of the fan's first corner to its own.
struct FanCorner
{
  Index corner = 0;
  int rotation = 0;
};

class PatchMender
{
public:
  PatchMender(const Mesh& mesh, std::vector<FixedVec2>& uv, const std::vector<int>& expectedTurns,
    int threads)
    : mesh_(mesh), uv_(uv), expectedTurns_(expectedTurns), threads_(threads),
      inPatch_(mesh.faceCount(), 0), seenVertex_(mesh.vertexCount(), 0), tried_(mesh.faceCount(), 0)
  {
  }

  MendResult run(const ProgressCallback& progress);

private:
  bool isPositive(Index f) const
  {
    return determinant(uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2]) > 0;
  }
  /// Quadrants entered in the corners of a face; a degenerate one counts like an inverted one.
  std::array<std::int8_t, 3> enteredBy(Index f) const
  {
    return quadrantsEnteredByAll(&uv_[3 * f], isPositive(f) ? 1 : -1);
  }
  std::vector<Index> findSeeds() const;
  std::vector<int> countTurns() const;
  int turnsRound(Index corner) const;
  bool isDefect(Index f) const;
  std::vector<Index> seedsLeft(std::vector<Index> seeds);
  bool mendAround(Index seed, int rings);
  void collectCluster(Index seed);
  void growPatch();
  void addFacesAround(Index corner);
  std::size_t countDefectsInPatch() const;

  bool embedPatch();
  bool embedRoundCone();
  int mostSteps() const;
  std::size_t placeInPatch(Index f) const;
  bool embedFrom(const UntangleProblem& problem, const Eigen::VectorXd& start);
  void collectFans();
  void addFan(Index corner);
  bool walkFan(Index corner, std::vector<FanCorner>& fan, bool& interior) const;
  Freedom freedomOf(const std::vector<FanCorner>& fan, bool interior, bool closes) const;
  UntangleProblem makeProblem(Reference reference) const;
  Eigen::Matrix2d inverseReference(Index f, double scale) const;
  double referenceScale(double& imageArea) const;
  void applyDisplacements(const Eigen::VectorXd& y);

  struct PatchVertex
  {
    Freedom freedom = Freedom::Fixed;
    bool interior = false;
    std::size_t firstFan = 0; ///< range of fans_
    std::size_t fanCount = 0;
    int firstUnknown = 0;
  };

  const Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
  const std::vector<int>& expectedTurns_;
  int threads_;
  std::vector<std::uint8_t> inPatch_;
  std::vector<std::uint8_t> seenVertex_;
  std::vector<std::uint8_t> tried_; ///< faces that were in a cluster of this growth, or touched one
  std::vector<Index> patch_;        ///< faces, sorted
  std::vector<Index> changed_;      ///< faces of the patches that were improved in this growth
  std::vector<PatchVertex> vertices_;
  std::vector<FanCorner> fans_;
  int unknowns_ = 0;
  std::size_t work_ = 0; ///< faces times steps of all tries
};

/// All corners of the vertex of `corner`, counterclockwise, for a boundary vertex from its boundary half-edge on.
/// Fails for an absurdly large fan.
bool collectCorners(const Mesh& mesh, Index corner, std::vector<Index>& corners, bool& interior)
{
  Index first = corner;
  interior = true;
  for (Index h = mesh.rotateClockwise(corner); h != corner; h = mesh.rotateClockwise(h))
  {
    if (h == kInvalidIndex)
    {
      interior = false;
      break;
    }
    first = h;
  }
  if (interior)
  {
    first = corner;
  }
  corners.clear();
  Index h = first;
  do
  {
    corners.push_back(h);
    h = mesh.rotateCounterclockwise(h);
  } while (h != first && h != kInvalidIndex && corners.size() < kMaximumFan);
  return corners.size() < kMaximumFan;
}

/// Calls visit(c) for every corner of the vertex of `corner`.
template <typename Visit>
void forEachCorner(const Mesh& mesh, Index corner, Visit visit)
{
  Index h = corner;
  do
  {
    visit(h);
    h = mesh.rotateCounterclockwise(h);
  } while (h != kInvalidIndex && h != corner);
  if (h == kInvalidIndex)
  {
    for (h = mesh.rotateClockwise(corner); h != kInvalidIndex; h = mesh.rotateClockwise(h))
    {
      visit(h);
    }
  }
}

MendResult PatchMender::run(const ProgressCallback& progress)
{
  // Small patches of all places come first, so that a hopeless place does not use up the work of the others.
  MendResult result;
  std::vector<Index> seeds = findSeeds();
  const std::size_t limit = kMaximumWork + mesh_.faceCount() / 2;
  for (std::size_t growth = 0; growth < kGrowth.size() && !seeds.empty(); ++growth)
  {
    std::fill(tried_.begin(), tried_.end(), std::uint8_t{ 0 });
    for (const Index f : seeds)
    {
      report(progress, double(growth) / double(kGrowth.size()), "mending the map");
      if (work_ < limit && tried_[f] == 0)
      {
        result.patches += mendAround(f, kGrowth[growth]) ? 1U : 0U;
      }
    }
    seeds = seedsLeft(std::move(seeds));
  }
  std::vector<Index> bad;
  std::copy_if(
    seeds.begin(), seeds.end(), std::back_inserter(bad), [&](Index f) { return !isPositive(f); });
  result.notPositive = bad.size();
  // A wrong winding beside an inverted triangle is the same defect; the triangle tells where room is missing.
  result.defects = bad.empty() ? std::move(seeds) : bad;
  return result;
}

/// Faces to mend around: those that are not positive and those at a vertex of wrong turns.
std::vector<Index> PatchMender::findSeeds() const
{
  const std::vector<int> turns = countTurns();
  std::vector<std::vector<Index>> parts((mesh_.faceCount() + kMendChunk - 1) / kMendChunk);
  parallelFor(mesh_.faceCount(), kMendChunk, threads_,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        bool defect = !isPositive(static_cast<Index>(f));
        for (std::size_t h = 3 * f; h < 3 * f + 3; ++h)
        {
          defect = defect || turns[mesh_.origin[h]] != expectedTurns_[mesh_.origin[h]];
        }
        if (defect)
        {
          parts[begin / kMendChunk].push_back(static_cast<Index>(f));
        }
      }
    });
  std::vector<Index> seeds;
  for (const std::vector<Index>& part : parts)
  {
    seeds.insert(seeds.end(), part.begin(), part.end());
  }
  return seeds;
}

std::vector<int> PatchMender::countTurns() const
{
  std::vector<std::int8_t> entered(mesh_.halfEdgeCount());
  parallelFor(mesh_.faceCount(), kMendChunk, threads_,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        const std::array<std::int8_t, 3> corners = enteredBy(static_cast<Index>(f));
        std::copy(corners.begin(), corners.end(), &entered[3 * f]);
      }
    });
  std::vector<int> turns(mesh_.vertexCount(), 0);
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    turns[mesh_.origin[h]] += entered[h];
  }
  return turns;
}

/// Quarter turns round the vertex of a corner, by walking its fan.
int PatchMender::turnsRound(Index corner) const
{
  int turns = 0;
  forEachCorner(mesh_, corner, [&](Index h) { turns += enteredBy(Mesh::face(h))[h % 3]; });
  return turns;
}

bool PatchMender::isDefect(Index f) const
{
  bool defect = !isPositive(f);
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    defect = defect || turnsRound(h) != expectedTurns_[mesh_.origin[h]];
  }
  return defect;
}

/// What findSeeds would find now, from the seeds before and from the patches that changed since.
std::vector<Index> PatchMender::seedsLeft(std::vector<Index> seeds)
{
  for (const Index f : changed_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      forEachCorner(mesh_, h, [&](Index c) { seeds.push_back(Mesh::face(c)); });
    }
  }
  changed_.clear();
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  seeds.erase(
    std::remove_if(seeds.begin(), seeds.end(), [&](Index f) { return !isDefect(f); }), seeds.end());
  return seeds;
}

bool PatchMender::mendAround(Index seed, int rings)
{
  collectCluster(seed);
  for (int i = 0; i < rings; ++i)
  {
    growPatch();
    if (i == 0)
    {
      // What touches the cluster need not be tried again; a wrong winding has no inverted face to begin with.
      for (const Index f : patch_)
      {
        tried_[f] = 1;
      }
    }
  }
  const bool improved = patch_.size() <= kMaximumPatchFaces && embedPatch();
  if (improved)
  {
    changed_.insert(changed_.end(), patch_.begin(), patch_.end());
  }
  for (const Index f : patch_)
  {
    inPatch_[f] = 0;
  }
  return improved;
}

void PatchMender::collectCluster(Index seed)
{
  patch_.assign(1, seed);
  inPatch_[seed] = 1;
  std::vector<Index> corners;
  bool interior = false;
  for (std::size_t i = 0; i < patch_.size() && patch_.size() < kMaximumPatchFaces; ++i)
  {
    for (Index h = 3 * patch_[i]; h < 3 * patch_[i] + 3; ++h)
    {
      collectCorners(mesh_, h, corners, interior);
      for (const Index c : corners)
      {
        if (inPatch_[c / 3] == 0 && !isPositive(c / 3))
        {
          inPatch_[c / 3] = 1;
          patch_.push_back(c / 3);
        }
      }
    }
  }
}

void PatchMender::growPatch()
{
  const std::size_t size = patch_.size();
  for (std::size_t i = 0; i < size && patch_.size() <= kMaximumPatchFaces; ++i)
  {
    for (Index h = 3 * patch_[i]; h < 3 * patch_[i] + 3; ++h)
    {
      addFacesAround(h);
    }
  }
  std::sort(patch_.begin(), patch_.end());
}

void PatchMender::addFacesAround(Index corner)
{
  std::vector<Index> corners;
  bool interior = false;
  collectCorners(mesh_, corner, corners, interior);
  for (const Index c : corners)
  {
    if (inPatch_[c / 3] == 0)
    {
      inPatch_[c / 3] = 1;
      patch_.push_back(c / 3);
    }
  }
}

/// Triangles that are not positive, and vertices of wrong turns, of the patch as collectFans left it; those with
/// positive triangles only count more: nothing shows the untangler, or the extraction, where the turn was lost.
std::size_t PatchMender::countDefectsInPatch() const
{
  std::size_t count = static_cast<std::size_t>(
    std::count_if(patch_.begin(), patch_.end(), [&](Index f) { return !isPositive(f); }));
  for (const PatchVertex& vertex : vertices_)
  {
    int turns = 0;
    bool positive = true;
    for (std::size_t i = 0; i < vertex.fanCount; ++i)
    {
      const Index c = fans_[vertex.firstFan + i].corner;
      const int sign = isPositive(Mesh::face(c)) ? 1 : -1;
      positive = positive && sign > 0;
      turns += quadrantsEntered(&uv_[3 * Mesh::face(c)], static_cast<int>(c % 3), sign);
    }
    const Index v = mesh_.origin[fans_[vertex.firstFan].corner];
    if (vertex.fanCount > 1 && turns != expectedTurns_[v])
    {
      count += positive ? kLostTurn : 1;
    }
  }
  return count;
}

bool PatchMender::embedPatch()
{
  collectFans();
  if (unknowns_ == 0)
  {
    return false;
  }
  if (countDefectsInPatch() == 0)
  {
    return false; // mended as part of another patch
  }
  const UntangleProblem problem = makeProblem(Reference::Surface);
  bool improved = embedFrom(problem, Eigen::VectorXd::Zero(unknowns_));
  if (countDefectsInPatch() > 0)
  {
    improved = embedRoundCone() || improved;
  }
  if (countDefectsInPatch() > 0)
  {
    const UntangleProblem again = improved ? makeProblem(Reference::Surface) : problem;
    improved = embedFrom(again, fitHarmonic(again)) || improved;
  }
  if (countDefectsInPatch() > 0)
  {
    const UntangleProblem even = makeProblem(Reference::Equilateral);
    improved = embedFrom(even, fitHarmonic(even)) || improved;
  }
  return improved;
}

/// Where the patch has one irregular vertex inside, and nothing else that holds the map: a start from which it keeps its
/// turns.
bool PatchMender::embedRoundCone()
{
  const PatchVertex* cone = nullptr;
  for (const PatchVertex& vertex : vertices_)
  {
    const auto first = fans_.begin() + static_cast<std::ptrdiff_t>(vertex.firstFan);
    const bool isInside = std::all_of(first, first + static_cast<std::ptrdiff_t>(vertex.fanCount),
      [&](const FanCorner& c) { return inPatch_[c.corner / 3] != 0; });
    if (!vertex.interior || (vertex.freedom != Freedom::Plane && isInside && cone != nullptr) ||
      vertex.freedom == Freedom::AlongU || vertex.freedom == Freedom::AlongV)
    {
      return false;
    }
    cone = vertex.freedom == Freedom::Fixed && isInside ? &vertex : cone;
  }
  if (cone == nullptr)
  {
    return false;
  }
  const Index v = mesh_.origin[fans_[cone->firstFan].corner];
  const ConeStart start = startRoundCone({ mesh_, uv_, patch_, v, expectedTurns_[v] }, mostSteps());
  work_ += patch_.size() * static_cast<std::size_t>(start.steps);
  if (start.places.empty())
  {
    return false;
  }
  Eigen::VectorXd y(unknowns_);
  for (const PatchVertex& vertex : vertices_)
  {
    if (vertex.freedom == Freedom::Plane)
    {
      const Index corner = fans_[vertex.firstFan].corner;
      y.segment<2>(vertex.firstUnknown) =
        start.places[3 * placeInPatch(corner / 3) + corner % 3] - toDouble(uv_[corner]);
    }
  }
  return embedFrom(makeProblem(Reference::Surface), y) ||
    embedFrom(makeProblem(Reference::Equilateral), y);
}

/// Of the untangler, for one try.
int PatchMender::mostSteps() const
{
  return static_cast<int>(
    std::clamp(kWorkPerTry / patch_.size(), kLeastSteps, kMostUntanglingSteps));
}

std::size_t PatchMender::placeInPatch(Index f) const
{
  return static_cast<std::size_t>(
    std::lower_bound(patch_.begin(), patch_.end(), f) - patch_.begin());
}

bool PatchMender::embedFrom(const UntangleProblem& problem, const Eigen::VectorXd& start)
{
  const std::size_t before = countDefectsInPatch();
  std::vector<FixedVec2> saved;
  for (const Index f : patch_)
  {
    saved.insert(saved.end(), { uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2] });
  }
  UntangleOptions options;
  options.maximumSteps = mostSteps();
  const UntangleResult result = untangle(problem, start, options);
  work_ += patch_.size() * static_cast<std::size_t>(result.steps);
  applyDisplacements(result.y);
  if (result.y.allFinite() && countDefectsInPatch() < before)
  {
    return true;
  }
  for (std::size_t i = 0; i < saved.size(); ++i)
  {
    uv_[3 * patch_[i / 3] + i % 3] = saved[i];
  }
  return false;
}

void PatchMender::collectFans()
{
  vertices_.clear();
  fans_.clear();
  unknowns_ = 0;
  for (const Index f : patch_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (seenVertex_[mesh_.origin[h]] == 0)
      {
        seenVertex_[mesh_.origin[h]] = 1;
        addFan(h);
      }
    }
  }
  for (const Index f : patch_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      seenVertex_[mesh_.origin[h]] = 0;
    }
  }
}

void PatchMender::addFan(Index corner)
{
  std::vector<FanCorner> fan;
  PatchVertex vertex;
  const bool closes = walkFan(corner, fan, vertex.interior);
  vertex.freedom = freedomOf(fan, vertex.interior, closes);
  vertex.firstFan = fans_.size();
  vertex.fanCount = fan.size();
  vertex.firstUnknown = unknowns_;
  if (vertex.freedom == Freedom::Plane)
  {
    unknowns_ += 2;
  }
  else if (vertex.freedom != Freedom::Fixed)
  {
    unknowns_ += 1;
  }
  fans_.insert(fans_.end(), fan.begin(), fan.end());
  vertices_.push_back(vertex);
}

/// False when the vertex must stay for what its transitions are: irregular, or one that has no unique rotation.
bool PatchMender::walkFan(Index corner, std::vector<FanCorner>& fan, bool& interior) const
{
  std::vector<Index> corners;
  if (!collectCorners(mesh_, corner, corners, interior))
  {
    fan.push_back({ corner, 0 });
    return false;
  }
  bool closes = true;
  int rotation = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    fan.push_back({ corners[i], rotation & 3 });
    const Index c = corners[i];
    if (i + 1 == corners.size() && !interior)
    {
      break;
    }
    const Index n = corners[i + 1 == corners.size() ? 0 : i + 1];
    const std::optional<int> further =
      rotationBetween(uv_[Mesh::previous(c)] - uv_[c], uv_[Mesh::next(n)] - uv_[n]);
    closes = closes && further;
    rotation += further.value_or(0);
  }
  return closes && (!interior || (rotation & 3) == 0);
}

Freedom PatchMender::freedomOf(const std::vector<FanCorner>& fan, bool interior, bool closes) const
{
  if (!closes ||
    std::any_of(
      fan.begin(), fan.end(), [&](const FanCorner& c) { return inPatch_[c.corner / 3] == 0; }))
  {
    return Freedom::Fixed;
  }
  // Irregular vertices lie on whole points, also those of curves that look as if the curve passed.
  if (expectedTurns_[mesh_.origin[fan.front().corner]] != (interior ? 4 : 2))
  {
    return Freedom::Fixed;
  }
  int constrained = 0;
  bool alongU = true;
  bool alongV = true;
  const auto addEdge = [&](FixedVec2 edge, int rotation)
  {
    const FixedVec2 inFirst = rotate(edge, 4 - rotation);
    ++constrained;
    alongU = alongU && inFirst.v == 0;
    alongV = alongV && inFirst.u == 0;
  };
  for (const FanCorner& c : fan)
  {
    if (mesh_.isConstrained(c.corner))
    {
      addEdge(uv_[Mesh::next(c.corner)] - uv_[c.corner], c.rotation);
    }
  }
  if (!interior)
  {
    const Index last = fan.back().corner;
    addEdge(uv_[Mesh::previous(last)] - uv_[last], fan.back().rotation);
  }
  if (constrained == 0)
  {
    return Freedom::Plane;
  }
  if (constrained != 2 || alongU == alongV)
  {
    return Freedom::Fixed;
  }
  return alongU ? Freedom::AlongU : Freedom::AlongV;
}

/// The displacement of unknown direction (1, 0) or (0, 1) in a corner's chart.
Vector2 direction(bool alongU, int rotation)
{
  const FixedVec2 d = rotate(alongU ? FixedVec2{ 1, 0 } : FixedVec2{ 0, 1 }, rotation);
  return { static_cast<double>(d.u), static_cast<double>(d.v) };
}

UntangleProblem PatchMender::makeProblem(Reference reference) const
{
  // A point per corner, relative to its face's first corner: only differences inside a face matter.
  UntangleProblem problem;
  const int points = 3 * static_cast<int>(patch_.size());
  double imageArea = 0;
  const double scale = referenceScale(imageArea);
  const Eigen::Matrix2d uniform =
    equilateral(std::sqrt(imageArea / (kEquilateralArea * static_cast<double>(patch_.size()))))
      .inverse();
  problem.offset = Eigen::VectorXd::Zero(2 * points);
  std::vector<Eigen::Triplet<double>> entries;
  const auto pointOf = [&](Index corner)
  { return 3 * static_cast<int>(placeInPatch(corner / 3)) + static_cast<int>(corner % 3); };
  for (std::size_t i = 0; i < patch_.size(); ++i)
  {
    const Index f = patch_[i];
    const Index point = static_cast<Index>(3 * i);
    problem.triangles.push_back({ point, point + 1, point + 2 });
    problem.inverseReference.push_back(
      reference == Reference::Surface ? inverseReference(f, scale) : uniform);
    problem.weight.push_back(0.5 / std::abs(problem.inverseReference.back().determinant()));
    for (Index k = 0; k < 3; ++k)
    {
      problem.offset.segment<2>(2 * (point + k)) = toDouble(uv_[3 * f + k] - uv_[3 * f]);
    }
  }
  for (const PatchVertex& vertex : vertices_)
  {
    for (std::size_t i = 0; i < vertex.fanCount && vertex.freedom != Freedom::Fixed; ++i)
    {
      const FanCorner& c = fans_[vertex.firstFan + i];
      const int row = 2 * pointOf(c.corner);
      int column = vertex.firstUnknown;
      for (const bool alongU : { true, false })
      {
        if (vertex.freedom == (alongU ? Freedom::AlongV : Freedom::AlongU))
        {
          continue;
        }
        const Vector2 d = direction(alongU, c.rotation);
        const int axis = d.x() != 0 ? 0 : 1;
        entries.emplace_back(row + axis, column++, d[axis]);
      }
    }
  }
  problem.basis.resize(2 * points, unknowns_);
  problem.basis.setFromTriplets(entries.begin(), entries.end());
  return problem;
}

double PatchMender::referenceScale(double& imageArea) const
{
  // So that the references have as much area as the image: the area of the image does not change, as its
  // border stays.
  double area = 0;
  double image = 0;
  for (const Index f : patch_)
  {
    area += 0.5 * mesh_.edgeVector(3 * f).cross(mesh_.edgeVector(3 * f + 1)).norm();
    const Vector2 a = toDouble(uv_[3 * f + 1] - uv_[3 * f]);
    const Vector2 b = toDouble(uv_[3 * f + 2] - uv_[3 * f]);
    image += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  imageArea = image > 0 ? image : std::max(area, 1e-12);
  return area > 0 && image > 0 ? std::sqrt(image / area) : 1.0;
}

Eigen::Matrix2d PatchMender::inverseReference(Index f, double scale) const
{
  const Vector3 ab = scale * mesh_.edgeVector(3 * f);
  const Vector3 ac = -scale * mesh_.edgeVector(3 * f + 2);
  const double longest = std::max({ ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm() });
  const double doubled = ab.cross(ac).norm();
  Eigen::Matrix2d reference;
  if (doubled > kFlattestReference * longest)
  {
    const double length = ab.norm();
    reference << length, ab.dot(ac) / length, 0, doubled / length;
  }
  else
  {
    // A tenth of the longest edge keeps the weight of a sliver small without letting it vanish.
    reference = equilateral(0.1 * std::sqrt(std::max(longest, 1e-12)));
  }
  return reference.inverse();
}

void PatchMender::applyDisplacements(const Eigen::VectorXd& y)
{
  if (!y.allFinite() || y.lpNorm<Eigen::Infinity>() > 1e5)
  {
    return; // uv stays as it is, which is no improvement
  }
  for (const PatchVertex& vertex : vertices_)
  {
    if (vertex.freedom == Freedom::Fixed)
    {
      continue;
    }
    int next = vertex.firstUnknown;
    FixedVec2 d;
    if (vertex.freedom != Freedom::AlongV)
    {
      d.u = toFixed(y[next++]);
    }
    if (vertex.freedom != Freedom::AlongU)
    {
      d.v = toFixed(y[next]);
    }
    for (std::size_t i = 0; i < vertex.fanCount; ++i)
    {
      const FanCorner& c = fans_[vertex.firstFan + i];
      uv_[c.corner] = uv_[c.corner] + rotate(d, c.rotation);
    }
  }
}

} // namespace

MendResult mendPatches(const Mesh& mesh, std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, int threads, const ProgressCallback& progress)
{
  return PatchMender(mesh, uv, expectedTurns, threads).run(progress);
}

} // namespace quadrille
