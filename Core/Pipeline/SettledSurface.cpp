// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SettledSurface.h"

#include "Base/Clock.h"
#include "Base/TryCount.h"
#include "Details/CloseHandles.h"
#include "Details/FillHoles.h"
#include "Details/Handles.h"
#include "Details/ThinParts.h"
#include "Pipeline/AskedPlaces.h"
#include "Pipeline/DetailLimits.h"
#include "Pipeline/FirstLevels.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/QuadsForHandles.h"
#include "Pipeline/SmallHandles.h"
#include "Prepare/Refine.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace quadrille
{
namespace
{

/// Levels follow the changes of up to so many places, of surfaces of so many faces at least: on smaller ones phase 1
/// costs next to nothing. Of skull, with 287 handles cut at 3,000 quads, maps held on new levels and not on those that
/// had followed.
constexpr std::size_t kMostFollowed = 8;
constexpr Index kLeastFollowed = Index{ 1 } << 18;
/// How often handles are looked for and cut: those whose loops meet others' have to wait.
constexpr int kMostCuttings = 10;
/// Where a round cuts less than this part of those it has tried, another one is not worth its phase 1.
constexpr double kWorthwhileCut = 0.125;

/// Of the stubs that a crowd of handles leaves, those with less area than so many quads are cut off, and how often
/// others are looked for that were inside or beside them.
constexpr double kQuadsOfThinPart = 6;
constexpr int kMostThinnings = 6;
/// They are cut off where the three vertices of each take more than this part of the coarse level's budget, which
/// leaves no room for a map, and where nothing else has led to quads: every cut changes the surface.
constexpr double kMostOfBudget = 0.5;

/// A simplified surface in the store, without what was asked of it: guides, valences and curves change nothing of it.
struct StoredSettled
{
  PreparedSurface surface;
  ResultKey key = 0;
  std::vector<SmallDetail> simplified;
  bool hasFollowed = false; ///< its levels follow those of the surface before, see Levels
};

bool isSimplified(const SmallDetail& detail)
{
  return detail.decision == DetailDecision::Simplify;
}

constexpr const char* kCutOff = "cut off";
constexpr const char* kCutInTwo = "cut in two";

const char* whatBecomes(DetailKind kind)
{
  return kind == DetailKind::Handle ? kCutAndClosed : "filled";
}

class Settling
{
public:
  /// isRest: nothing else has led to quads.
  Settling(SizedSurface& sized, const RemeshOptions& options, ResultStore* store, bool isRest,
    StageRecords& stages, std::vector<std::string>& reused)
    : sized_(sized), options_(options), store_(store), isRest_(isRest),
      takesAll_(isRest || options.smallDetails == SmallDetails::Simplify), stages_(stages),
      reused_(reused), asked_(*sized.surface, options.threads), limits_(sized.edgeLength, takesAll_, isRest)
  {
  }

  Settled run()
  {
    if (maySimplify(options_) && !recall())
    {
      fill();
      if (isHopeless(false))
      {
        return std::move(made_);
      }
      simplifyAll();
      if (isOwn_)
      {
        takeRequests(*sized_.surface);
        remember();
      }
    }
    if (maySimplify(options_) && isHopeless(true))
    {
      return std::move(made_);
    }
    if (!made_.bench)
    {
      measure();
    }
    addRest();
    return std::move(made_);
  }

private:
  void measure()
  {
    letGo();
    made_.bench = std::make_unique<RunBench>(sized_, options_, store_);
    Levels& levels = made_.bench->levels;
    if (levels_)
    {
      levels.follow(std::move(levels_), levelOptions(made_.bench->run, {}));
    }
    else if (storedLevels_)
    {
      levels.follow(std::move(storedLevels_), levelOptions(made_.bench->run, {}));
    }
    findShortLoops(made_.bench->run, stages_, reused_);
  }

  bool mayFollow() const
  {
    return changes_ <= kMostFollowed && sized_.surface->mesh.faceCount() >= kLeastFollowed;
  }

  /// Before the surface is changed: its elements are followed where there are levels that can be.
  void beginChange()
  {
    isOwn_ = true;
    changed_ = *sized_.surface;
    if ((made_.bench || levels_) && mayFollow())
    {
      changed_.namesBefore =
        NamesBefore::of(changed_.mesh.vertexCount(), changed_.mesh.faceCount());
    }
  }

  /// Afterwards: takes the levels along, or lets them go.
  void endChange(std::unique_ptr<Redecimation> levels)
  {
    HierarchyOptions options;
    options.threads = options_.threads;
    options.isConnected = changed_.components == 1;
    if (levels && mayFollow() && changed_.namesBefore &&
      levels->follow(changed_.mesh, changed_.hash, *changed_.namesBefore, options))
    {
      levels_ = std::move(levels);
    }
    changed_.namesBefore.reset();
    sized_.surface = std::make_shared<const PreparedSurface>(std::move(changed_));
    changed_ = {};
  }

  /// Of a surface that has changed.
  void letGo()
  {
    if (made_.bench)
    {
      made_.decimations += made_.bench->levels.decimations();
      made_.bench.reset();
    }
  }

  void note(DetailKind kind, double length, const Vector3& place)
  {
    made_.details.push_back(
      { kind, DetailDecision::Simplify, length / sized_.edgeLength, place, whatBecomes(kind) });
  }

  /// The number of holes that were filled.
  std::size_t fill()
  {
    const double start = secondsNow();
    const std::vector<HandleLoop> loops = shortBoundaryLoops(
      *sized_.surface, sized_.edgeLength, limits_.ofBoundaryLoops(), options_.threads);
    if (loops.empty())
    {
      return 0;
    }
    std::vector<Vector3> places;
    places.reserve(loops.size());
    for (const HandleLoop& loop : loops)
    {
      places.push_back(sized_.surface->mesh.position[loop.vertices.front()]);
    }
    const std::size_t before = sized_.surface->mesh.faceCount();
    beginChange();
    const std::vector<std::size_t> filled = fillHoles(changed_, loops);
    for (const std::size_t i : filled)
    {
      note(DetailKind::BoundaryLoop, loops[i].length, places[i]);
    }
    finish(filled.size(), start, before);
    return filled.size();
  }

  std::size_t cut()
  {
    std::vector<std::vector<Index>> places;
    std::vector<double> lengths;
    std::vector<Vector3> at;
    for (HandleLoop& loop : handlesBelow(made_.bench->run, sized_.edgeLength, limits_.ofHandles()))
    {
      lengths.push_back(loop.length);
      at.push_back(sized_.surface->mesh.position[loop.vertices.front()]);
      places.push_back(std::move(loop.vertices));
    }
    if (places.empty())
    {
      return 0;
    }
    const double start = secondsNow();
    const std::size_t before = sized_.surface->mesh.faceCount();
    beginChange();
    const std::vector<std::size_t> closed = closeHandles(changed_, places,
      kLongerAlongEdges * limits_.ofHandles(), kGirthOfLimb * sized_.edgeLength, options_.threads);
    for (const std::size_t i : closed)
    {
      note(DetailKind::Handle, lengths[i], at[i]);
    }
    finish(closed.size(), start, before);
    handlesCut_ += closed.size();
    return static_cast<double>(closed.size()) < kWorthwhileCut * static_cast<double>(places.size())
      ? 0
      : closed.size();
  }

  /// What was closed becomes a surface with triangles no larger than quads, and a key of its own.
  void finish(std::size_t changed, double start, std::size_t facesBefore)
  {
    if (changed == 0)
    {
      changed_ = {};
      return;
    }
    std::unique_ptr<Redecimation> levels = std::move(levels_);
    changes_ += changed;
    if (made_.bench && mayFollow())
    {
      levels = made_.bench->levels.giveToFollow(levelOptions(made_.bench->run, {}));
    }
    letGo();
    // What was left long for its number stays so: the bound grows with the faces that there are now.
    if (changed_.notice.empty())
    {
      refineSurface(changed_, sized_.edgeLength, {}, options_.threads);
    }
    sized_.key = KeyMaker(sized_.key).add(changed_.hash).key();
    endChange(std::move(levels));
    countBlocksAgain();
    stages_.add("simplify", secondsNow() - start, facesBefore, sized_.surface->mesh.faceCount());
  }

  /// Handles that were cut need no quads.
  void countBlocksAgain()
  {
    if (!sized_.blocks.empty())
    {
      countBlocks(sized_, options_, store_);
    }
  }

  /// Until no loop below the limit is left that can be closed.
  void simplifyAll()
  {
    for (int cutting = 0; cutting < kMostCuttings; ++cutting)
    {
      measure();
      if (!takesAll_)
      {
        limits_.raise(made_.bench->run);
      }
      if (cut() + fill() == 0)
      {
        break;
      }
      countTryLed(Try::RaisedLimit, limits_.takeRaised() ? 1 : 0);
    }
    if (!made_.bench)
    {
      measure();
    }
    for (int thinning = 0; thinning < kMostThinnings && thin() > 0; ++thinning)
    {
      measure();
    }
  }

  /// What a crowd of handles leaves where they were cut are stubs all over: on a coarse level these would have more
  /// vertices than all else, and no room. The number of those that were cut off.
  std::size_t thin()
  {
    if (handlesCut_ < kManyHandles)
    {
      return 0;
    }
    const double start = secondsNow();
    const Level& level = made_.bench->levels.makeIntermediate(levelOptions(made_.bench->run, {}));
    const double quad = sized_.edgeLength * sized_.edgeLength;
    std::vector<ThinPart> parts = findThinParts(level.mesh,
      { limits_.ofHandles(), kSimplifiedLoop * sized_.edgeLength, kQuadsOfThinPart * quad });
    isThinning_ = isThinning_ || isRest_ || 3 * parts.size() > kMostOfBudget * coarseBudget();
    if (!isThinning_)
    {
      return 0;
    }
    std::vector<Vector3> at;
    for (ThinPart& part : parts)
    {
      at.push_back(level.mesh.position[part.loop.front()]);
      for (Index& v : part.loop)
      {
        v = level.fineVertex[v];
      }
      part.tip = level.fineVertex[part.tip];
      part.outside = level.fineVertex[part.outside];
    }
    const std::size_t before = sized_.surface->mesh.faceCount();
    if (!parts.empty())
    {
      beginChange();
    }
    const std::vector<std::size_t> removed = parts.empty()
      ? std::vector<std::size_t>()
      : cutThinParts(changed_, parts, kLongerAlongEdges, kQuadsOfThinPart * quad);
    for (const std::size_t i : removed)
    {
      note(DetailKind::ThinPart, parts[i].length, at[i]);
      made_.details.back().result = parts[i].isLarge ? kCutInTwo : kCutOff;
    }
    finish(removed.size(), start, before);
    return removed.size();
  }

  /// Of the coarse level; where the curvature sets it, the default one.
  double coarseBudget() const
  {
    return options_.coarseVertices > 0 ? options_.coarseVertices : RemeshOptions().coarseVertices;
  }

  /// Then the status tells why.
  bool isHopeless(bool isCut)
  {
    made_.status = judgeHandles(sized_, isCut, options_.threads, store_);
    return !made_.status.ok();
  }

  ResultKey storeKey() const
  {
    KeyMaker key(sized_.key);
    key.add(sized_.edgeLength).add(std::uint64_t{ isRest_ ? 3U : takesAll_ ? 2U : 1U });
    return key.key();
  }

  bool recall()
  {
    if (store_ == nullptr)
    {
      return false;
    }
    key_ = storeKey();
    const auto known = store_->find<StoredSettled>(key_);
    if (!known)
    {
      return false;
    }
    if (known->hasFollowed)
    {
      storedLevels_ = Levels::findFollowed(*store_, known->key, sized_.edgeLength);
      if (!storedLevels_)
      {
        return false;
      }
    }
    takeRequests(known->surface);
    sized_.key = known->key;
    countBlocksAgain();
    made_.details = known->simplified;
    reused_.emplace_back("simplify");
    return true;
  }

  void remember()
  {
    if (store_ == nullptr)
    {
      return;
    }
    auto stored = std::make_shared<StoredSettled>();
    stored->surface = *sized_.surface;
    stored->surface.setRequests({});
    stored->key = sized_.key;
    stored->simplified = made_.details;
    stored->hasFollowed = made_.bench && made_.bench->levels.hasFollowed();
    const std::size_t bytes = bytesOf(stored->surface);
    store_->put(key_, std::move(stored), bytes);
  }

  /// On the vertices of the simplified surface, in the same way for one that was made and one from the store.
  void takeRequests(PreparedSurface surface)
  {
    const std::vector<ValenceRequest> before = surface.valenceRequests;
    asked_.askOf(surface);
    const bool isSame = std::equal(before.begin(), before.end(), surface.valenceRequests.begin(),
      surface.valenceRequests.end(),
      [](const ValenceRequest& a, const ValenceRequest& b) { return a.vertex == b.vertex; });
    if (!isSame && !(made_.bench && made_.bench->levels.hasFollowed()))
    {
      letGo(); // its levels hold other vertices
    }
    sized_.surface = std::make_shared<const PreparedSurface>(std::move(surface));
    if (made_.bench)
    {
      made_.bench->surface.setRequests(sized_.surface);
    }
  }

  /// The loops that are left, which quads resolve where the first plan has sizes for them.
  void addRest()
  {
    const RunContext& run = made_.bench->run;
    const std::vector<HandleLoop>& loops = run.shortLoops.loops;
    made_.bench->run.hasCrowd = maySimplify(options_) && !takesAll_ && loops.size() >= kManyHandles;
    const bool resolved = !loops.empty() && resolvesLoops(made_.bench->run, loops);
    for (std::size_t i = 0; i < loops.size(); ++i)
    {
      const bool isHandle = i < run.shortLoops.parts.unresolvedHandles;
      made_.details.push_back({ isHandle ? DetailKind::Handle : DetailKind::BoundaryLoop,
        resolved ? DetailDecision::Resolve : DetailDecision::Keep, loops[i].length / run.edgeLength,
        run.surface->mesh.position[loops[i].vertices.front()],
        resolved ? "quads are smaller there" : "quads have the size that was asked for" });
    }
  }

  SizedSurface& sized_;
  const RemeshOptions& options_;
  ResultStore* store_;
  bool isRest_;
  bool takesAll_; ///< what is shorter than kQuadsOfLoop s, whatever smaller quads could do
  StageRecords& stages_;
  std::vector<std::string>& reused_;
  AskedPlaces asked_;
  DetailLimits limits_;
  std::size_t handlesCut_ = 0;
  std::size_t changes_ = 0; ///< places where the surface was changed
  bool isThinning_ = false; ///< thin parts are too many, or nothing else has led to quads
  bool isOwn_ = false;
  PreparedSurface changed_; ///< the surface while it is simplified
  ResultKey key_ = 0;
  std::unique_ptr<Redecimation> levels_;       ///< that have followed, for the next bench
  std::shared_ptr<StoredLevels> storedLevels_; ///< the same from the store
  Settled made_;
};

} // namespace

RunBench::RunBench(const SizedSurface& sized, const RemeshOptions& given, ResultStore* store)
  : surface(sized.surface, sized.key, given.threads), levels(surface, store),
    options(given), run{ options, sized.edgeLength, sized.targetQuads, surface, levels, store, {} }
{
  if (given.progress)
  {
    options.progress = [this, asked = given.progress](double fraction, const std::string& text)
    { return asked(fraction, (run.tried.empty() ? "" : run.tried + ": ") + text); };
  }
}

Settled settleDetails(SizedSurface& sized, const RemeshOptions& options, ResultStore* store,
  StageRecords& stages, std::vector<std::string>& reused)
{
  return Settling(sized, options, store, false, stages, reused).run();
}

bool hasRest(const Settled& settled, const RemeshOptions& options)
{
  return options.smallDetails == SmallDetails::Automatic && maySimplify(options) &&
    !std::all_of(settled.details.begin(), settled.details.end(), isSimplified);
}

bool simplifyRest(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, StageRecords& stages, std::vector<std::string>& reused)
{
  std::vector<SmallDetail> before = settled.details;
  if (!hasRest(settled, options))
  {
    return false;
  }
  before.erase(std::stable_partition(before.begin(), before.end(), isSimplified), before.end());
  const int decimations = settled.decimations + settled.bench->levels.decimations();
  settled.bench.reset();
  settled = Settling(sized, options, store, true, stages, reused).run();
  settled.decimations += decimations;
  if (!settled.bench)
  {
    settled.bench = std::make_unique<RunBench>(sized, options, store);
  }
  const bool isMore = std::any_of(settled.details.begin(), settled.details.end(), isSimplified);
  settled.details.insert(settled.details.begin(), before.begin(), before.end());
  return isMore && settled.status.ok();
}

} // namespace quadrille
