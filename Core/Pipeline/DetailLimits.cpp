// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DetailLimits.h"

#include "Base/TryCount.h"
#include "Details/SmallComponents.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/SmallHandles.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

namespace quadrille
{
namespace
{

/// Where smaller quads round so many handles would make more than so many times the quads, they meet each other, and
/// maps fail: measured on scans with 20 and more of them. Few handles are worth it, as a ring's own one is.
constexpr std::size_t kSeveralHandles = 8;
constexpr double kMostGrowthOfSeveral = 1.15;
constexpr double kMostGrowthOfMany = 1.05;
/// By how much the limit below which Automatic simplifies grows where smaller quads at the rest take too many.
constexpr double kLimitStep = 0.5;

/// Handles that are cut where nothing else has led to quads, in edge lengths. Loops of the intermediate level are up to
/// a tenth too short, and of four quads round a handle a map may leave two: then they touch themselves.
constexpr double kLoopOfRest = 4;

} // namespace

DetailLimits::DetailLimits(double edgeLength, bool takesAll, bool isRest)
  : edgeLength_(edgeLength), limit_(edgeLength * (takesAll ? kQuadsOfLoop : kSimplifiedLoop)),
    handleLimit_(isRest ? kLoopOfRest * edgeLength : limit_)
{
}

/// The short loops that are at least as long as the limit: all, or those of handles only.
std::vector<HandleLoop> DetailLimits::loopsAbove(const RunContext& run, bool ofHandles) const
{
  const ShortLoops& found = run.shortLoops;
  const auto end = ofHandles
    ? found.loops.begin() + static_cast<std::ptrdiff_t>(found.parts.unresolvedHandles)
    : found.loops.end();
  std::vector<HandleLoop> loops;
  std::copy_if(found.loops.begin(), end, std::back_inserter(loops),
    [&](const HandleLoop& loop) { return loop.length >= (ofHandles ? handleLimit_ : limit_); });
  return loops;
}

void DetailLimits::raise(RunContext& run)
{
  const double most = kQuadsOfLoop * edgeLength_;
  const std::vector<HandleLoop> handles = loopsAbove(run, true);
  const double growth = handles.size() >= kManyHandles ? kMostGrowthOfMany : kMostGrowthOfSeveral;
  if (handles.size() >= kSeveralHandles && !resolvesLoops(run, handles, growth))
  {
    handleLimit_ = most;
    countTry(Try::RaisedLimit);
    isRaised_ = true;
  }
  while (limit_ < most && !resolvesLoops(run, loopsAbove(run, false)))
  {
    limit_ = std::min(most, limit_ + kLimitStep * edgeLength_);
    countTry(Try::RaisedLimit);
    isRaised_ = true;
  }
  handleLimit_ = std::max(handleLimit_, limit_);
}

bool DetailLimits::takeRaised()
{
  return std::exchange(isRaised_, false);
}

std::vector<HandleLoop> shortBoundaryLoops(
  const PreparedSurface& surface, double edgeLength, double limit, int threads)
{
  std::vector<HandleLoop> loops = measureBoundary(surface.mesh, limit).tooShort;
  if (loops.empty())
  {
    return loops;
  }
  const SmallComponents small =
    findSmallComponents(surface, edgeLength, quadsOfBlock(2, 0), threads);
  if (small.count > 0)
  {
    std::vector<std::uint8_t> isSmall(surface.mesh.vertexCount(), 0);
    for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
    {
      isSmall[surface.mesh.origin[h]] |= small.isSmall[Mesh::face(h)];
    }
    const auto isOfSmall = [&](const HandleLoop& loop)
    { return isSmall[loop.vertices.front()] != 0; };
    loops.erase(std::remove_if(loops.begin(), loops.end(), isOfSmall), loops.end());
  }
  return loops;
}

std::vector<HandleLoop> handlesBelow(RunContext& run, double edgeLength, double limit)
{
  if (limit > kQuadsOfLoop * edgeLength)
  {
    const Level& level = run.levels.makeIntermediate(levelOptions(run, {}));
    std::vector<HandleLoop> loops = findHandles(level.mesh, limit).loops;
    for (HandleLoop& loop : loops)
    {
      loop.vertices = onFinest(loop.vertices, level);
    }
    return loops;
  }
  const ShortLoops& found = run.shortLoops;
  std::vector<HandleLoop> loops;
  std::copy_if(found.loops.begin(),
    found.loops.begin() + static_cast<std::ptrdiff_t>(found.parts.unresolvedHandles),
    std::back_inserter(loops), [&](const HandleLoop& loop) { return loop.length < limit; });
  return loops;
}

} // namespace quadrille
