// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FirstPlan.h"

#include "Base/PlaceText.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

/// So many quads are made to fit round a loop that is too short for three, if they need not be smaller than this for
/// it.
constexpr double kQuadsOfShrunkLoop = 4;
constexpr double kLeastShrink = 0.1;

/// In the store.
struct StoredFirstSizes
{
  std::shared_ptr<const std::vector<float>> sizes; ///< null: they would make too many quads
};

/// Null where they would make too many quads.
std::shared_ptr<const std::vector<float>> sizesAtLoops(RunContext& run)
{
  std::vector<float> sizes = run.surface.changedSizes(
    [&](Mesh& mesh)
    {
      const std::vector<float> factor =
        sizesOfLoops(run.shortLoops.loops, run.edgeLength, kLeastShrink, mesh.vertexCount());
      mesh.sizing.resize(mesh.vertexCount(), 1.0F);
      for (Index v = 0; v < mesh.vertexCount(); ++v)
      {
        mesh.sizing[v] *= factor[v];
      }
      limitSizeGrowth(mesh, run.edgeLength);
    });
  return run.surface.sizedArea(sizes) > kMostGrowth * run.surface.sizedArea()
    ? nullptr
    : std::make_shared<const std::vector<float>>(std::move(sizes));
}

/// The same, from the store where it has them.
std::shared_ptr<const std::vector<float>> knownSizesAtLoops(RunContext& run)
{
  if (run.store == nullptr)
  {
    return sizesAtLoops(run);
  }
  KeyMaker key(run.surface.key());
  key.add(run.edgeLength);
  for (const HandleLoop& loop : run.shortLoops.loops)
  {
    key.add(loop.length).add(loop.vertices);
  }
  auto known = run.store->find<StoredFirstSizes>(key.key());
  if (!known)
  {
    known = std::make_shared<StoredFirstSizes>(StoredFirstSizes{ sizesAtLoops(run) });
    run.store->put(key.key(), known, known->sizes ? bytesOf(*known->sizes) : 0);
  }
  return known->sizes;
}

} // namespace

std::vector<float> sizesOfLoops(
  const std::vector<HandleLoop>& loops, double edgeLength, double least, Index vertexCount)
{
  std::vector<float> sizes(vertexCount, 1.0F);
  for (const HandleLoop& loop : loops)
  {
    const double wanted = loop.length / (kQuadsOfShrunkLoop * edgeLength);
    for (const Index v : loop.vertices)
    {
      sizes[v] = std::min(sizes[v], static_cast<float>(std::max(least, wanted)));
    }
  }
  return sizes;
}

double quadsFor(const RunContext& run, const Plan& plan, double sizedArea)
{
  const FinerGrid& finer = plan.finer;
  const double local = finer.areaBefore > 0 && finer.mayShrink ? sizedArea / finer.areaBefore : 1;
  return static_cast<double>(run.targetQuads) * std::pow(2.0, finer.doublings) * local;
}

Plan firstPlan(RunContext& run)
{
  Plan plan;
  plan.levels.keptVertices = keptVertices(*run.surface);
  plan.levels.coarseVertices = run.options.coarseVertices;
  plan.nextLevels = plan.levels;
  plan.quads = quadsFor(run, plan, 0);
  const std::vector<HandleLoop>& loops = run.shortLoops.loops;
  if (loops.empty() || run.options.coarsestIntegers || run.options.method != MapMethod::ScaleAware)
  {
    return plan;
  }
  plan.sizes = knownSizesAtLoops(run);
  if (!plan.sizes)
  {
    return plan;
  }
  plan.notices.push_back("quads are made smaller round " + std::to_string(loops.size()) +
    " handles and holes that are shorter round than three of the wanted size, one of them near " +
    placeText(run.surface->mesh.position[loops.front().vertices.front()]) +
    "; close or fill them for quads of one size");
  return plan;
}

} // namespace quadrille
