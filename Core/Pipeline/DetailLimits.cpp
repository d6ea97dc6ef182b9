// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DetailSteps.h"

#include "Base/Lists.h"
#include "Details/SmallComponents.h"
#include "Pipeline/FirstPlan.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace quadrille
{
namespace
{

/// Where smaller quads round so many handles would make more than so many times the quads, they meet each other, and
/// maps fail: measured on scans with 20 and more of them. Few handles are worth it, as a ring's own one is.
constexpr std::size_t kSeveralHandles = 8;
constexpr double kMostGrowthOfSeveral = 1.15;
constexpr double kMostGrowthOfMany = 1.05;

/// The short loops that are handles come first.
std::vector<HandleLoop>::const_iterator endOfHandles(const ShortLoops& found)
{
  return found.loops.begin() + static_cast<std::ptrdiff_t>(found.parts.unresolvedHandles);
}

} // namespace

DetailLimits detailLimits(double edgeLength, double smallest, bool takesAll, bool isRest)
{
  const double limit = edgeLength * std::max(smallest, takesAll ? kQuadsOfLoop : 0.0);
  return { limit, isRest ? std::max(limit, kQuadsOfSafeLoop * edgeLength) : limit };
}

bool isCrowdToCut(const DetailLimits& limits, const RunContext& run)
{
  if (run.surface->facets.isDesigned)
  {
    return false; // bores, each of which is meant
  }
  const ShortLoops& found = run.shortLoops;
  std::vector<HandleLoop> handles;
  std::copy_if(found.loops.cbegin(), endOfHandles(found), std::back_inserter(handles),
    [&](const HandleLoop& loop) { return loop.length >= limits.handles; });
  const double growth = handles.size() >= kManyHandles ? kMostGrowthOfMany : kMostGrowthOfSeveral;
  return handles.size() >= kSeveralHandles && !resolvesLoops(run, handles, growth);
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
    eraseIf(loops, [&](const HandleLoop& loop) { return isSmall[loop.vertices.front()] != 0; });
  }
  return loops;
}

std::vector<HandleLoop> handlesBelow(RunContext& run, double limit)
{
  std::vector<HandleLoop> loops;
  if (limit > kQuadsOfLoop * run.edgeLength)
  {
    const Level& level = run.levels.makeIntermediate(run.surface, levelOptions(run, {}));
    loops = findHandles(level.mesh, limit).loops;
    for (HandleLoop& loop : loops)
    {
      loop.vertices = onFinest(loop.vertices, level);
    }
    return loops;
  }
  std::copy_if(run.shortLoops.loops.cbegin(), endOfHandles(run.shortLoops),
    std::back_inserter(loops), [&](const HandleLoop& loop) { return loop.length < limit; });
  return loops;
}

} // namespace quadrille
