// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RunResult.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "GridMap/MapShape.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/Notices.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

/// The stages that were taken over and that nothing in this run has computed.
std::vector<std::string> onlyReused(
  const std::vector<std::string>& names, const std::vector<StageRecord>& computed)
{
  std::vector<std::string> reused;
  for (const std::string& name : names)
  {
    const bool isComputed = std::any_of(computed.begin(), computed.end(),
      [&](const StageRecord& record) { return record.stage == name; });
    if (!isComputed && std::find(reused.begin(), reused.end(), name) == reused.end())
    {
      reused.push_back(name);
    }
  }
  return reused;
}

/// In the frame.
void takeAttempt(const Attempt& attempt, const RemeshOptions& options, RemeshResult& result)
{
  const MapAttempt& map = *attempt.map;
  result.status = attempt.quads ? attempt.quads->status : map.status;
  static_cast<RunMap&>(result) = std::move(static_cast<RunMap&>(*attempt.map));
  if (attempt.quads)
  {
    static_cast<RunQuads&>(result) = *attempt.quads;
  }
  if (!result.status.ok())
  {
    result.quads = {};
    return;
  }
  const FinalQuality level =
    result.finalQuality.improved ? result.finalQuality.level : FinalQuality::Coarse;
  result.mapKey = KeyMaker(map.key).add(level).key();
  // A map that started from another one is not told by its key.
  result.mapIsKnown =
    options.knownMap != 0 && result.mapKey == options.knownMap && !options.warmStart;
}

/// The features that a plan has given up, which is on the surface.
void addGivenUp(
  const Plan& plan, const Mesh& mesh, double edgeLength, std::vector<GivenUpCurve>& givenUp)
{
  if (!plan.featuresGivenUp)
  {
    return;
  }
  std::vector<Index> edges = *plan.featuresGivenUp;
  sortUnique(edges);
  for (const GivenUpCurve& curve : givenUpCurves(mesh, edges, edgeLength, FeatureLoss::FailedMap))
  {
    givenUp.push_back(curve);
  }
}

/// Where nothing has quads.
void noteFailed(const Attempt& attempt, const Mesh& mesh, RemeshResult& result)
{
  if (result.status.ok())
  {
    return;
  }
  result.failed.places = attempt.map->failedPlaces.empty()
    ? positionsOf(mesh, failedVertices(attempt, mesh))
    : attempt.map->failedPlaces;
}

void tellAttempt(const Attempt& attempt, const QuadSize& size, RemeshResult& result)
{
  const std::string handles = unresolvedHandlesText(result.smallParts, size);
  const std::string holes = tinyHolesText(result.smallParts, size);
  tell({ handles, holes }, result.notices);
  tell(attempt.plan.notices, result.notices);
  tell(attempt.map->notices, result.notices);
  tell(attempt.quads ? attempt.quads->notices : std::vector<std::string>{}, result.notices);
  for (const std::string& unresolved : { handles, holes })
  {
    if (!result.status.ok() && !unresolved.empty())
    {
      result.status.message += "; " + unresolved;
    }
  }
}

/// Why no other attempt was made though the quads leave something to be wished. isFinished: nothing mends them later.
void tellEnd(const History& history, bool isFinished, RemeshResult& result)
{
  const std::string inverted = result.status.ok() && isFinished ? invertedText(result.quads) : "";
  const std::string those = inverted.empty() ? "" : "; " + inverted;
  if (!result.stopped.empty())
  {
    tell({ stoppedText(result.stopped) + those }, result.notices);
  }
  else if (history.isSpent() && !inverted.empty())
  {
    tell({ "the work that a surface of this size is worth was done after " +
           std::to_string(history.attempts()) + " attempts; these are the best quads of them" +
           those },
      result.notices);
  }
}

void takeStages(
  const History& history, const Levels& levels, const SizedSurface& sized, RemeshResult& result)
{
  StageRecords stages = sized.stages;
  stages.add(history.stages());
  result.stages = stages.all();
  result.replays = history.replays();
  result.decimations += levels.decimations();
  std::vector<std::string> reused = sized.reused;
  if (levels.recalled())
  {
    reused.emplace_back("phase1");
  }
  reused.insert(reused.end(), history.reused().begin(), history.reused().end());
  result.reused = onlyReused(reused, result.stages);
  const std::vector<std::string> started = history.started();
  result.reused.insert(result.reused.end(), started.begin(), started.end());
}

} // namespace

void takeSized(const SizedSurface& sized, RemeshResult& result)
{
  tell(sized.notices, result.notices);
  result.status = sized.status;
  result.targetEdgeLength = sized.edgeLength;
  result.targetQuads = sized.targetQuads;
  result.details = sized.details;
  result.reused = sized.reused;
  result.givenUpFeatures = sized.givenUpFeatures;
  result.stages = sized.stages.all();
}

void takeBlocks(const SizedSurface& sized, RemeshResult& result)
{
  result.details.insert(result.details.end(), sized.blocks.begin(), sized.blocks.end());
  tell({ sized.blocksNotice }, result.notices);
  result.stages = sized.stages.all();
  result.reused = sized.reused;
}

void takeDetails(const Settled& settled, RemeshResult& result)
{
  result.decimations += settled.decimations;
  result.details.insert(result.details.end(), settled.details.begin(), settled.details.end());
  tell({ detailsNotice(settled.details) }, result.notices);
}

void takeAttempts(const History& history, RunContext& run, const Frame& frame,
  const RemeshOptions& options, bool quadsAlone, SizedSurface& sized, RemeshResult& result)
{
  const Attempt& attempt = history.result();
  result.tries.add(history.tries());
  result.work += history.work();
  result.targetQuads = run.targetQuads;
  result.smallParts = run.shortLoops.parts;
  sized.surface = withPlan(run.surface, attempt.plan).surface;
  if (!quadsAlone)
  {
    attempt.map->unpack(sized.surface->mesh);
  }
  takeAttempt(attempt, options, result);
  addGivenUp(attempt.plan, sized.surface->mesh, sized.edgeLength, result.givenUpFeatures);
  noteFailed(attempt, sized.surface->mesh, result);
  tellEnd(history, !sized.hasBeside, result);
  tellAttempt(attempt,
    { sized.edgeLength, frame.unit, sized.targetQuads, options.maximumNumberOfQuads }, result);
  takeStages(history, run.levels, sized, result);
}

void measureMap(const Mesh& mesh, const RemeshOptions& options, RemeshResult& result)
{
  if (!result.status.ok())
  {
    return;
  }
  if (options.mergeCharts && !result.mapIsKnown)
  {
    // After the extraction, so that the quads do not depend on it.
    const double start = secondsNow();
    result.charts = mergeCharts(mesh, result.uv);
    result.stages.push_back(
      { "charts", secondsNow() - start, mesh.faceCount(), result.charts.charts });
  }
  if (options.anisotropyLimit > 0)
  {
    result.beyondAnisotropyLimit =
      shareBeyondRatio(result.coarse.mesh, result.coarseUv, options.anisotropyLimit);
    tell(
      { anisotropyNotice(result.beyondAnisotropyLimit, options.anisotropyLimit),
        result.finalQuality.improved
          ? "final quality does not know the anisotropy limit: on the finer level more triangles "
            "may be beyond it"
          : "" },
      result.notices);
  }
}

void putOnUserSurface(SizedSurface& sized, const FramedInput& framed, const RemeshOptions& options,
  bool quadsAlone, RemeshResult& result)
{
  result.frame = framed.frame;
  if (result.status.ok() && !options.preview)
  {
    tell({ looseText(sized.surface->mesh, result.quads, sized.edgeLength) }, result.notices);
  }
  if (options.preview)
  {
    leaveFrameAlone(result, framed.frame);
    return;
  }
  if (quadsAlone)
  {
    leaveFrame(result, *sized.surface, framed.frame, framed.points);
    result.framed = sized.surface;
    result.uv = {};
    result.coarse = {};
    result.coarseUv = {};
    result.coarseTurns = {};
    return;
  }
  // Where the store has its triangles for the next run, they are copied where they change.
  result.surface = *sized.surface;
  sized.surface.reset();
  if (options.mergeCharts && !result.mapIsKnown && result.status.ok())
  {
    result.framePositions = result.surface.mesh.position;
  }
  leaveFrame(result, framed.frame, framed.points, options.keepsPositions, options.threads);
}

} // namespace quadrille
