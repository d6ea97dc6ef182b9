// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run on one page [Ebke et al. 2016, Section 3]: three levels of the surface, field and map of the coarse one, the
/// map carried back to the surface, its quads; and what is tried where a map or its quads fail.
#include "Pipeline/Run.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Pipeline/Attempt.h"
#include "Pipeline/ConnectionEnds.h"
#include "Pipeline/Division.h"
#include "Pipeline/DropSteps.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/FaceDivision.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/History.h"
#include "Pipeline/JoinedRuns.h"
#include "Pipeline/Recovery.h"
#include "Pipeline/RunResult.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Faces at places where quads do not fit are cut out as well so often, each time with a map of the rest.
constexpr int kMostGrowths = 2;

/// The memory of the last map, for the next one.
struct SpareMap
{
  std::vector<FixedVec2> uv;
};

/// The map of the surface by a plan, or why the coarse level has none. allowance: work that it may take.
std::shared_ptr<MapAttempt> makeMap(RunContext& run, const Plan& plan, std::size_t allowance)
{
  const TryScope tries;
  const PlannedSurface surface = withPlan(run.surface, plan);
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

/// The quads of the last map of a round.
void makeQuadsOfRound(RunContext& run, History& history)
{
  const Attempt& last = history.last();
  const PlannedSurface surface = withPlan(run.surface, last.plan);
  history.addQuads(!history.hasMap() ? nullptr
      : run.options.preview          ? makePreview(run, surface, last.plan, *last.map)
                                     : makeQuads(run, surface, last.plan, *last.map));
}

/// Whether what has no quads is made in parts: components, or faces between features.
bool isLeftToParts(const SizedSurface& sized, const RemeshOptions& options, const History& history)
{
  return isDivided(sized, history) ||
    (keepsFeatures(*sized.surface) && isCutAtFaces(*sized.surface, options, history));
}

/// Rounds of attempts until one is good or nothing is left to try: maps until one holds or nothing is left to try, then
/// its quads. isLast: where no attempt has quads, nothing follows. Where the surface is divided
/// after a failure, the first one is the end.
/// After a stop result.stopped tells what was tried, and the quads so far are the result; throws Cancelled without any.
void makeRounds(RunContext& run, const SizedSurface& sized, std::optional<Plan> plan, bool isLast,
  History& history, RemeshResult& result)
{
  try
  {
    const auto next = [&]
    {
      return isDivided(sized, history)
        ? std::nullopt
        : nextPlan(run, history, isLast && !isCutAtFaces(*sized.surface, run.options, history));
    };
    const auto nextMap = [&]
    {
      return history.last().map->status.ok() || !isDivided(sized, history)
        ? nextMapPlan(run, history)
        : std::nullopt;
    };
    for (; plan; plan = next())
    {
      for (; plan; plan = nextMap())
      {
        *run.tried = triedText(*plan, history);
        if (isLastResort(*plan))
        {
          history.beginLastResort();
        }
        history.packMaps(run.surface->mesh);
        history.addMap(*plan, makeMap(run, *plan, history.allowance()));
      }
      makeQuadsOfRound(run, history);
    }
  }
  catch (const Cancelled&)
  {
    if (!history.hasResult())
    {
      throw;
    }
    result.stopped = run.tried->empty() ? "attempt 1" : *run.tried;
  }
  result.attempts.insert(result.attempts.end(), history.steps().begin(), history.steps().end());
}

/// Of all attempts at a surface, before any has failed.
WorkBound boundOf(const SizedSurface& sized)
{
  WorkBound bound = workBound(sized.surface->mesh.faceCount(), sized.targetQuads, sized.work);
  if (sized.isTriedOnce)
  {
    bound.attempts = 1;
    bound.attemptsOfLastResort = 0;
  }
  return bound;
}

/// The first attempts. What is left of the bound is for those without details that were left.
History firstHistory(
  const Settled& settled, const SizedSurface& sized, const RemeshOptions& options)
{
  WorkBound bound = boundOf(sized);
  if (hasRest(settled, options))
  {
    bound.work = bound.work / 3 * 2;
    bound.attempts = bound.attempts / 3 * 2;
    bound.attemptsOfLastResort = 0;
  }
  return History(bound);
}

/// Rounds, and others where no attempt has quads: without the details that were left for attempts to resolve.
History makeAttempts(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, RemeshResult& result)
{
  History history = firstHistory(settled, sized, options);
  makeRounds(
    *settled.run, sized, firstPlan(*settled.run), !hasRest(settled, options), history, result);
  const bool isOver = history.hasResult() || isLeftToParts(sized, options, history);
  if (!isOver && simplifyRest(settled, sized, options, store))
  {
    result.tries.addTaken(history.tries());
    sized.stages.add("retries", history.seconds(), 0, 0);
    history = History(boundOf(sized), history.work(), history.attempts());
    Plan plan = firstPlan(*settled.run);
    plan.step = tryRow(Try::FewerDetails).name;
    countTry(Try::FewerDetails);
    makeRounds(*settled.run, sized, std::move(plan), true, history, result);
    countTryLed(Try::FewerDetails, history.hasResult() ? 1 : 0);
  }
  return history;
}

/// What the parts of a run have in common.
struct Asked
{
  const Frame& frame;
  const RemeshOptions& options; ///< in the frame
  ResultStore* store;
  bool quadsAlone;
};

void remeshSettled(Settled& settled, SizedSurface& sized, const Asked& asked, RemeshResult& result);

/// Why there are no quads.
struct Failure
{
  Status status;
  std::vector<Vector3> places;
};

/// What a part may take of the work of the whole: an equal share of what the parts before have left, or its share by
/// area, or what it needs at least.
std::size_t workOfPart(
  const SizedPart& part, std::size_t whole, std::size_t left, std::size_t parts)
{
  return std::max({ left / parts, static_cast<std::size_t>(part.share * static_cast<double>(whole)),
    leastOfPart(part.sized.surface->mesh.faceCount(), part.sized.targetQuads) });
}

/// The parts one by one, until one has no quads unless those are left out. work: that they may take together. settled:
/// gets their details.
Failure remeshParts(std::vector<SizedPart> parts, std::size_t work, Settled& settled,
  const Asked& asked, JoinedRuns& joined)
{
  eraseIf(settled.details,
    [](const SmallDetail& detail) { return detail.decision != DetailDecision::Simplify; });
  const RemeshOptions& whole = asked.options;
  std::size_t left = work;
  Failure failure;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const auto share = [&](std::size_t of)
    { return static_cast<double>(of) / static_cast<double>(parts.size()); };
    RemeshOptions options = whole;
    options.progress = subProgress(whole.progress, share(i), share(i + 1),
      "Part " + std::to_string(i + 1) + " of " + std::to_string(parts.size()) + ": ");
    SizedPart& part = parts[i];
    part.sized.work = workOfPart(part, work, left, parts.size() - i);
    RemeshResult made;
    Settled own = settleDetails(part.sized, options, asked.store);
    remeshSettled(own, part.sized, { asked.frame, options, asked.store, asked.quadsAlone }, made);
    left -= std::min(left, made.work);
    append(settled.details, own.details);
    settled.decimations += own.decimations;
    if (made.status.ok())
    {
      joined.add(part, std::move(made));
      continue;
    }
    failure.status = failure.status.ok() ? made.status : failure.status;
    append(failure.places, made.failed.places);
    joined.leaveOut(part, made);
    if (!whole.leavesOutFailed)
    {
      break;
    }
  }
  return failure;
}

/// What the whole has taken before its parts.
void takeBefore(const History& history, Settled& settled, SizedSurface& sized, RemeshResult& result)
{
  result.tries.addTaken(history.tries());
  result.work += history.work();
  result.replays += history.replays();
  if (settled.run)
  {
    result.decimations += settled.run->levels.decimations();
    sized.stages.add("retries", history.seconds(), 0, 0);
  }
  result.stages = sized.stages.all();
  result.reused = sized.reused;
}

/// The surface in parts: whether they have quads, which are those of the result then, and otherwise why not. failed:
/// see divide; history: of the whole.
bool remeshDivided(const std::vector<Index>& failed, const History& history, Settled& settled,
  SizedSurface& sized, const Asked& asked, JoinedRuns& joined, RemeshResult& result,
  Failure& failure)
{
  const RemeshOptions& options = asked.options;
  countTry(Try::Components);
  failure = remeshParts(
    divide(sized, failed, options.threads), boundOf(sized).work, settled, asked, joined);
  if (!failure.status.ok() && !(options.leavesOutFailed && joined.hasQuads()))
  {
    return false;
  }
  countTryLed(Try::Components);
  takeBefore(history, settled, sized, result);
  sized.surface = std::make_shared<const PreparedSurface>(joined.take(result, options.threads));
  result.mapIsKnown =
    options.knownMap != 0 && result.mapKey == options.knownMap && !options.warmStart;
  return true;
}

/// Of a face that is cut out, by itself: mostly it has a map, as what ties its sides to those of others is gone.
/// Without quads where it has none.
QuadMesh quadsOfFace(
  const Mesh& face, const SizedSurface& whole, const RemeshOptions& options, const Asked& asked)
{
  SizedSurface sized = faceAlone(face, whole, options.threads);
  Settled settled = settleDetails(sized, options, asked.store);
  RemeshResult made;
  remeshSettled(settled, sized, { asked.frame, options, asked.store, true }, made);
  return made.status.ok() ? std::move(made.quads) : QuadMesh();
}

/// Quads for faces that are cut out, beside those of the rest; whether there are some then.
bool remeshCut(CutFaces cut, const History& history, Settled& settled, SizedSurface& sized,
  const Asked& asked, RemeshResult& result, Failure& failure)
{
  RemeshOptions options = asked.options;
  options.smallDetails = SmallDetails::Keep; // those of the whole are settled
  RemeshResult made;
  if (cut.rest)
  {
    const std::size_t work = boundOf(sized).work;
    SizedSurface& rest = cut.rest->sized;
    rest.work = std::max({ work - std::min(work, history.work()), work / 2,
      leastOfPart(rest.surface->mesh.faceCount(), rest.targetQuads) });
    Settled own = settleDetails(rest, options, asked.store);
    remeshSettled(own, rest, { asked.frame, options, asked.store, asked.quadsAlone }, made);
    settled.decimations += own.decimations;
    if (!made.status.ok())
    {
      failure = { made.status, made.failed.places };
      return false;
    }
  }
  FilledPart filled = fillCutFaces(cut, cut.rest ? &cut.rest->sized.surface->mesh : nullptr,
    cut.rest ? &made.quads : nullptr, sized.edgeLength,
    [&](const Mesh& face) { return quadsOfFace(face, sized, options, asked); });
  failure.places = filled.failedAt;
  if (history.attempts() > 0)
  {
    const Attempt& last = history.last();
    failure.status = last.quads ? last.quads->status : last.map->status;
  }
  if (!filled.failedAt.empty())
  {
    return false;
  }
  JoinedRuns joined(sized);
  if (cut.rest)
  {
    joined.add(*cut.rest, std::move(made));
  }
  joined.addFilled(cut, std::move(filled));
  failure.places = gapsIn(joined.quads());
  if (!failure.places.empty())
  {
    return false;
  }
  takeBefore(history, settled, sized, result);
  sized.surface = std::make_shared<const PreparedSurface>(joined.take(result, options.threads));
  if (!sized.hasBeside)
  {
    improveShape(
      sized.surface->mesh, extractionOptions(*sized.surface, result, options), result.quads);
  }
  result.notices.push_back(filledText(cut, sized.targetQuads, sized.quadsOfAll()));
  failure = {};
  return true;
}

/// Where it is known which faces have no map: the rest, and these filled beside it; of several components as if those
/// with such faces had failed, so that the others, and each rest, are what they are where it is not known.
bool remeshBesideKnown(
  Settled& settled, SizedSurface& sized, const Asked& asked, RemeshResult& result)
{
  const Mesh& mesh = sized.surface->mesh;
  const FailedFaces known = facesAt(sized.surface->withoutMap, mesh);
  if (known.empty() || !mayCutFaces(*sized.surface, asked.options))
  {
    return false;
  }
  Failure failure;
  if (sized.surface->components > 1)
  {
    std::vector<Index> failed;
    std::transform(known.faces.begin(), known.faces.end(), std::back_inserter(failed),
      [&](Index f) { return mesh.origin[3 * f]; });
    JoinedRuns joined(sized);
    return remeshDivided(failed, {}, settled, sized, asked, joined, result, failure);
  }
  countTry(Try::FilledFaces);
  const bool isFilled = remeshCut(
    cutFaces(sized, known, asked.options.threads), {}, settled, sized, asked, result, failure);
  countTryLed(Try::FilledFaces, isFilled ? 1 : 0);
  return isFilled;
}

/// The faces in which the last attempt has failed are filled beside the quads of the rest; where these do not fit, with
/// their neighbours at the places where they do not, or else all.
bool remeshBesideFaces(const History& history, Settled& settled, SizedSurface& sized,
  const Asked& asked, RemeshResult& result, Failure& failure)
{
  const auto with = [&](const FailedFaces& faces)
  {
    return remeshCut(cutFaces(sized, faces, asked.options.threads), history, settled, sized, asked,
      result, failure);
  };
  countTry(Try::FilledFaces);
  FailedFaces faces = history.failedFaces();
  bool isFilled = !faces.empty() && with(faces);
  for (int i = 0; i < kMostGrowths && !isFilled && addFacesAt(failure.places, sized, faces); ++i)
  {
    isFilled = with(faces);
  }
  if (!isFilled)
  {
    faces = {};
    faces.faces = idsWhere(sized.surface->mesh.faceCount(), [](Index) { return true; });
    isFilled = with(faces);
  }
  countTryLed(Try::FilledFaces, isFilled ? 1 : 0);
  return isFilled;
}

/// The attempts of a surface or, where they fail and it can be divided, of its parts.
void remeshSettled(Settled& settled, SizedSurface& sized, const Asked& asked, RemeshResult& result)
{
  const RemeshOptions& options = asked.options;
  JoinedRuns joined(sized);
  Failure failure;
  if (!settled.status.ok())
  {
    const bool hasQuads = options.leavesOutFailed && sized.surface->components > 1 &&
      remeshDivided({}, {}, settled, sized, asked, joined, result, failure);
    result.status = hasQuads ? result.status : settled.status;
    return;
  }
  if (remeshBesideKnown(settled, sized, asked, result))
  {
    return;
  }
  History history = makeAttempts(settled, sized, options, asked.store, result);
  RunContext& run = *settled.run;
  run.levels.letGo();
  const bool isInParts = isDivided(sized, history);
  // A face by itself is tried once: without a map it is filled as what it is cut from asks.
  const bool failed =
    isInParts || (!sized.isTriedOnce && isFilled(*sized.surface, options, history));
  if (failed)
  {
    history.packMaps(sized.surface->mesh);
    if (isInParts ? remeshDivided(failedVertices(history.last(), sized.surface->mesh), history,
                      settled, sized, asked, joined, result, failure)
                  : remeshBesideFaces(history, settled, sized, asked, result, failure))
    {
      return;
    }
  }
  takeAttempts(history, run, asked.frame, options, asked.quadsAlone, sized, result);
  if (failed)
  {
    joined.takeLog(result);
    result.status = failure.status;
    result.failed.places = failure.places;
  }
}

RemeshResult remeshOnce(
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

RemeshResult remeshInput(
  SurfaceInput& input, const RemeshOptions& given, ResultStore* store, bool quadsAlone)
{
  return remeshWithEnds(
    input, given,
    [&](SurfaceInput asked, const RemeshOptions& options)
    { return remeshOnce(asked, options, store, quadsAlone); },
    [](RemeshResult& made) -> RemeshResult& { return made; });
}

} // namespace

void remeshSized(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, RemeshResult& result)
{
  if (sized.status.ok())
  {
    dropSteps(sized, options);
  }
  takeSized(sized, result);
  if (!result.status.ok())
  {
    return;
  }
  Settled settled = settleDetails(sized, options, store);
  takeBlocks(sized, result);
  if (const auto spare = quadsAlone && settled.run ? findIn<SpareMap>(store, 0) : nullptr)
  {
    settled.run->spare.swap(spare->uv);
  }
  std::vector<std::string> notices;
  notices.swap(result.notices);
  remeshSettled(settled, sized, { frame, options, store, quadsAlone }, result);
  notices.swap(result.notices);
  takeDetails(settled, result);
  append(result.notices, notices);
  if (result.status.ok() && result.failed.components > 0)
  {
    result.notices.insert(result.notices.begin(), result.failed.text());
  }
  if (quadsAlone && store != nullptr && settled.run)
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
  return remeshInput(input, options, &store, options.preview); // of which the quads alone are told
}

RemeshResult remeshQuads(SurfaceInput input, const RemeshOptions& options, ResultStore& store)
{
  return remeshInput(input, options, &store, true);
}

} // namespace quadrille
