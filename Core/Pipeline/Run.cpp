// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run on one page [Ebke et al. 2016, Section 3]: three levels of the surface, field and map of the coarse one, the
/// map carried back to the surface, its quads; and what is tried where a map or its quads fail.
#include "Pipeline/Run.h"

#include "Base/Progress.h"
#include "Pipeline/Attempt.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/History.h"
#include "Pipeline/Recovery.h"
#include "Pipeline/Restarts.h"
#include "Pipeline/RunResult.h"

#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// The memory of the last map, for the next one.
struct SpareMap
{
  std::vector<FixedVec2> uv;
};

/// The map of the surface by a plan, or why the coarse level has none. allowance: work that it may take.
std::shared_ptr<MapAttempt> makeMap(RunContext& run, const Plan& plan, std::size_t allowance)
{
  const TryScope tries;
  const PlannedSurface surface = withPlan(run.surface, plan, run.options.threads);
  const ResultKey key = mapKey(run, surface, plan);
  std::shared_ptr<MapAttempt> map = findMap(run, key, allowance);
  if (map && (!map->status.ok() || map->isCarried || run.options.preview))
  {
    return map;
  }
  const Hierarchy& levels = run.levels.make(surface, levelOptions(run, plan));
  if (!map || !isMapOf(*map, levels))
  {
    map = makeCoarseMap(run, surface, levels, plan, key, allowance);
  }
  if (map->status.ok() && !run.options.preview)
  {
    carryToSurface(run, surface, levels, *map);
  }
  map->tries.add(tries.counts());
  keepMap(run, surface->mesh, *map);
  return map;
}

/// What progress says of the attempts by a plan.
std::string triedText(const Plan& plan, const History& history)
{
  return history.attempts() == 0 ? ""
                                 : "Attempt " + std::to_string(history.attempts() + 1) +
      " of at most " + std::to_string(history.bound().attempts) + ", " + plan.step +
      (plan.why.empty() ? "" : " (" + plan.why + ")");
}

/// The quads of the best map of a round.
void makeQuadsOfRound(RunContext& run, History& history)
{
  const Attempt& best = history.ofRound();
  const PlannedSurface surface = withPlan(run.surface, best.plan, run.options.threads);
  history.addQuads(!history.roundHasMap() ? nullptr
      : run.options.preview               ? makePreview(run, surface, best.plan, *best.map)
                                          : makeQuads(run, surface, best.plan, *best.map));
}

/// Rounds of attempts until one is good or nothing is left to try: maps until one is good or no other would be better,
/// then the quads of the best one. isLast: where no attempt has quads, nothing follows.
/// After a stop result.stopped tells what was tried, and the quads so far are the result, or those of a map that is
/// there already; throws Cancelled without any.
void makeRounds(
  RunContext& run, std::optional<Plan> plan, bool isLast, History& history, RemeshResult& result)
{
  bool makesQuads = false; // a stop meanwhile may leave the map half solved
  try
  {
    for (; plan; plan = nextPlan(run, history, isLast))
    {
      for (; plan; plan = nextMapPlan(run, history))
      {
        *run.tried = triedText(*plan, history);
        if (isLastResort(*plan))
        {
          history.beginLastResort();
        }
        history.packMaps(run.surface->mesh);
        history.addMap(*plan, makeMap(run, *plan, history.allowance()));
      }
      makesQuads = true;
      makeQuadsOfRound(run, history);
      makesQuads = false;
    }
  }
  catch (const Cancelled&)
  {
    if (!history.hasResult() && (!history.roundHasMap() || makesQuads))
    {
      throw;
    }
    result.stopped = run.tried->empty() ? "attempt 1" : *run.tried;
    if (!history.hasResult())
    {
      makeQuadsOfRound(run, history);
    }
    if (!history.hasResult())
    {
      result.stopped.clear();
      throw;
    }
  }
  result.attempts.insert(result.attempts.end(), history.steps().begin(), history.steps().end());
}

/// Rounds, and others where no attempt has quads.
History makeAttempts(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, RemeshResult& result)
{
  History history = firstHistory(settled, sized, options);
  Plan first = firstPlan(*settled.run);
  makeRounds(*settled.run, first, !hasRest(settled, options), history, result);
  const auto beginAgain = [&](std::optional<Restart> again)
  {
    if (again)
    {
      result.tries.addTaken(history.tries());
      sized.stages.add("retries", history.seconds(), 0, 0);
      history = std::move(again->history);
      countTry(again->what, again->isCounted ? 1 : 0);
      makeRounds(*settled.run, std::move(again->plan), true, history, result);
      countTryLed(again->what, again->isCounted && history.hasResult() ? 1 : 0);
    }
  };
  if (!history.hasResult())
  {
    beginAgain(withoutRest(settled, sized, options, store, first, history));
  }
  if (!history.hasResult())
  {
    beginAgain(withYieldingBorders(settled, sized, first, history));
  }
  for (int i = 0; i < kMostLeftOut && !history.hasResult(); ++i)
  {
    beginAgain(withoutFailed(settled, sized, options, store, first, history, result.failed));
  }
  return history;
}

RemeshResult remeshInput(
  SurfaceInput& input, const RemeshOptions& given, ResultStore* store, bool quadsAlone)
{
  const auto run =
    [&](const RemeshOptions& asked, ResultStore* room, PlaceScope& places, RemeshResult& result)
  {
    EnteredInput entered = enterFrame(std::move(input), asked, room);
    const Frame& frame = entered.framed.frame;
    places.set(frame.centre, frame.unit, frame.sign);
    RemeshOptions options = optionsInFrame(asked, frame);
    options.mergeCharts = options.mergeCharts && !options.preview && !quadsAlone;
    SizedSurface sized = sizeSurface(entered.framed.input, options, entered.known);
    remeshSized(sized, frame, options, room, quadsAlone, result);
    putOnUserSurface(sized, entered.framed, options, quadsAlone, result);
    if (asked.edgeLength && !asked.quads)
    {
      result.targetEdgeLength = *asked.edgeLength; // with every bit
    }
  };
  return guardedRun(input, given, store, run);
}

} // namespace

void remeshSized(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, RemeshResult& result)
{
  takeSized(sized, result);
  if (!result.status.ok())
  {
    return;
  }
  Settled settled = settleDetails(sized, options, store);
  takeBlocks(sized, result);
  if (!settled.status.ok())
  {
    result.status = settled.status;
    takeDetails(settled, result);
    return;
  }
  if (const auto spare = quadsAlone ? findIn<SpareMap>(store, 0) : nullptr)
  {
    settled.run->spare.swap(spare->uv);
  }
  {
    const History history = makeAttempts(settled, sized, options, store, result);
    settled.run->levels.letGo();
    takeDetails(settled, result);
    takeAttempts(history, *settled.run, frame, options, quadsAlone, sized, result);
  }
  if (quadsAlone && store != nullptr)
  {
    auto spare = std::make_shared<SpareMap>();
    spare->uv.swap(result.uv.empty() ? settled.run->spare : result.uv);
    const std::size_t bytes = bytesOf(spare->uv);
    store->put(0, std::move(spare), bytes);
  }
  settled.run.reset(); // only attempts need it
  measureMap(sized.surface->mesh, options, result);
}

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options)
{
  return remeshInput(input, options, nullptr, false);
}

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options, ResultStore& store)
{
  return remeshInput(input, options, &store, false);
}

RemeshResult remeshQuads(SurfaceInput input, const RemeshOptions& options, ResultStore& store)
{
  return remeshInput(input, options, &store, true);
}

} // namespace quadrille
