// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchMender.h"

#include "Base/Angles.h"
#include "Base/ChartRotation.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "GridMap/FieldUntangling.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "Numerics/Untangler.h"
#include "Transfer/PatchLevels.h"
#include "Transfer/PatchRotations.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace quadrille
{

namespace
{

/// Rings of faces round the inverted ones, in the order of the attempts.
constexpr std::array<int, 4> kGrowth{ 2, 4, 8, 16 };
constexpr std::size_t kMaximumPatchFaces = 10000;
/// Vertices of the level between that a patch has that is solved by levels, the smallest one first, and its faces.
constexpr std::array<std::size_t, 3> kVerticesOfLevels{ 16, 64, 256 };
constexpr std::size_t kMaximumFacesOfLevels = 60000;
/// More faces that are left of all patches have another cause.
constexpr std::size_t kManySeedsOfLevels = 200;
/// Faces times steps of the untangler: of one try, and of all tries besides half the faces of the mesh.
constexpr std::size_t kWorkPerTry = 200000;
constexpr std::size_t kMaximumWork = 5000000;
/// The same where so many faces are to be mended that their cause is no matter of a few places.
constexpr std::size_t kWorkOnMany = 1000000;
constexpr std::size_t kManySeeds = 4000;
constexpr std::size_t kLeastSteps = 30;
constexpr std::size_t kMostUntanglingSteps = 250;
constexpr int kSettlingSteps = 40;
/// Faces of a chunk of the pass over the mesh; their uv fit a second level cache.
constexpr std::size_t kMendChunk = 1 << 14;
/// Defects that a wrong winding of positive triangles counts for.
constexpr std::size_t kLostTurn = 16;
/// What weighs most is no nearer than this, squared and over the largest distance of the patch.
constexpr double kNearest = 1e-4;
/// How often those at defects get more weight, and how much.
constexpr int kTurnedRounds = 4;
constexpr double kStiffening = 10;
/// A patch vertex with more faces than this stays where it is.
constexpr std::size_t kMaximumFan = 256;

/// Which shapes the untangler aims at: those of the surface, or, where slivers keep it from converging, the same
/// for all triangles.
enum class Reference
{
  Surface,
  Equilateral,
  Turned ///< those of the surface, each turned as the map round the patch asks for
};

/// What the untangler minimizes, and when what comes of it is taken.
enum class Energy
{
  Shape,  ///< whichever way triangles are turned; where fewer defects are left
  Turned, ///< as those of the coarse map, which keep the rotation of their references; the same
  Polish, ///< the first one from a map without defects; where it has none afterwards
  Settle ///< the same for longer: from a level with few triangles shapes are farther from those of the surface
};

Eigen::Matrix2d equilateral(double side)
{
  Eigen::Matrix2d edges;
  edges << side, 0.5 * side, 0, 0.8660254037844386 * side;
  return edges;
}

/// Counts what a try has made where that is used, and says whether it is.
bool hasLed(Try which, bool isUsed)
{
  countTryLed(which, isUsed ? 1 : 0);
  return isUsed;
}

/// The tries of `act`, which no scope around it has counted.
template <typename Act>
TryCounts triesOf(const Act& act)
{
  TryScope scope;
  act();
  return scope.counts();
}

/// Counts such tries for the scope around after all, and that they have led only where what they made is used.
void countAgain(const TryCounts& tries, bool isUsed)
{
  for (std::size_t i = 0; i < kTries; ++i)
  {
    countTry(static_cast<Try>(i), tries.taken[i]);
    countTryLed(static_cast<Try>(i), isUsed ? tries.led[i] : 0);
  }
}

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
  MendResult runByLevels(const std::vector<Index>& between, const ProgressCallback& progress);

  /// Tries to mend a patch; true where it has no defects any more. work: what that took, faces times steps.
  bool solve(const std::vector<Index>& patch, std::size_t& work);

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
  MendResult resultOf(std::vector<Index> seeds, std::size_t patches) const;
  bool mendWithLevels(Index seed, std::size_t vertices);
  void collectCluster(Index seed);
  void growPatch(std::size_t maximumFaces);
  void addFacesAround(Index corner);
  std::size_t countDefectsInPatch() const;
  std::vector<Index> defectVertices() const;

  bool embedPatch(bool isWider);
  bool embedWhole();
  bool embedTurned();
  bool embedByLevels();
  bool embedFrom(
    const UntangleProblem& problem, const Eigen::VectorXd& start, Energy energy = Energy::Shape);
  void embedShapes(Energy energy);
  void stiffen(const std::vector<Index>& vertices, UntangleProblem& problem) const;
  void collectFans();
  void addFan(Index corner);
  bool walkFan(Index corner, std::vector<PatchCorner>& fan, bool& interior) const;
  PatchFreedom freedomOf(const std::vector<PatchCorner>& fan, bool interior, bool closes) const;
  std::vector<double> nearnessToFixed() const;
  void guardCurves(const std::vector<double>& rotations, const std::vector<double>& nearness,
    UntangleProblem& problem) const;
  UntangleProblem makeProblem(Reference reference, const std::vector<double>& rotations = {}) const;
  Eigen::Matrix2d inverseReference(Index f, double scale) const;
  double referenceScale(double& imageArea) const;
  void applyDisplacements(const Eigen::VectorXd& y);
  std::vector<FixedVec2> cornersOfPatch() const;
  void restore(const std::vector<FixedVec2>& corners);

  struct PatchVertex
  {
    PatchFreedom freedom = PatchFreedom::Fixed;
    bool interior = false;
    std::size_t firstFan = 0; ///< range of fans_
    std::size_t fanCount = 0;
    int firstUnknown = 0;
  };

  const Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
  const std::vector<int>& expectedTurns_;
  int threads_;
  std::vector<std::uint8_t> isBetween_; ///< #V flags, or empty
  std::vector<std::uint8_t> inPatch_;
  std::vector<std::uint8_t> seenVertex_;
  std::vector<std::uint8_t> tried_; ///< faces that were in a cluster of this growth, or touched one
  std::vector<Index> patch_;        ///< faces, sorted
  std::vector<Index> changed_;      ///< faces of the patches that were improved in this growth
  std::vector<PatchVertex> vertices_;
  std::vector<PatchCorner> fans_;
  int unknowns_ = 0;
  std::vector<Index> left_; ///< vertices at the defects that the last try had in the end
  std::size_t work_ = 0;    ///< faces times steps of all tries
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
  std::size_t patches = 0;
  std::vector<Index> seeds = findSeeds();
  const std::size_t limit =
    (seeds.size() > kManySeeds ? kWorkOnMany : kMaximumWork) + mesh_.faceCount() / 2;
  for (std::size_t growth = 0; growth < kGrowth.size() && !seeds.empty(); ++growth)
  {
    std::fill(tried_.begin(), tried_.end(), std::uint8_t{ 0 });
    for (const Index f : seeds)
    {
      report(progress, double(growth) / double(kGrowth.size()), "mending the map");
      if (work_ < limit && tried_[f] == 0)
      {
        patches += mendAround(f, kGrowth[growth]) ? 1U : 0U;
      }
    }
    seeds = seedsLeft(std::move(seeds));
  }
  return resultOf(std::move(seeds), patches);
}

MendResult PatchMender::resultOf(std::vector<Index> seeds, std::size_t patches) const
{
  MendResult result;
  result.patches = patches;
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
    growPatch(kMaximumPatchFaces);
    if (i == 0)
    {
      // What touches the cluster need not be tried again; a wrong winding has no inverted face to begin with.
      for (const Index f : patch_)
      {
        tried_[f] = 1;
      }
    }
  }
  const bool improved = patch_.size() <= kMaximumPatchFaces && embedPatch(rings > kGrowth.front());
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

MendResult PatchMender::runByLevels(
  const std::vector<Index>& between, const ProgressCallback& progress)
{
  std::vector<Index> seeds = findSeeds();
  std::size_t patches = 0;
  isBetween_.assign(mesh_.vertexCount(), 0);
  for (const Index v : between)
  {
    isBetween_[v] = 1;
  }
  for (const std::size_t vertices : kVerticesOfLevels)
  {
    std::fill(tried_.begin(), tried_.end(), std::uint8_t{ 0 });
    for (const Index f : seeds)
    {
      report(progress, 1, "mending the map");
      if (tried_[f] == 0 && seeds.size() <= kManySeedsOfLevels && work_ < kMaximumWork)
      {
        patches += mendWithLevels(f, vertices) ? 1U : 0U;
      }
    }
    seeds = seedsLeft(std::move(seeds));
  }
  return resultOf(std::move(seeds), patches);
}

bool PatchMender::mendWithLevels(Index seed, std::size_t vertices)
{
  collectCluster(seed);
  std::size_t inside = 0, before = 0;
  do
  {
    before = patch_.size();
    growPatch(kMaximumFacesOfLevels);
    inside = 0;
    for (const Index f : patch_)
    {
      tried_[f] = 1;
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        inside += isBetween_[mesh_.origin[h]];
      }
    }
    // Each vertex has about six corners.
  } while (
    inside < 6 * vertices && patch_.size() < kMaximumFacesOfLevels && patch_.size() > before);
  bool improved = false;
  if (patch_.size() < kMaximumFacesOfLevels)
  {
    collectFans();
    if (unknowns_ > 0 && countDefectsInPatch() > 0)
    {
      countTry(Try::MendedByLevels);
      improved = hasLed(Try::MendedByLevels, embedByLevels());
    }
  }
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

void PatchMender::growPatch(std::size_t maximumFaces)
{
  const std::size_t size = patch_.size();
  for (std::size_t i = 0; i < size && patch_.size() <= maximumFaces; ++i)
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

/// Of the patch: those of triangles that are not positive, and those of wrong turns.
std::vector<Index> PatchMender::defectVertices() const
{
  std::vector<Index> found;
  for (const Index f : patch_)
  {
    if (!isPositive(f))
    {
      found.insert(found.end(), &mesh_.origin[3 * f], &mesh_.origin[3 * f] + 3);
    }
  }
  for (const PatchVertex& vertex : vertices_)
  {
    const Index corner = fans_[vertex.firstFan].corner;
    if (vertex.fanCount > 1 && turnsRound(corner) != expectedTurns_[mesh_.origin[corner]])
    {
      found.push_back(mesh_.origin[corner]);
    }
  }
  return found;
}

/// The displacements of least Dirichlet energy: no valid map yet, but one that has forgotten any wrong winding.
Eigen::VectorXd harmonicStart(const UntangleProblem& problem)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t < problem.triangles.size(); ++t)
  {
    const Eigen::Matrix2d& inverse = problem.inverseReference[t];
    // Rows: how each corner enters the two columns of J.
    Eigen::Matrix<double, 3, 2> gradient;
    gradient.row(1) = inverse.row(0);
    gradient.row(2) = inverse.row(1);
    gradient.row(0) = -inverse.row(0) - inverse.row(1);
    const Eigen::Matrix3d stiffness = problem.weight[t] * gradient * gradient.transpose();
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        for (int axis = 0; axis < 2; ++axis)
        {
          entries.emplace_back(2 * static_cast<int>(problem.triangles[t][i]) + axis,
            2 * static_cast<int>(problem.triangles[t][j]) + axis, stiffness(i, j));
        }
      }
    }
  }
  Eigen::SparseMatrix<double> energy(problem.offset.size(), problem.offset.size());
  energy.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> reduced = problem.basis.transpose() * energy * problem.basis;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(reduced);
  if (solver.info() != Eigen::Success)
  {
    return Eigen::VectorXd::Zero(problem.basis.cols());
  }
  return solver.solve(-(problem.basis.transpose() * (energy * problem.offset)));
}

bool PatchMender::embedPatch(bool isWider)
{
  collectFans();
  if (unknowns_ == 0 || countDefectsInPatch() == 0)
  {
    return false; // mended as part of another patch
  }
  if (!isWider)
  {
    return embedWhole();
  }
  countTry(Try::WiderPatch);
  return hasLed(Try::WiderPatch, embedWhole());
}

/// From the map as it is, and from others.
bool PatchMender::embedWhole()
{
  const UntangleProblem problem = makeProblem(Reference::Surface);
  bool improved = embedFrom(problem, Eigen::VectorXd::Zero(unknowns_));
  if (countDefectsInPatch() > 0)
  {
    const UntangleProblem again = improved ? makeProblem(Reference::Surface) : problem;
    countTry(Try::HarmonicStart);
    improved = hasLed(Try::HarmonicStart, embedFrom(again, harmonicStart(again))) || improved;
  }
  if (countDefectsInPatch() > 0)
  {
    const UntangleProblem even = makeProblem(Reference::Equilateral);
    countTry(Try::EquilateralReferences);
    improved = hasLed(Try::EquilateralReferences, embedFrom(even, harmonicStart(even))) || improved;
  }
  if (countDefectsInPatch() > 0)
  {
    improved = embedTurned() || improved;
  }
  return improved;
}

bool PatchMender::solve(const std::vector<Index>& patch, std::size_t& work)
{
  patch_ = patch;
  for (const Index f : patch_)
  {
    inPatch_[f] = 1;
  }
  embedPatch(false);
  work = work_;
  return countDefectsInPatch() == 0;
}

/// With fewer triangles first; what has come back then keeps its turns.
bool PatchMender::embedByLevels()
{
  std::vector<PatchStar> stars;
  for (const PatchVertex& vertex : vertices_)
  {
    const PatchCorner* begin = fans_.data() + vertex.firstFan;
    stars.push_back({ vertex.freedom, isBetween_[mesh_.origin[begin->corner]] != 0, begin,
      begin + vertex.fanCount });
  }
  const PatchSolver solver = [&](const Mesh& mesh, const std::vector<Index>& patch,
                               const std::vector<int>& turns, std::vector<FixedVec2>& uv)
  {
    std::size_t work = 0;
    bool solved = false;
    const TryCounts tries =
      triesOf([&]() { solved = PatchMender(mesh, uv, turns, 1).solve(patch, work); });
    countAgain(tries, solved);
    work_ += work;
    return solved;
  };
  std::vector<FixedVec2> saved = cornersOfPatch();
  double imageArea = 0;
  PatchLevelsResult result;
  const TryCounts tries = triesOf(
    [&]()
    {
      result =
        solveByLevels(mesh_, patch_, stars, expectedTurns_, referenceScale(imageArea), solver, uv_);
    });
  work_ += result.work;
  const bool isUsed = result.valid && countDefectsInPatch() == 0;
  countAgain(tries, isUsed);
  if (!isUsed)
  {
    restore(saved);
    return false;
  }
  if (patch_.size() <= kMaximumPatchFaces)
  {
    embedShapes(Energy::Settle);
  }
  return true;
}

/// uv of the corners of the patch, face after face.
std::vector<FixedVec2> PatchMender::cornersOfPatch() const
{
  std::vector<FixedVec2> corners;
  for (const Index f : patch_)
  {
    corners.insert(corners.end(), { uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2] });
  }
  return corners;
}

void PatchMender::restore(const std::vector<FixedVec2>& corners)
{
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    uv_[3 * patch_[i / 3] + i % 3] = corners[i];
  }
}

/// Triangles that know how they are to be turned do not wind once less round an irregular vertex, and those near to
/// it, as they weigh more, go along with it to its whole point. Edges of curves that know it do not run back.
bool PatchMender::embedTurned()
{
  const std::vector<double> rotations = patchRotations(mesh_, uv_, patch_, inPatch_);
  if (rotations.empty())
  {
    return false;
  }
  UntangleProblem problem = makeProblem(Reference::Turned, rotations);
  const std::vector<double> nearness = nearnessToFixed();
  for (std::size_t i = 0; i < patch_.size(); ++i)
  {
    problem.weight[i] *= nearness[i];
  }
  guardCurves(rotations, nearness, problem);
  bool improved = false;
  for (int round = 0; round < kTurnedRounds && countDefectsInPatch() > 0; ++round)
  {
    const Try which = round == 0 ? Try::TurnedReferences : Try::MoreWeightTurned;
    countTry(which);
    improved =
      hasLed(which, embedFrom(problem, fitReferences(problem), Energy::Turned)) || improved;
    stiffen(left_, problem);
  }
  if (improved && countDefectsInPatch() == 0)
  {
    // From a valid map no vertex changes its winding.
    embedShapes(Energy::Polish);
  }
  return improved;
}

/// The surface's shapes, from a valid map.
void PatchMender::embedShapes(Energy energy)
{
  countTry(Try::ShapesAgain);
  hasLed(Try::ShapesAgain,
    embedFrom(makeProblem(Reference::Surface), Eigen::VectorXd::Zero(unknowns_), energy));
}

/// Faces that touch one of these vertices, or touch one that does, weigh more.
void PatchMender::stiffen(const std::vector<Index>& vertices, UntangleProblem& problem) const
{
  std::vector<Index> near = vertices;
  for (int ring = 0; ring < 2; ++ring)
  {
    std::sort(near.begin(), near.end());
    std::vector<Index> touched;
    for (std::size_t i = 0; i < patch_.size(); ++i)
    {
      const Index* v = &mesh_.origin[3 * patch_[i]];
      if (std::any_of(
            v, v + 3, [&](Index w) { return std::binary_search(near.begin(), near.end(), w); }))
      {
        touched.insert(touched.end(), v, v + 3);
        problem.weight[i] *= ring == 1 ? kStiffening : 1;
      }
    }
    near = std::move(touched);
  }
}

/// Per face, one over its squared distance from the nearest vertex inside the patch that stays, in patch sizes.
std::vector<double> PatchMender::nearnessToFixed() const
{
  std::vector<Vector3> fixed;
  for (const PatchVertex& vertex : vertices_)
  {
    const auto begin = fans_.begin() + static_cast<std::ptrdiff_t>(vertex.firstFan);
    const bool inside = std::all_of(begin, begin + static_cast<std::ptrdiff_t>(vertex.fanCount),
      [&](const PatchCorner& c) { return inPatch_[Mesh::face(c.corner)] != 0; });
    if (vertex.freedom == PatchFreedom::Fixed && inside)
    {
      fixed.push_back(mesh_.position[mesh_.origin[begin->corner]]);
    }
  }
  std::vector<double> nearness(patch_.size(), 1);
  if (fixed.empty())
  {
    return nearness;
  }
  double farthest = 0;
  for (std::size_t i = 0; i < patch_.size(); ++i)
  {
    const auto corner = [&](Index k) { return mesh_.position[mesh_.origin[3 * patch_[i] + k]]; };
    const Vector3 middle = (corner(0) + corner(1) + corner(2)) / 3;
    double squared = std::numeric_limits<double>::infinity();
    for (const Vector3& p : fixed)
    {
      squared = std::min(squared, (middle - p).squaredNorm());
    }
    nearness[i] = squared;
    farthest = std::max(farthest, squared);
  }
  for (double& squared : nearness)
  {
    squared = farthest > 0 ? 1 / std::max(squared / farthest, kNearest) : 1;
  }
  return nearness;
}

/// Edges of curves between vertices that may slide past each other otherwise.
void PatchMender::guardCurves(const std::vector<double>& rotations,
  const std::vector<double>& nearness, UntangleProblem& problem) const
{
  double imageArea = 0;
  const double scale = referenceScale(imageArea);
  std::vector<Index> fixed;
  for (const PatchVertex& vertex : vertices_)
  {
    if (vertex.freedom == PatchFreedom::Fixed)
    {
      fixed.push_back(mesh_.origin[fans_[vertex.firstFan].corner]);
    }
  }
  std::sort(fixed.begin(), fixed.end());
  std::vector<GuardedEdge> edges;
  std::vector<double> factors;
  for (std::size_t i = 0; i < patch_.size(); ++i)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index h = 3 * patch_[i] + k;
      const double length = scale * mesh_.edgeVector(h).norm();
      const bool stays = std::binary_search(fixed.begin(), fixed.end(), mesh_.origin[h]) &&
        std::binary_search(fixed.begin(), fixed.end(), mesh_.target(h));
      if (!mesh_.isConstrained(h) || stays || !(length > 0))
      {
        continue;
      }
      const double direction = rotations[i] + directionOf(mesh_, h);
      const int axis = static_cast<int>(std::lround(direction / kRightAngle));
      edges.push_back(
        { static_cast<Index>(3 * i + k), static_cast<Index>(3 * i + (k + 1) % 3), axis, length });
      factors.push_back(nearness[i]);
    }
  }
  const std::size_t before = problem.weight.size();
  guardEdges(problem, edges);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    problem.weight[before + i] *= factors[i];
  }
}

bool PatchMender::embedFrom(
  const UntangleProblem& problem, const Eigen::VectorXd& start, Energy energy)
{
  const std::size_t before = countDefectsInPatch();
  const std::vector<FixedVec2> saved = cornersOfPatch();
  const int steps =
    static_cast<int>(std::clamp(kWorkPerTry / patch_.size(), kLeastSteps, kMostUntanglingSteps));
  UntangleOptions options;
  options.maximumSteps = steps;
  const bool isValid = energy == Energy::Polish || energy == Energy::Settle;
  if (energy == Energy::Turned)
  {
    options = fieldUntangleOptions({});
    options.maximumSteps = std::min(options.maximumSteps, steps);
  }
  if (energy == Energy::Settle)
  {
    options.polishSteps = kSettlingSteps;
    options.maximumSteps = kSettlingSteps;
  }
  const UntangleResult result = untangle(problem, start, options);
  work_ += patch_.size() * static_cast<std::size_t>(result.steps);
  applyDisplacements(result.y);
  const std::size_t after = countDefectsInPatch();
  left_ = defectVertices();
  if (result.y.allFinite() && (isValid ? after == 0 : after < before))
  {
    return true;
  }
  restore(saved);
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
  std::vector<PatchCorner> fan;
  PatchVertex vertex;
  const bool closes = walkFan(corner, fan, vertex.interior);
  vertex.freedom = freedomOf(fan, vertex.interior, closes);
  vertex.firstFan = fans_.size();
  vertex.fanCount = fan.size();
  vertex.firstUnknown = unknowns_;
  if (vertex.freedom == PatchFreedom::Plane)
  {
    unknowns_ += 2;
  }
  else if (vertex.freedom != PatchFreedom::Fixed)
  {
    unknowns_ += 1;
  }
  fans_.insert(fans_.end(), fan.begin(), fan.end());
  vertices_.push_back(vertex);
}

/// False when the vertex must stay for what its transitions are: irregular, or one that has no unique rotation.
bool PatchMender::walkFan(Index corner, std::vector<PatchCorner>& fan, bool& interior) const
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

PatchFreedom PatchMender::freedomOf(
  const std::vector<PatchCorner>& fan, bool interior, bool closes) const
{
  if (!closes ||
    std::any_of(
      fan.begin(), fan.end(), [&](const PatchCorner& c) { return inPatch_[c.corner / 3] == 0; }))
  {
    return PatchFreedom::Fixed;
  }
  // Irregular vertices lie on whole points, also those of curves that look as if the curve passed.
  if (expectedTurns_[mesh_.origin[fan.front().corner]] != (interior ? 4 : 2))
  {
    return PatchFreedom::Fixed;
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
  for (const PatchCorner& c : fan)
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
    return PatchFreedom::Plane;
  }
  if (constrained != 2 || alongU == alongV)
  {
    return PatchFreedom::Fixed;
  }
  return alongU ? PatchFreedom::AlongU : PatchFreedom::AlongV;
}

/// The displacement of unknown direction (1, 0) or (0, 1) in a corner's chart.
Vector2 direction(bool alongU, int rotation)
{
  const FixedVec2 d = rotate(alongU ? FixedVec2{ 1, 0 } : FixedVec2{ 0, 1 }, rotation);
  return { static_cast<double>(d.u), static_cast<double>(d.v) };
}

UntangleProblem PatchMender::makeProblem(
  Reference reference, const std::vector<double>& rotations) const
{
  // A point per corner, relative to its face's first corner: only differences inside a face matter.
  UntangleProblem problem;
  const int points = 3 * static_cast<int>(patch_.size());
  double imageArea = 0;
  const double scale = referenceScale(imageArea);
  const Eigen::Matrix2d uniform =
    equilateral(std::sqrt(imageArea / (0.433 * static_cast<double>(patch_.size())))).inverse();
  problem.offset = Eigen::VectorXd::Zero(2 * points);
  std::vector<Eigen::Triplet<double>> entries;
  const auto pointOf = [&](Index corner)
  {
    const auto face = std::lower_bound(patch_.begin(), patch_.end(), corner / 3);
    return 3 * static_cast<int>(face - patch_.begin()) + static_cast<int>(corner % 3);
  };
  for (std::size_t i = 0; i < patch_.size(); ++i)
  {
    const Index f = patch_[i];
    const Index point = static_cast<Index>(3 * i);
    problem.triangles.push_back({ point, point + 1, point + 2 });
    problem.inverseReference.push_back(
      reference == Reference::Equilateral ? uniform : inverseReference(f, scale));
    if (reference == Reference::Turned)
    {
      problem.inverseReference.back() *= Eigen::Rotation2Dd(-rotations[i]).toRotationMatrix();
    }
    problem.weight.push_back(0.5 / std::abs(problem.inverseReference.back().determinant()));
    for (Index k = 0; k < 3; ++k)
    {
      problem.offset.segment<2>(2 * (point + k)) = toDouble(uv_[3 * f + k] - uv_[3 * f]);
    }
  }
  for (const PatchVertex& vertex : vertices_)
  {
    for (std::size_t i = 0; i < vertex.fanCount && vertex.freedom != PatchFreedom::Fixed; ++i)
    {
      const PatchCorner& c = fans_[vertex.firstFan + i];
      const int row = 2 * pointOf(c.corner);
      int column = vertex.firstUnknown;
      for (const bool alongU : { true, false })
      {
        if (vertex.freedom == (alongU ? PatchFreedom::AlongV : PatchFreedom::AlongU))
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
  return inverseOfTriangle(ab, ac);
}

void PatchMender::applyDisplacements(const Eigen::VectorXd& y)
{
  if (!y.allFinite() || y.lpNorm<Eigen::Infinity>() > 1e5)
  {
    return; // uv stays as it is, which is no improvement
  }
  for (const PatchVertex& vertex : vertices_)
  {
    if (vertex.freedom == PatchFreedom::Fixed)
    {
      continue;
    }
    int next = vertex.firstUnknown;
    FixedVec2 d;
    if (vertex.freedom != PatchFreedom::AlongV)
    {
      d.u = toFixed(y[next++]);
    }
    if (vertex.freedom != PatchFreedom::AlongU)
    {
      d.v = toFixed(y[next]);
    }
    for (std::size_t i = 0; i < vertex.fanCount; ++i)
    {
      const PatchCorner& c = fans_[vertex.firstFan + i];
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

MendResult mendPatchesByLevels(const Mesh& mesh, std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, const std::vector<Index>& between, int threads,
  const ProgressCallback& progress)
{
  return PatchMender(mesh, uv, expectedTurns, threads).runByLevels(between, progress);
}

} // namespace quadrille
