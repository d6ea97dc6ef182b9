// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FirstLevels.h"

#include "Pipeline/FirstPlan.h"
#include "Pipeline/Notices.h"

namespace quadrille
{
namespace
{

std::size_t bytesOfLoops(const ShortLoops& found)
{
  std::size_t bytes = sizeof(ShortLoops);
  for (const HandleLoop& loop : found.loops)
  {
    bytes += bytesOf(loop.vertices);
  }
  return bytes;
}

} // namespace

void findShortLoops(RunContext& run, StageRecords& stages, std::vector<std::string>& reused)
{
  const ResultKey key =
    KeyMaker(run.surface.key).add(run.edgeLength, run.options.smallestDetail).key();
  bool isKnown = true;
  run.shortLoops = *findOrMake<ShortLoops>(
    run.store, key,
    [&]
    {
      isKnown = false;
      const Level& level = run.levels.makeIntermediate(run.surface, levelOptions(run, {}));
      stages.add(run.levels.stages());
      const double start = secondsNow();
      ShortLoops made = measureSmallParts(
        level, run.surface->mesh, run.edgeLength, run.options.smallestDetail, run.options.threads);
      stages.add("handles", secondsNow() - start, level.mesh.faceCount(), made.parts.handles);
      return made;
    },
    bytesOfLoops);
  if (isKnown)
  {
    reused.emplace_back("handles");
  }
}

FirstLevels makeFirstLevels(
  SizedSurface& sized, const Frame& frame, const RemeshOptions& options, ResultStore* store)
{
  FirstLevels first;
  RunContext run = makeRun(sized, options, store);
  run.options.smallDetails = SmallDetails::Automatic; // smaller quads only where they are not many
  findShortLoops(run, first.stages, first.reused);
  first.smallParts = run.shortLoops.parts;
  first.sizes = sizeWish(run.surface);
  const QuadSize size{ sized.edgeLength, frame.unit, sized.targetQuads,
    options.maximumNumberOfQuads };
  const Plan plan = firstPlan(run);
  run.levels.make(withPlan(run.surface, plan), levelOptions(run, plan));
  first.stages.add(run.levels.stages());
  for (const char* stage : { "phase1", "phase2" })
  {
    if (!first.stages.has(stage))
    {
      first.reused.emplace_back(stage);
    }
  }
  first.hierarchy = run.levels.take();
  tell({ unresolvedHandlesText(first.smallParts, size), tinyHolesText(first.smallParts, size) },
    first.notices);
  tell(plan.notices, first.notices);
  tell({ first.hierarchy.notice }, first.notices);
  return first;
}

} // namespace quadrille
