// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FaceDivision.h"
#include "Pipeline/Strategies.h"
#include "Requests/Guides.h"

#include "Base/Lists.h"
#include "Mesh/Mesh.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Where a map failed at so many vertices, it must have halved the number of the one before to deserve another.
constexpr std::size_t kManyFailed = 100;
/// A failure at no place in particular is worth another try with more vertices only where it took less than this part
/// of the bound of work: integers that are searched for long and not found are a matter of features.
constexpr double kCheapFailure = 0.25;
/// Of the surface: faces with less area are cut out before more vertices are tried, of which a map of all takes longer.
constexpr double kLittleArea = 0.02;
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
  std::vector<std::uint8_t> near(vertexCount, 0);
  for (const Index v : vertices)
  {
    near[v] = 1;
  }
  for (int ring = 0; ring < kFreedomRings; ++ring)
  {
    std::vector<Index> added;
    for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      const Index from = level.fineVertex[level.mesh.origin[h]];
      const Index to = level.fineVertex[level.mesh.target(h)];
      if (near[from] != near[to])
      {
        added.push_back(near[from] ? to : from);
      }
    }
    for (const Index v : added)
    {
      near[v] = 1;
    }
  }
  std::vector<Index> found;
  for (const Index v : level.fineVertex)
  {
    if (near[v])
    {
      found.push_back(v);
    }
  }
  return found;
}

} // namespace

std::optional<Plan> moreFreedom(const AttemptFailure& failure)
{
  const History& history = failure.history;
  const Attempt& last = history.last();
  const std::size_t failed = last.map->failedAt.size();
  const std::size_t times = history.trailing("more freedom");
  if (last.map->status.ok() || last.map->hopeless || times == failure.bound ||
    (times > 0 && failed >= kManyFailed && 2 * failed > history.failedBefore()))
  {
    return std::nullopt;
  }
  if (keepsFeatures(*failure.surface) &&
    isCutAtFaces(*failure.run.surface.surface, failure.run.options, history) &&
    (times > 0 ||
      (!history.failedFaces().empty() &&
        shareOfFailed(*failure.run.surface.surface, history.failedFaces()) <= kLittleArea)))
  {
    return std::nullopt;
  }
  if (failed == 0 &&
    static_cast<double>(last.map->work) > kCheapFailure * static_cast<double>(history.bound().work))
  {
    return std::nullopt;
  }
  RunContext& run = failure.run;
  const Hierarchy& levels = run.levels.make(failure.surface, levelOptions(run, last.plan));
  const Index coarse = levels.coarse.mesh.vertexCount();
  Plan plan = last.plan;
  if (coarse == levels.intermediate.mesh.vertexCount())
  {
    plan.levels.edgeLength /= std::sqrt(2.0);
    plan.levels.coarseVertices = 2 * coarse;
    plan.nextLevels = plan.levels;
    return plan;
  }
  const std::size_t before = plan.levels.keptVertices.size();
  keepAlso(
    ringsRound(levels.intermediate, last.map->failedAt, failure.surface->mesh.vertexCount()), plan);
  const std::size_t added = plan.levels.keptVertices.size() - before;
  plan.levels.coarseVertices =
    static_cast<Index>(std::max<std::size_t>(coarse + added, std::size_t{ coarse } * 5 / 4));
  if (failed < kManyFailed)
  {
    // More have a cause that another round may take away, and the vertices would stand in the way of its map.
    plan.nextLevels = plan.levels;
  }
  return plan;
}

std::optional<Plan> keptDefects(const AttemptFailure& failure)
{
  const History& history = failure.history;
  const std::size_t times = history.inRound("kept defects");
  if (!history.lastIsBest() || times == failure.bound)
  {
    return std::nullopt;
  }
  const MapAttempt& map = *history.last().map;
  const std::vector<Index>& atDefects = map.transfer.defectVertices;
  const Index coarse = map.coarse.mesh.vertexCount();
  // With defects everywhere it is not a matter of a few places, and the coarse level would grow out of hand.
  if (hasPromised(map.certificate, failure.run.options.method) || atDefects.empty() ||
    atDefects.size() > coarse / 2)
  {
    return std::nullopt;
  }
  Plan plan = history.last().plan;
  keepAlso(atDefects, plan);
  if (plan.levels.coarseVertices == 0)
  {
    plan.levels.coarseVertices = coarse; // not fewer elsewhere because of these
  }
  plan.levels.coarseVertices += static_cast<Index>(atDefects.size());
  return plan;
}

std::optional<Plan> roomForCurves(const AttemptFailure& failure)
{
  const History& history = failure.history;
  const MapAttempt& map = *history.last().map;
  if (!history.lastIsBest() || map.curvesFailedAt.empty() ||
    history.inRound("room for curves") == failure.bound)
  {
    return std::nullopt;
  }
  RunContext& run = failure.run;
  Plan plan = history.last().plan;
  const Hierarchy& levels = run.levels.make(failure.surface, levelOptions(run, plan));
  const std::size_t before = plan.levels.keptVertices.size();
  keepAlso(
    ringsRound(levels.intermediate, map.curvesFailedAt, failure.surface->mesh.vertexCount()), plan);
  plan.levels.coarseVertices =
    levels.coarse.mesh.vertexCount() + static_cast<Index>(plan.levels.keptVertices.size() - before);
  return plan;
}

} // namespace quadrille
