// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Run.h"

#include "Base/Progress.h"
#include "GridMap/MapShape.h"
#include "Pipeline/Attempt.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/History.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/Notices.h"
#include "Pipeline/Recovery.h"
#include "Pipeline/SettledSurface.h"
#include "Pipeline/Strategies.h"

#include <algorithm>
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

std::size_t countTriangles(const SurfaceInput& input)
{
  std::size_t triangles = 0;
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    pollNowAndThen(i);
    const std::size_t corners = input.polygonOffsets[i + 1] - input.polygonOffsets[i];
    triangles += std::max<std::size_t>(corners, 2) - 2;
  }
  return triangles;
}

/// Says what the run will cost; not ok where the memory is not there.
Status estimate(std::size_t triangles, const RemeshOptions& options, RemeshResult& result)
{
  const double quads =
    static_cast<double>(std::min(options.quads.value_or(0), options.maximumNumberOfQuads));
  result.estimate = estimateRun(triangles, quads, options.threads);
  report(options.progress, 0,
    "Preparing: " + estimateText(result.estimate) + " for " + std::to_string(triangles) +
      " triangles");
  return memoryStatus(result.estimate, triangles, options);
}

/// Maps until one is good or no other would be better.
void makeRound(RunContext& run, History& history, std::optional<Plan> plan)
{
  while (plan)
  {
    if (history.attempts() > 0)
    {
      run.tried = "Attempt " + std::to_string(history.attempts() + 1) + " of at most " +
        std::to_string(history.bound().attempts) + ", " + plan->step +
        (plan->why.empty() ? "" : " (" + plan->why + ")");
    }
    if (plan->step == std::string(kNoFeatures) || plan->step == std::string(kNoBorders))
    {
      history.beginLastResort();
    }
    history.packMaps(run.surface->mesh);
    history.addMap(*plan, makeMap(run, *plan, history.allowance()));
    plan = nextMapPlan(run, history);
  }
}

void makeQuadsOfRound(RunContext& run, History& history)
{
  const Attempt& best = history.ofRound();
  run.surface.apply(best.plan);
  history.addQuads(!history.roundHasMap() ? nullptr
      : run.options.preview               ? makePreview(run, best.plan, *best.map)
                                          : makeQuads(run, best.plan, *best.map));
}

/// Rounds of attempts until one is good or nothing is left to try. begin: none for the first plan of the surface.
/// isLast: where no attempt has quads, nothing follows. stopped: RemeshResult::stopped; after a stop it tells what was
/// tried, and the quads so far are the result, or those of a map that is there already; throws Cancelled without any.
void makeAttempts(RunContext& run, History& history, bool isLast, std::string& stopped,
  std::optional<Plan> begin = std::nullopt)
{
  bool makesQuads = false; // a stop meanwhile may leave the map half solved
  try
  {
    for (std::optional<Plan> plan = begin ? std::move(begin) : firstPlan(run); plan;
         plan = nextPlan(run, history, isLast))
    {
      makeRound(run, history, std::move(plan));
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
    stopped = run.tried.empty() ? "attempt 1" : run.tried;
    if (!history.hasResult())
    {
      makeQuadsOfRound(run, history);
    }
    if (!history.hasResult())
    {
      stopped.clear();
      throw;
    }
  }
}

void tell(const std::vector<std::string>& notices, RemeshResult& result)
{
  for (const std::string& notice : notices)
  {
    if (!notice.empty())
    {
      result.notices.push_back(notice);
    }
  }
}

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

void tellAnisotropy(const RemeshOptions& options, RemeshResult& result)
{
  if (!(options.anisotropyLimit > 0) || !result.status.ok())
  {
    return;
  }
  result.beyondAnisotropyLimit =
    shareBeyondRatio(result.coarse.mesh, result.coarseUv, options.anisotropyLimit);
  tell({ anisotropyNotice(result.beyondAnisotropyLimit, options.anisotropyLimit),
         result.finalQuality.improved
           ? "final quality does not know the anisotropy limit: on the finer level more triangles "
             "may be beyond it"
           : "" },
    result);
}

/// The attempt that counts, in the frame.
void takeAttempt(const Attempt& attempt, const RemeshOptions& options, bool quadsAlone,
  RunSurface& surface, RemeshResult& result)
{
  surface.apply(attempt.plan);
  MapAttempt& map = *attempt.map;
  result.status = map.status;
  result.turns = std::move(map.turns);
  result.onFeatures = map.onFeatures;
  if (!quadsAlone)
  {
    map.unpack(surface->mesh);
    result.uv = std::move(map.uv);
  }
  result.coarse = std::move(map.coarse);
  result.coarseUv = std::move(map.coarseUv);
  result.coarseTurns = std::move(map.coarseTurns);
  result.curves = map.curves;
  result.coarseCertificate = map.coarseCertificate;
  result.certificate = map.certificate;
  result.transfer = std::move(map.transfer);
  if (attempt.quads)
  {
    const QuadAttempt& made = *attempt.quads;
    result.status = made.status;
    result.quads = made.status.ok() ? made.quads : QuadMesh{};
    result.extraction = made.extraction;
    result.finalQuality = made.finalQuality;
  }
  if (result.status.ok())
  {
    const FinalQuality level =
      result.finalQuality.improved ? result.finalQuality.level : FinalQuality::Coarse;
    result.mapKey = KeyMaker(map.key).add(static_cast<std::uint64_t>(level)).key();
    // A map that started from another one is not told by its key.
    result.mapIsKnown =
      options.knownMap != 0 && result.mapKey == options.knownMap && !options.warmStart;
  }
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
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const GivenUpCurve& curve : givenUpCurves(mesh, edges, edgeLength, FeatureLoss::FailedMap))
  {
    givenUp.push_back(curve);
  }
}

void tellAttempt(const Attempt& attempt, const QuadSize& size, RemeshResult& result)
{
  const std::string handles = unresolvedHandlesText(result.smallParts, size);
  const std::string holes = tinyHolesText(result.smallParts, size);
  tell({ handles, holes }, result);
  tell(attempt.plan.notices, result);
  tell({ attempt.plan.borderNotice }, result);
  tell(attempt.map->notices, result);
  if (attempt.quads)
  {
    tell(attempt.quads->notices, result);
  }
  tell({ result.status.ok() ? attempt.plan.finer.notice : "" }, result);
  for (const std::string& unresolved : { handles, holes })
  {
    if (!result.status.ok() && !unresolved.empty())
    {
      result.status.message += "; " + unresolved;
    }
  }
}

/// Why no other attempt was made though the quads leave something to be wished.
void tellEnd(const History& history, RemeshResult& result)
{
  const std::string inverted = result.status.ok() ? invertedText(result.quads) : "";
  const std::string those = inverted.empty() ? "" : "; " + inverted;
  if (!result.stopped.empty())
  {
    tell({ "stopped on request (" + result.stopped +
           "): these are the best quads so far, others were still being tried" + those },
      result);
  }
  else if (history.isSpent() && !inverted.empty())
  {
    tell({ "the work that a surface of this size is worth was done after " +
           std::to_string(history.attempts()) + " attempts; these are the best quads of them" +
           those },
      result);
  }
}

void takeHistory(
  const History& history, const Levels& levels, const StageRecords& sized, RemeshResult& result)
{
  StageRecords stages = sized;
  stages.add(history.stages());
  result.stages = stages.all();
  result.replays = history.replays();
  result.decimations += levels.decimations();
  std::vector<std::string> reused = std::move(result.reused);
  if (levels.recalled())
  {
    reused.emplace_back("phase1");
  }
  reused.insert(reused.end(), history.reused().begin(), history.reused().end());
  result.reused = onlyReused(reused, result.stages);
  const std::vector<std::string> started = history.started();
  result.reused.insert(result.reused.end(), started.begin(), started.end());
}

void tellDetails(const Settled& settled, RemeshResult& result)
{
  result.decimations += settled.decimations;
  result.details.insert(result.details.end(), settled.details.begin(), settled.details.end());
  tell({ detailsNotice(settled.details) }, result);
}

/// Of the attempts before the rest of the details is taken out: the last third is for those after it.
WorkBound boundBeforeRest(WorkBound bound)
{
  bound.work = bound.work / 3 * 2;
  bound.attempts = bound.attempts / 3 * 2;
  bound.attemptsOfLastResort = 0;
  return bound;
}

double secondsOf(const History& history)
{
  double seconds = 0;
  const StageRecords stages = history.stages();
  for (const StageRecord& record : stages.all())
  {
    seconds += record.seconds;
  }
  return seconds;
}

/// Attempts; where none has quads, again without the details that were left for them to resolve.
void attemptWithBorders(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, History& history, RemeshResult& result)
{
  const auto spare = quadsAlone && store ? store->find<SpareMap>(0) : nullptr;
  if (spare)
  {
    settled.bench->run.spare.swap(spare->uv);
  }
  const WorkBound bound = workBound(sized.surface->mesh.faceCount(), sized.targetQuads);
  const bool isLast = !hasRest(settled, options);
  history = History(isLast ? bound : boundBeforeRest(bound));
  makeAttempts(settled.bench->run, history, isLast, result.stopped);
  result.attempts = history.steps();
  if (history.hasResult() || isLast)
  {
    return;
  }
  const bool isMatterOfFeatures = leavesNoArea(*history.last().map);
  const bool isOther = simplifyRest(settled, sized, options, store, sized.stages, result.reused);
  std::optional<Plan> begin;
  if ((!isOther || isMatterOfFeatures) && settled.status.ok())
  {
    // All would fail again but the last resort: on the same surface, or where features alone leave no area to so many
    // triangles.
    RunContext& run = settled.bench->run;
    begin = withoutFeatures(run, firstPlan(run));
    if (begin)
    {
      setStep(*begin, Try::NoFeatures);
    }
  }
  if (!settled.status.ok() || (!isOther && !begin))
  {
    return;
  }
  const bool isBegun = begin.has_value();
  countTry(Try::FewerDetails, isOther ? 1 : 0);
  const double seconds = secondsOf(history);
  result.tries.addTaken(history.tries());
  history = History(bound, history.work(), history.attempts());
  makeAttempts(settled.bench->run, history, true, result.stopped, std::move(begin));
  countTryLed(Try::FewerDetails, isOther && history.hasResult() ? 1 : 0);
  sized.stages.add("retries", seconds, 0, 0);
  const std::size_t before = result.attempts.size();
  result.attempts.insert(result.attempts.end(), history.steps().begin(), history.steps().end());
  if (!isBegun && result.attempts.size() > before)
  {
    result.attempts[before] = tryRow(Try::FewerDetails).name;
  }
}

/// The same; where nothing has quads, again with borders of patches that give way, as much as before.
void attemptAll(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, History& history, RemeshResult& result)
{
  attemptWithBorders(settled, sized, options, store, quadsAlone, history, result);
  const auto isTooLarge = [](const Status& status) { return status.code == StatusCode::TooLarge; };
  const Attempt& last = history.last();
  if (history.hasResult() || !settled.status.ok() || isTooLarge(last.map->status) ||
    (last.quads && isTooLarge(last.quads->status)))
  {
    return;
  }
  RunContext& run = settled.bench->run;
  std::optional<Plan> begin = withFewerBorders(run, firstPlan(run), {});
  if (!begin)
  {
    return;
  }
  setStep(*begin, Try::FewerBorders);
  countTry(Try::BordersYield);
  result.tries.addTaken(history.tries());
  const double seconds = secondsOf(history);
  const std::vector<std::string> before = result.attempts;
  history = History(workBound(sized.surface->mesh.faceCount(), sized.targetQuads));
  run.tried.clear();
  makeAttempts(run, history, true, result.stopped, std::move(begin));
  sized.stages.add("retries", seconds, 0, 0);
  countTryLed(Try::BordersYield, history.hasResult() ? 1 : 0);
  result.attempts = before;
  result.attempts.insert(result.attempts.end(), history.steps().begin(), history.steps().end());
}

/// From the sized surface to the result, in the frame.
void runAttempts(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, RemeshResult& result)
{
  Settled settled = settleDetails(sized, options, store, sized.stages, result.reused);
  result.details.insert(result.details.end(), sized.blocks.begin(), sized.blocks.end());
  tell({ sized.blocksNotice }, result);
  if (!settled.status.ok())
  {
    result.status = settled.status;
    tellDetails(settled, result);
    result.stages = sized.stages.all();
    return;
  }
  {
    History history;
    attemptAll(settled, sized, options, store, quadsAlone, history, result);
    result.tries.add(history.tries());
    tellDetails(settled, result);
    RunBench& bench = *settled.bench;
    RunContext& run = bench.run;
    bench.levels.letGo();
    result.targetQuads = run.targetQuads;
    result.smallParts = run.shortLoops.parts;
    takeAttempt(history.result(), options, quadsAlone, bench.surface, result);
    sized.surface = bench.surface.pointer();
    addGivenUp(
      history.result().plan, sized.surface->mesh, sized.edgeLength, result.givenUpFeatures);
    if (quadsAlone && store != nullptr)
    {
      std::vector<FixedVec2>& uv = history.result().map->uv;
      auto kept = std::make_shared<SpareMap>();
      kept->uv.swap(uv.empty() ? run.spare : uv);
      const std::size_t bytes = bytesOf(kept->uv);
      store->put(0, std::move(kept), bytes);
    }
    tellEnd(history, result);
    tellAttempt(history.result(),
      { sized.edgeLength, frame.unit, sized.targetQuads, options.maximumNumberOfQuads }, result);
    takeHistory(history, bench.levels, sized.stages, result);
    std::vector<FixedVec2>().swap(run.spare); // only attempts need it
  }
  if (options.mergeCharts && result.status.ok() && !result.mapIsKnown)
  {
    // After the extraction, so that the quads do not depend on it.
    const double start = secondsNow();
    const Mesh& mesh = sized.surface->mesh;
    result.charts = mergeCharts(mesh, result.uv);
    const std::size_t faces = mesh.faceCount();
    result.stages.push_back({ "charts", secondsNow() - start, faces, result.charts.charts });
  }
  tellAnisotropy(options, result);
}

} // namespace

RemeshResult guardedRun(const SurfaceInput& input, RemeshOptions options, const RunBody& run)
{
  checkOptions(options);
  RemeshResult result;
  // What is left to do after a stop that has kept quads is short, and does not ask again.
  const ProgressCallback asked = options.progress;
  PollScope poll(!asked ? ProgressCallback()
                        : [&](double fraction, const std::string& text)
      { return !result.stopped.empty() || asked(fraction, text); });
  options.progress = poll.callback();
  PlaceScope places;
  const TryScope tries;
  try
  {
    const std::size_t triangles = countTriangles(input);
    result.status = estimate(triangles, options, result);
    if (result.status.ok())
    {
      run(options, triangles, places, result);
    }
  }
  catch (const Cancelled&)
  {
    // What was under work is in the run's own coordinates, or half made.
    const RunEstimate estimated = result.estimate;
    result = {};
    result.estimate = estimated;
    result.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
  }
  result.tries.add(tries.counts());
  return result;
}

RemeshOptions optionsInFrame(RemeshOptions options, const Frame& frame)
{
  if (options.edgeLength)
  {
    options.edgeLength = frame.lengthOf(*options.edgeLength);
  }
  if (options.sizes.chordError)
  {
    options.sizes.chordError = frame.lengthOf(*options.sizes.chordError);
  }
  return options;
}

void remeshSized(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, RemeshResult& result)
{
  tell(sized.notices, result);
  result.status = sized.status;
  result.targetEdgeLength = sized.edgeLength;
  result.targetQuads = sized.targetQuads;
  result.decimations = sized.decimations;
  result.details = sized.details;
  result.reused = sized.reused;
  result.givenUpFeatures = sized.givenUpFeatures;
  result.stages = sized.stages.all();
  if (result.status.ok())
  {
    runAttempts(sized, frame, options, store, quadsAlone, result);
  }
}

namespace
{

std::vector<std::vector<Vector3>> toUser(
  std::vector<std::vector<Vector3>> paths, const Frame& frame)
{
  for (std::vector<Vector3>& path : paths)
  {
    for (Vector3& p : path)
    {
      p = frame.toUser(p);
    }
  }
  return paths;
}

} // namespace

void putOnUserSurface(SizedSurface& sized, const FramedInput& framed, const RemeshOptions& options,
  bool quadsAlone, RemeshResult& result)
{
  result.frame = framed.frame;
  result.drawnPaths = { toUser(sized.surface->featurePaths, framed.frame),
    toUser(sized.surface->strokePaths, framed.frame) };
  if (options.preview)
  {
    leaveFrameAlone(result, framed.frame);
    return;
  }
  if (quadsAlone)
  {
    leaveFrame(result, *sized.surface, framed.frame, framed.points);
    result.framed = sized.surface;
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
