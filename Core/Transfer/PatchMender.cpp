// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchMender.h"

#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "GridMap/FieldUntangling.h"
#include "Numerics/Untangler.h"
#include "Transfer/DefectSearch.h"
#include "Transfer/MendedPatch.h"
#include "Transfer/PatchProblems.h"
#include "Transfer/PatchRotations.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

namespace quadrille
{

namespace
{

/// Rings of faces round the inverted ones, in the order of the attempts. Of 116 tries with sixteen none led to fewer
/// defects, and these took more than half of all work.
constexpr std::array<int, 3> kGrowth{ 2, 4, 8 };
/// Faces times steps of the untangler: of one try, and of all tries besides half the faces of the mesh.
constexpr std::size_t kWorkPerTry = 200000;
constexpr std::size_t kMaximumWork = 5000000;

/// What the untangler minimizes, and when what comes of it is taken.
enum class Energy
{
  Shape, ///< whichever way triangles are turned; where fewer defects are left
  Turned ///< as those of the coarse map, which keep the rotation of their references; the same
};

/// Counts what a try has made where that is used, and says whether it is.
bool hasLed(Try which, bool isUsed)
{
  countTryLed(which, isUsed ? 1 : 0);
  return isUsed;
}

class PatchMender
{
public:
  PatchMender(const Mesh& mesh, std::vector<FixedVec2>& uv, const std::vector<int>& expectedTurns,
    int threads)
    : mesh_(mesh), uv_(uv), threads_(threads), defects_(mesh, uv, expectedTurns),
      patch_(mesh, uv, expectedTurns), tried_(mesh.faceCount(), 0)
  {
  }

  MendResult run(const ProgressCallback& progress);

private:
  std::vector<Index> seedsLeft(std::vector<Index> seeds);
  bool mendAround(Index seed, int rings);
  MendResult resultOf(std::vector<Index> seeds, std::size_t patches) const;

  PatchProblems problems() const { return { mesh_, uv_, patch_ }; }
  bool embedPatch(bool isWider);
  bool embedWhole();
  bool embedTurned();
  bool embedFrom(const UntangleProblem& problem, const Eigen::VectorXd& start, Energy energy);

  const Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
  int threads_;
  DefectSearch defects_;
  MendedPatch patch_;
  std::vector<std::uint8_t> tried_; ///< faces that were in a cluster of this growth, or touched one
  std::vector<Index> changed_;      ///< faces of the patches that were improved in this growth
  std::size_t work_ = 0;            ///< faces times steps of all tries
};

MendResult PatchMender::run(const ProgressCallback& progress)
{
  // Small patches of all places come first, so that a hopeless place does not use up the work of the others.
  std::size_t patches = 0;
  std::vector<Index> seeds = defects_.find(threads_);
  const std::size_t limit = kMaximumWork + mesh_.faceCount() / 2;
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
  std::copy_if(seeds.begin(), seeds.end(), std::back_inserter(bad),
    [&](Index f) { return !defects_.isPositive(f); });
  result.notPositive = bad.size();
  // A wrong winding beside an inverted triangle is the same defect; the triangle tells where room is missing.
  result.defects = bad.empty() ? std::move(seeds) : bad;
  return result;
}

/// What is left of the seeds before, and what the patches that changed since have made.
std::vector<Index> PatchMender::seedsLeft(std::vector<Index> seeds)
{
  seeds = defects_.findAmong(std::move(seeds), changed_);
  changed_.clear();
  return seeds;
}

bool PatchMender::mendAround(Index seed, int rings)
{
  patch_.beginAt(seed, kWorkPerTry);
  for (int i = 0; i < rings; ++i)
  {
    patch_.grow(kWorkPerTry);
    if (i == 0)
    {
      // What touches the cluster need not be tried again; a wrong winding has no inverted face to begin with.
      for (const Index f : patch_.faces())
      {
        tried_[f] = 1;
      }
    }
  }
  const bool improved = patch_.faces().size() <= kWorkPerTry && embedPatch(rings > kGrowth.front());
  if (improved)
  {
    changed_.insert(changed_.end(), patch_.faces().begin(), patch_.faces().end());
  }
  patch_.release();
  return improved;
}

bool PatchMender::embedPatch(bool isWider)
{
  patch_.collectFans();
  if (patch_.unknowns() == 0 || patch_.countDefects() == 0)
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

/// By the shapes of the surface alone, and where that leaves defects with triangles that know how they are turned.
bool PatchMender::embedWhole()
{
  const bool isImproved =
    embedFrom(problems().make(), Eigen::VectorXd::Zero(patch_.unknowns()), Energy::Shape);
  return (patch_.countDefects() > 0 && embedTurned()) || isImproved;
}

/// Triangles that know how they are to be turned do not wind once less round an irregular vertex, and those near to
/// it, as they weigh more, go along with it to its whole point. Edges of curves that know it do not run back.
bool PatchMender::embedTurned()
{
  const std::vector<double> rotations =
    patchRotations(mesh_, uv_, patch_.faces(), patch_.inPatch());
  if (rotations.empty())
  {
    return false;
  }
  UntangleProblem problem = problems().make(rotations);
  const std::vector<double> nearness = problems().nearnessToFixed();
  for (std::size_t i = 0; i < patch_.faces().size(); ++i)
  {
    problem.weight[i] *= nearness[i];
  }
  problems().guardCurves(rotations, nearness, problem);
  countTry(Try::TurnedReferences);
  return hasLed(Try::TurnedReferences, embedFrom(problem, fitReferences(problem), Energy::Turned));
}

bool PatchMender::embedFrom(
  const UntangleProblem& problem, const Eigen::VectorXd& start, Energy energy)
{
  const std::size_t before = patch_.countDefects();
  const std::vector<FixedVec2> saved = patch_.corners();
  const int steps = static_cast<int>(kWorkPerTry / patch_.faces().size());
  UntangleOptions options;
  options.maximumSteps = steps;
  if (energy == Energy::Turned)
  {
    options = fieldUntangleOptions({});
    options.maximumSteps = std::min(options.maximumSteps, steps);
  }
  const UntangleResult result = untangle(problem, start, options);
  work_ += patch_.faces().size() * static_cast<std::size_t>(result.steps);
  patch_.applyDisplacements(result.y);
  const std::size_t after = patch_.countDefects();
  if (result.y.allFinite() && after < before)
  {
    return true;
  }
  patch_.restore(saved);
  return false;
}

} // namespace

MendResult mendPatches(const Mesh& mesh, std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, int threads, const ProgressCallback& progress)
{
  return PatchMender(mesh, uv, expectedTurns, threads).run(progress);
}

} // namespace quadrille
