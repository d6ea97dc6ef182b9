// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FirstPlan.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Mesh/Sizing.h"
#include "Requests/Guides.h"
#include "Requests/VerticesForSizes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

/// Where smaller quads make their number grow by more than this factor they may as well be smaller everywhere.
constexpr double kMostGrowth = 1.6;

/// #V, 1 away from the loops: sizes, as multiples of edgeLength, with which four quads fit round each loop.
std::vector<float> sizesOfLoops(
  const std::vector<HandleLoop>& loops, double edgeLength, Index vertexCount)
{
  std::vector<float> sizes(vertexCount, 1.0F);
  for (const HandleLoop& loop : loops)
  {
    const double wanted = loop.length / (kQuadsOfSafeLoop * edgeLength);
    for (const Index v : loop.vertices)
    {
      sizes[v] = std::min(sizes[v], static_cast<float>(std::max(kLeastShrink, wanted)));
    }
  }
  return sizes;
}

/// Null: they would make too many quads.
struct FirstSizes
{
  std::shared_ptr<const std::vector<float>> sizes;
};

/// How many times as many quads smaller ones may make.
double mostGrowth(const RunContext& run)
{
  return run.options.smallDetails != SmallDetails::Resolve
    ? kMostGrowth
    : std::max(kMostGrowth,
        static_cast<double>(run.options.maximumNumberOfQuads) /
          static_cast<double>(run.targetQuads));
}

FirstSizes makeFirstSizes(const RunContext& run, const std::vector<HandleLoop>& loops)
{
  Mesh mesh = run.surface->mesh;
  const std::vector<float> factor = sizesOfLoops(loops, run.edgeLength, mesh.vertexCount());
  mesh.sizing.resize(mesh.vertexCount(), 1.0F);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    mesh.sizing.edit()[v] *= factor[v];
  }
  limitSizeGrowth(mesh, run.edgeLength);
  std::vector<float> sizes = mesh.sizing.take();
  const bool areTooMany =
    areaOverSizes(*run.surface, sizes) > mostGrowth(run) * areaOverSizes(*run.surface);
  return { areTooMany ? nullptr : std::make_shared<const std::vector<float>>(std::move(sizes)) };
}

/// The same, from the store where it has them.
std::shared_ptr<const std::vector<float>> sizesAtLoops(
  const RunContext& run, const std::vector<HandleLoop>& loops)
{
  KeyMaker key(run.surface.key);
  key.add(run.edgeLength, mostGrowth(run));
  for (const HandleLoop& loop : loops)
  {
    key.add(loop.length, loop.vertices);
  }
  return findOrMake<FirstSizes>(
    run.store, key.key(), [&] { return makeFirstSizes(run, loops); },
    [](const FirstSizes& made) { return made.sizes ? bytesOf(*made.sizes) : 0; })
    ->sizes;
}

} // namespace

bool mayResolve(const RemeshOptions& options)
{
  return options.smallDetails != SmallDetails::Keep && !options.coarsestIntegers &&
    options.method == MapMethod::ScaleAware;
}

bool resolvesLoops(const RunContext& run, const std::vector<HandleLoop>& loops, double most)
{
  if (loops.empty())
  {
    return true;
  }
  const auto sizes = mayResolve(run.options) ? sizesAtLoops(run, loops) : nullptr;
  return sizes && areaOverSizes(*run.surface, *sizes) <= most * areaOverSizes(*run.surface);
}

LevelPlan firstLevels(const RunContext& run)
{
  LevelPlan levels;
  levels.keptVertices = keptVertices(*run.surface);
  levels.coarseVertices = run.options.coarseVertices;
  const std::vector<Index> forSizes = verticesForSizes(*run.surface, run.edgeLength);
  if (!forSizes.empty())
  {
    std::vector<Index>& kept = levels.keptVertices;
    const std::size_t before = kept.size();
    append(kept, forSizes);
    sortUnique(kept);
    // Not fewer elsewhere because of these; 0 is as many as the curvature needs.
    levels.coarseVertices +=
      levels.coarseVertices == 0 ? 0 : static_cast<Index>(kept.size() - before);
  }
  return levels;
}

Plan firstPlan(RunContext& run)
{
  Plan plan;
  plan.levels = firstLevels(run);
  plan.quads = static_cast<double>(run.targetQuads);
  const std::vector<HandleLoop>& loops = run.shortLoops.loops;
  if (loops.empty() || !mayResolve(run.options))
  {
    return plan;
  }
  plan.sizes = sizesAtLoops(run, loops);
  if (!plan.sizes)
  {
    return plan;
  }
  const double growth = areaOverSizes(*run.surface, *plan.sizes) / areaOverSizes(*run.surface);
  if (growth > kMostGrowth)
  {
    // With the same number of quads all others would be so much larger that there were other short loops.
    run.targetQuads = static_cast<std::size_t>(std::llround(growth * plan.quads));
    plan.quads = static_cast<double>(run.targetQuads);
  }
  plan.notices.push_back("quads are made smaller round " + std::to_string(loops.size()) +
    " handles and holes that are shorter round than three of the wanted size, one of them near " +
    placeText(run.surface->mesh.position[loops.front().vertices.front()]) +
    "; close or fill them for quads of one size");
  return plan;
}

} // namespace quadrille
