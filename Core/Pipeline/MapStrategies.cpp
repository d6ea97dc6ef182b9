// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FaceDivision.h"
#include "Pipeline/Strategies.h"

#include "Base/Lists.h"
#include "Mesh/BreadthFirst.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Faces are filled at once where a map fails at more vertices: that has a cause that more freedom does not take away.
constexpr std::size_t kFewFailed = 10;
/// Rings of intermediate vertices that are kept round a vertex that the map failed at.
constexpr int kFreedomRings = 2;

void keepAlso(const std::vector<Index>& vertices, Plan& plan)
{
  std::vector<Index>& kept = plan.levels.keptVertices;
  append(kept, vertices);
  sortUnique(kept);
}

/// Vertices of the surface that are on the level, within some rings round others.
std::vector<Index> ringsRound(
  const Level& level, const std::vector<Index>& vertices, std::size_t vertexCount)
{
  std::vector<std::uint8_t> isStart(vertexCount, 0);
  for (const Index v : vertices)
  {
    isStart[v] = 1;
  }
  const std::vector<Index>& onLevel = level.fineVertex;
  const std::vector<int> ring = ringsFrom(level.mesh,
    idsWhere(onLevel.size(), [&](Index i) { return isStart[onLevel[i]] != 0; }), kFreedomRings);
  std::vector<Index> near;
  for (std::size_t i = 0; i < onLevel.size(); ++i)
  {
    if (ring[i] <= kFreedomRings)
    {
      near.push_back(onLevel[i]);
    }
  }
  return near;
}

} // namespace

std::optional<Plan> moreFreedom(const AttemptFailure& failure)
{
  RunContext& run = failure.run;
  const Attempt& last = failure.history.last();
  const std::vector<Index>& failedAt = last.map->failedAt;
  const std::size_t times = failure.history.inRound("more freedom");
  if (last.map->status.ok() || last.map->hopeless || times == failure.bound)
  {
    return std::nullopt;
  }
  const bool hasFaces = keepsFeatures(*failure.surface) &&
    isCutAtFaces(*run.surface.surface, run.options, failure.history);
  if (hasFaces && (times > 0 || failedAt.size() > kFewFailed))
  {
    return std::nullopt;
  }
  const Hierarchy& levels = run.levels.make(failure.surface, levelOptions(run, last.plan));
  const Index coarse = levels.coarse.mesh.vertexCount();
  Plan plan = last.plan;
  if (coarse == levels.intermediate.mesh.vertexCount())
  {
    plan.levels.edgeLength /= std::sqrt(2.0);
    plan.levels.coarseVertices = 2 * coarse;
    return plan;
  }
  const std::size_t before = plan.levels.keptVertices.size();
  keepAlso(ringsRound(levels.intermediate, failedAt, failure.surface->mesh.vertexCount()), plan);
  const std::size_t added = plan.levels.keptVertices.size() - before;
  plan.levels.coarseVertices =
    static_cast<Index>(std::max<std::size_t>(coarse + added, std::size_t{ coarse } * 5 / 4));
  return plan;
}

} // namespace quadrille
