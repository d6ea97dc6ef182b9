// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SettledSurface.h"

#include "Base/Clock.h"
#include "Details/CloseHandles.h"
#include "Details/FillHoles.h"
#include "Details/Handles.h"
#include "Details/ThinParts.h"
#include "Pipeline/DetailSteps.h"
#include "Pipeline/FirstLevels.h"
#include "Pipeline/FirstPlan.h"
#include "Prepare/Refine.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

namespace quadrille
{
namespace
{

/// Where a round cuts less than this part of those it has tried, another one is not worth its phase 1.
constexpr double kWorthwhileCut = 0.125;

/// A simplified surface in the store, without what was asked of it: guides and valences change nothing of it.
struct StoredSettled
{
  PreparedSurface surface;
  ResultKey key = 0;
  std::vector<SmallDetail> simplified;
};

bool isSimplified(const SmallDetail& detail)
{
  return detail.decision == DetailDecision::Simplify;
}

constexpr const char* kCutOff = "cut off";
constexpr const char* kCutInTwo = "cut in two";

/// A surface while its details are taken out.
struct Settling
{
  SizedSurface& sized;
  const RemeshOptions& options;
  ResultStore* store;
  bool isRest;        ///< nothing else has led to quads
  bool takesAll;      ///< see detailLimits
  Settled made;       ///< its run: of the surface as it is; none: to be made
  bool isOwn = false; ///< whether any change was tried
};

/// Of a surface that has changed.
void letGo(Settled& made)
{
  if (made.run)
  {
    made.decimations += made.run->levels.decimations();
    made.run.reset();
  }
}

/// Another run, of the surface as it is, with its short loops.
void measure(Settling& work)
{
  letGo(work.made);
  RunContext& run = work.made.run.emplace(makeRun(work.sized, work.options, work.store));
  findShortLoops(run, work.sized.stages, work.sized.reused);
}

/// Handles that were cut need no quads.
void countBlocksAgain(Settling& work)
{
  if (!work.sized.blocks.empty())
  {
    countBlocks(work.sized, work.options, work.store);
  }
}

/// What `change` closes becomes a surface with triangles no larger than quads, and a key of its own. change: tells the
/// details that it has taken out, none where the surface is as it was. Returns how many these are.
std::size_t changeSurface(
  Settling& work, const std::function<std::vector<SmallDetail>(PreparedSurface&)>& change)
{
  const double start = secondsNow();
  SizedSurface& sized = work.sized;
  PreparedSurface changed = *sized.surface;
  const std::size_t facesBefore = changed.mesh.faceCount();
  work.isOwn = true;
  const std::vector<SmallDetail> details = change(changed);
  if (details.empty())
  {
    return 0;
  }
  work.made.details.insert(work.made.details.end(), details.begin(), details.end());
  letGo(work.made);
  // What was left long for its number stays so: the bound grows with the faces that there are now.
  if (changed.notice.empty())
  {
    refineSurface(changed, sized.edgeLength, {}, work.options.threads);
  }
  sized.key = KeyMaker(sized.key).add(changed.hash).key();
  sized.surface = std::make_shared<const PreparedSurface>(std::move(changed));
  countBlocksAgain(work);
  sized.stages.add("simplify", secondsNow() - start, facesBefore, sized.surface->mesh.faceCount());
  return details.size();
}

/// The number of holes that were filled.
std::size_t fill(Settling& work, double limit)
{
  const double edgeLength = work.sized.edgeLength;
  const std::vector<HandleLoop> loops =
    shortBoundaryLoops(*work.sized.surface, edgeLength, limit, work.options.threads);
  return loops.empty()
    ? 0
    : changeSurface(work,
        [&](PreparedSurface& surface)
        {
          const SharedArray<Vector3> position = surface.mesh.position;
          std::vector<SmallDetail> details;
          for (const std::size_t i : fillHoles(surface, loops))
          {
            details.push_back({ DetailKind::BoundaryLoop, DetailDecision::Simplify,
              loops[i].length / edgeLength, position[loops[i].vertices.front()], "filled" });
          }
          return details;
        });
}

/// The number of handles that were cut; 0 also where those were few of all.
std::size_t cut(Settling& work, double limit)
{
  const double edgeLength = work.sized.edgeLength;
  const std::vector<HandleLoop> loops = handlesBelow(*work.made.run, limit);
  if (loops.empty())
  {
    return 0;
  }
  std::vector<std::vector<Index>> places;
  places.reserve(loops.size());
  for (const HandleLoop& loop : loops)
  {
    places.push_back(loop.vertices);
  }
  const std::size_t closed = changeSurface(work,
    [&](PreparedSurface& surface)
    {
      const SharedArray<Vector3> position = surface.mesh.position;
      std::vector<SmallDetail> details;
      for (const std::size_t i : closeHandles(surface, places, kLongerAlongEdges * limit,
             kGirthOfLimb * edgeLength, work.options.threads))
      {
        details.push_back({ DetailKind::Handle, DetailDecision::Simplify,
          loops[i].length / edgeLength, position[places[i].front()], kCutAndClosed });
      }
      return details;
    });
  return static_cast<double>(closed) < kWorthwhileCut * static_cast<double>(places.size()) ? 0
                                                                                           : closed;
}

/// Of the coarse level; where the curvature sets it, the default one.
double coarseBudget(const RemeshOptions& options)
{
  return options.coarseVertices > 0 ? options.coarseVertices : RemeshOptions().coarseVertices;
}

/// What a crowd of handles leaves where they were cut are stubs all over: on a coarse level these would have more
/// vertices than all else, and no room. The number of those that were cut off.
std::size_t thin(Settling& work, double limit, bool isBegun)
{
  // Those with less area than so many quads are cut off, where the three vertices of each take more than this part of
  // the coarse level's budget, and where nothing else has led to quads: every cut changes the surface.
  constexpr double kQuadsOfThinPart = 6;
  constexpr double kMostOfBudget = 0.5;
  const double edgeLength = work.sized.edgeLength;
  const double mostArea = kQuadsOfThinPart * edgeLength * edgeLength;
  RunContext& run = *work.made.run;
  const Level& level = run.levels.makeIntermediate(run.surface, levelOptions(run, {}));
  std::vector<ThinPart> parts =
    findThinParts(level.mesh, { limit, work.options.smallestDetail * edgeLength, mostArea });
  const bool areTooMany =
    3 * static_cast<double>(parts.size()) > kMostOfBudget * coarseBudget(work.options);
  if (parts.empty() || (!isBegun && !areTooMany))
  {
    return 0;
  }
  std::vector<Vector3> places;
  for (ThinPart& part : parts)
  {
    places.push_back(level.mesh.position[part.loop.front()]);
    for (Index& v : part.loop)
    {
      v = level.fineVertex[v];
    }
    part.tip = level.fineVertex[part.tip];
    part.outside = level.fineVertex[part.outside];
  }
  return changeSurface(work,
    [&](PreparedSurface& surface)
    {
      std::vector<SmallDetail> details;
      for (const std::size_t i : cutThinParts(surface, parts, kLongerAlongEdges, mostArea))
      {
        details.push_back({ DetailKind::ThinPart, DetailDecision::Simplify,
          parts[i].length / edgeLength, places[i], parts[i].isLarge ? kCutInTwo : kCutOff });
      }
      return details;
    });
}

/// Until no handle below the limit is left that can be closed.
void cutAll(Settling& work, DetailLimits& limits)
{
  do // those whose loops meet others' have to wait
  {
    measure(work);
    if (!work.takesAll && isCrowdToCut(limits, *work.made.run))
    {
      limits.handles = kQuadsOfLoop * work.sized.edgeLength;
    }
  } while (cut(work, limits.handles) > 0);
  if (!work.made.run)
  {
    measure(work);
  }
  const auto isHandle = [](const SmallDetail& detail) { return detail.kind == DetailKind::Handle; };
  const std::vector<SmallDetail>& details = work.made.details;
  const bool isCrowd = static_cast<std::size_t>(
                         std::count_if(details.begin(), details.end(), isHandle)) >= kManyHandles;
  for (bool isAnother = work.isRest; isCrowd && thin(work, limits.handles, isAnother) > 0;)
  {
    measure(work); // others were inside or beside those that were cut off
    isAnother = true;
  }
}

/// What was asked of the surface before, of the simplified one, in the same way for one that was made and one from the
/// store.
void takeRequests(PreparedSurface surface, const AskedPlaces& asked, Settling& work)
{
  const std::vector<ValenceRequest> before = surface.valenceRequests;
  ask(asked, surface, work.sized.edgeLength, work.options.threads);
  const bool isSame = std::equal(before.begin(), before.end(), surface.valenceRequests.begin(),
    surface.valenceRequests.end(),
    [](const ValenceRequest& a, const ValenceRequest& b) { return a.vertex == b.vertex; });
  if (!isSame)
  {
    letGo(work.made); // its levels hold other vertices
  }
  work.sized.surface = std::make_shared<const PreparedSurface>(std::move(surface));
  if (work.made.run)
  {
    work.made.run->surface = withoutPlan(work.sized.surface, work.sized.key);
  }
}

bool recall(ResultKey key, const AskedPlaces& asked, Settling& work)
{
  const auto known = findIn<StoredSettled>(work.store, key);
  if (!known)
  {
    return false;
  }
  takeRequests(known->surface, asked, work);
  work.sized.key = known->key;
  countBlocksAgain(work);
  work.made.details = known->simplified;
  work.sized.reused.emplace_back("simplify");
  return true;
}

void remember(ResultKey key, const Settling& work)
{
  if (work.store == nullptr)
  {
    return;
  }
  const Settled& made = work.made;
  auto stored = std::make_shared<StoredSettled>();
  stored->surface = *work.sized.surface;
  stored->surface.setRequests({});
  stored->key = work.sized.key;
  stored->simplified = made.details;
  const std::size_t bytes = bytesOf(stored->surface);
  work.store->put(key, std::move(stored), bytes);
}

/// Details below the limits, from the store or one after the other. Not ok where that cannot help.
Status simplify(Settling& work)
{
  SizedSurface& sized = work.sized;
  const AskedPlaces asked = askedPlaces(*sized.surface);
  const ResultKey key =
    KeyMaker(sized.key)
      .add(sized.edgeLength, work.options.smallestDetail, work.isRest, work.takesAll)
      .key();
  const auto judge = [&](bool isCut)
  { return judgeHandles(sized, isCut, work.options.threads, work.store); };
  if (recall(key, asked, work))
  {
    return judge(true);
  }
  DetailLimits limits =
    detailLimits(sized.edgeLength, work.options.smallestDetail, work.takesAll, work.isRest);
  fill(work, limits.boundaryLoops);
  Status status = judge(false);
  if (!status.ok())
  {
    return status;
  }
  cutAll(work, limits);
  status = judge(true);
  if (!status.ok() && !work.takesAll)
  {
    // What is refused with them can be done without.
    limits = detailLimits(sized.edgeLength, work.options.smallestDetail, true, work.isRest);
    fill(work, limits.boundaryLoops);
    cutAll(work, limits);
    status = judge(true);
  }
  if (work.isOwn)
  {
    takeRequests(*sized.surface, asked, work);
    remember(key, work);
  }
  return status;
}

/// The loops that are left, which quads resolve where the first plan has sizes for them.
void addRest(bool mayBeSimplified, Settled& made)
{
  RunContext& run = *made.run;
  const std::vector<HandleLoop>& loops = run.shortLoops.loops;
  run.hasCrowd = mayBeSimplified && loops.size() >= kManyHandles;
  const bool resolved = !loops.empty() && resolvesLoops(run, loops);
  for (std::size_t i = 0; i < loops.size(); ++i)
  {
    const bool isHandle = i < run.shortLoops.parts.unresolvedHandles;
    made.details.push_back({ isHandle ? DetailKind::Handle : DetailKind::BoundaryLoop,
      resolved ? DetailDecision::Resolve : DetailDecision::Keep, loops[i].length / run.edgeLength,
      run.surface->mesh.position[loops[i].vertices.front()],
      resolved ? "quads are smaller there" : "quads have the size that was asked for" });
  }
}

Settled settle(SizedSurface& sized, const RemeshOptions& options, ResultStore* store, bool isRest)
{
  const bool takesAll = isRest || options.smallDetails == SmallDetails::Simplify;
  Settling work{ sized, options, store, isRest, takesAll, {} };
  if (maySimplify(options))
  {
    work.made.status = simplify(work);
  }
  if (work.made.status.ok() && !work.made.run)
  {
    measure(work);
  }
  if (work.made.status.ok())
  {
    addRest(maySimplify(options) && !takesAll, work.made);
  }
  return std::move(work.made);
}

} // namespace

Settled settleDetails(SizedSurface& sized, const RemeshOptions& options, ResultStore* store)
{
  return settle(sized, options, store, false);
}

bool hasRest(const Settled& settled, const RemeshOptions& options)
{
  return options.smallDetails == SmallDetails::Automatic && maySimplify(options) &&
    !std::all_of(settled.details.begin(), settled.details.end(), isSimplified);
}

bool simplifyRest(
  Settled& settled, SizedSurface& sized, const RemeshOptions& options, ResultStore* store)
{
  if (!hasRest(settled, options))
  {
    return false;
  }
  letGo(settled);
  Settled rest = settle(sized, options, store, true);
  if (!rest.run)
  {
    rest.run.emplace(makeRun(sized, options, store));
  }
  std::vector<SmallDetail>& before = settled.details;
  before.erase(std::stable_partition(before.begin(), before.end(), isSimplified), before.end());
  const bool isMore = std::any_of(rest.details.begin(), rest.details.end(), isSimplified);
  settled.status = rest.status;
  settled.run.emplace(std::move(*rest.run));
  settled.decimations += rest.decimations;
  before.insert(before.end(), rest.details.begin(), rest.details.end());
  return isMore && settled.status.ok();
}

} // namespace quadrille
