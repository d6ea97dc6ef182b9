// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FirstLevels.h"

#include "Pipeline/FirstPlan.h"

namespace quadrille
{
namespace
{

struct StoredShortLoops
{
  ShortLoops loops;
};

} // namespace

void findShortLoops(RunContext& run, StageRecords& stages, std::vector<std::string>& reused)
{
  const ResultKey key = KeyMaker(run.surface.key())
                          .add(run.edgeLength)
                          .add(std::uint64_t{ run.levels.hasFollowed() ? 1U : 0U })
                          .key();
  if (run.store != nullptr)
  {
    if (const auto known = run.store->find<StoredShortLoops>(key))
    {
      run.shortLoops = known->loops;
      reused.emplace_back("handles");
      return;
    }
  }
  const Level& intermediate = run.levels.makeIntermediate(levelOptions(run, {}));
  stages.add(run.levels.stages());
  const double start = secondsNow();
  run.shortLoops =
    measureSmallParts(intermediate, run.surface->mesh, run.edgeLength, run.options.threads);
  stages.add(
    "handles", secondsNow() - start, intermediate.mesh.faceCount(), run.shortLoops.parts.handles);
  if (run.store != nullptr)
  {
    std::size_t bytes = sizeof(StoredShortLoops) + bytesOf(run.shortLoops.hopelessPlaces);
    for (const HandleLoop& loop : run.shortLoops.loops)
    {
      bytes += bytesOf(loop.vertices);
    }
    run.store->put(
      key, std::make_shared<StoredShortLoops>(StoredShortLoops{ run.shortLoops }), bytes);
  }
}

FirstLevels makeFirstLevels(
  SizedSurface& sized, const Frame& frame, const RemeshOptions& options, ResultStore* store)
{
  FirstLevels first;
  RunSurface surface(sized.surface, sized.key, options.threads);
  Levels levels(surface, store);
  RemeshOptions bounded = options; // smaller quads only where they are not many
  bounded.smallDetails = SmallDetails::Automatic;
  RunContext run{ bounded, sized.edgeLength, sized.targetQuads, surface, levels, store, {} };
  findShortLoops(run, first.stages, first.reused);
  first.smallParts = run.shortLoops.parts;
  const QuadSize size{ sized.edgeLength, frame.unit, sized.targetQuads,
    options.maximumNumberOfQuads };
  const Plan plan = firstPlan(run);
  surface.apply(plan);
  levels.make(levelOptions(run, plan));
  first.stages.add(levels.stages());
  for (const char* stage : { "phase1", "phase2" })
  {
    if (!first.stages.has(stage))
    {
      first.reused.emplace_back(stage);
    }
  }
  if (store == nullptr)
  {
    first.hierarchy = levels.take();
  }
  else
  {
    first.hierarchy = levels.hierarchy();
    levels.letGo();
  }
  first.notices = { unresolvedHandlesText(first.smallParts, size),
    tinyHolesText(first.smallParts, size) };
  first.notices.insert(first.notices.end(), plan.notices.begin(), plan.notices.end());
  first.notices.push_back(first.hierarchy.notice);
  return first;
}

} // namespace quadrille
