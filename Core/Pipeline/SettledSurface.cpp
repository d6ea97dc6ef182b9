// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SettledSurface.h"

#include "Base/PlaceText.h"
#include "Base/TryCount.h"
#include "Details/CloseHandles.h"
#include "Details/FillHoles.h"
#include "Details/Handles.h"
#include "Details/SmallComponents.h"
#include "Details/ThinParts.h"
#include "Pipeline/FirstLevels.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/SmallHandles.h"
#include "Prepare/Refine.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
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
/// Where smaller quads round so many handles would make more than so many times the quads, they meet each other, and
/// maps fail: measured on scans with 20 and more of them. Few handles are worth it, as a ring's own one is.
constexpr std::size_t kSeveralHandles = 8;
constexpr double kMostGrowthOfSeveral = 1.15;
constexpr std::size_t kManyHandles = 24;
constexpr double kMostGrowthOfMany = 1.05;
/// Where a round cuts less than this part of those it has tried, another one is not worth its phase 1.
constexpr double kWorthwhileCut = 0.125;
/// What the smallest block of a component may need, over the quads that its area is worth, so that maps are tried: with
/// the handles that are left, and before any was cut. Small components of few handles become blocks anyway.
constexpr double kMostBlockWorth = 3;
constexpr double kMostBlockBefore = 8;
constexpr double kQuadsOfFewHandles = 64;
/// From 512 handles on, that of twice as many before any was cut, the exact equations of a map take minutes: only where
/// the area is worth the block.
constexpr double kLargeBlock = 8192;
constexpr double kLargeBlockBefore = 16384;
constexpr double kWorthOfLargeBefore = 2;
/// By how much the limit below which Automatic simplifies grows where smaller quads at the rest take too many.
constexpr double kLimitStep = 0.5;

/// Of the stubs that a crowd of handles leaves, those with less area than so many quads are cut off, and how often
/// others are looked for that were inside or beside them.
constexpr double kQuadsOfThinPart = 6;
constexpr int kMostThinnings = 6;
/// They are cut off where the three vertices of each take more than this part of the coarse level's budget, which
/// leaves no room for a map, and where nothing else has led to quads: every cut changes the surface.
constexpr double kMostOfBudget = 0.5;

/// Handles that are cut where nothing else has led to quads, in edge lengths. Loops of the intermediate level are up to
/// a tenth too short, and of four quads round a handle a map may leave two: then they touch themselves.
constexpr double kLoopOfRest = 4;

/// What is asked of a surface, with the places of the vertices.
struct AskedOf
{
  explicit AskedOf(const PreparedSurface& surface) : requests(surface.requests())
  {
    for (const ValenceRequest& request : requests.valenceRequests)
    {
      valencePlaces.push_back(surface.mesh.position[request.vertex]);
    }
    for (const SectorRequest& request : requests.sectorRequests)
    {
      sectorPlaces.push_back(surface.mesh.position[request.vertex]);
    }
  }

  SurfaceRequests requests;
  std::vector<Vector3> valencePlaces, sectorPlaces;
};

/// The vertices at the same places of another surface, of several at one place that of the lowest id; a request without
/// one is dropped. requests: ascending by vertex, before and afterwards.
template <class Request>
void moveRequests(
  const Mesh& mesh, const std::vector<Vector3>& places, std::vector<Request>& requests)
{
  if (requests.empty())
  {
    return;
  }
  const auto isBefore = [](const Vector3& a, const Vector3& b)
  { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); };
  std::map<Vector3, Index, decltype(isBefore)> vertexAt(isBefore);
  for (const Vector3& p : places)
  {
    vertexAt.emplace(p, kInvalidIndex);
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const auto found = vertexAt.find(mesh.position[v]);
    if (found != vertexAt.end() && found->second == kInvalidIndex)
    {
      found->second = v;
    }
  }
  for (std::size_t i = 0; i < requests.size(); ++i)
  {
    requests[i].vertex = vertexAt.at(places[i]);
  }
  requests.erase(std::remove_if(requests.begin(), requests.end(),
                   [](const Request& request) { return request.vertex == kInvalidIndex; }),
    requests.end());
  std::sort(requests.begin(), requests.end(),
    [](const Request& a, const Request& b) { return a.vertex < b.vertex; });
}

/// A simplified surface in the store, without what was asked of it: guides, valences and curves change nothing of it.
struct StoredSettled
{
  PreparedSurface surface;
  ResultKey key = 0;
  std::vector<SmallDetail> simplified;
  bool hasFollowed = false; ///< its levels follow those of the surface before, see Levels
};

/// Of a surface that has no component of more handles than quads go round: an edit does not count them again.
struct JudgedPossible
{
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
      reused_(reused), asked_(*sized.surface), limit_(firstLimit()),
      handleLimit_(isRest ? kLoopOfRest * sized.edgeLength : limit_)
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
  double firstLimit() const
  {
    return sized_.edgeLength * (takesAll_ ? kQuadsOfLoop : kSimplifiedLoop);
  }

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

  /// Below the limit. Those of components with less area than a closed block of quads are left to them.
  std::vector<HandleLoop> shortBoundaryLoops() const
  {
    const PreparedSurface& surface = *sized_.surface;
    std::vector<HandleLoop> loops = measureBoundary(surface.mesh, limit_).tooShort;
    if (loops.empty())
    {
      return loops;
    }
    const SmallComponents small =
      findSmallComponents(surface, sized_.edgeLength, quadsOfBlock(2, 0), options_.threads);
    if (small.count > 0)
    {
      std::vector<std::uint8_t> isSmall(surface.mesh.vertexCount(), 0);
      for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
      {
        isSmall[surface.mesh.origin[h]] |= small.isSmall[Mesh::face(h)];
      }
      const auto isOfSmall = [&](const HandleLoop& loop)
      { return isSmall[loop.vertices.front()] != 0; };
      loops.erase(std::remove_if(loops.begin(), loops.end(), isOfSmall), loops.end());
    }
    return loops;
  }

  /// The number of holes that were filled.
  std::size_t fill()
  {
    const double start = secondsNow();
    const std::vector<HandleLoop> loops = shortBoundaryLoops();
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

  /// With vertices of the surface. The run knows those of up to kQuadsOfLoop edge lengths.
  std::vector<HandleLoop> handlesBelowLimit() const
  {
    RunBench& bench = *made_.bench;
    if (handleLimit_ > kQuadsOfLoop * sized_.edgeLength)
    {
      const Level& level = bench.levels.makeIntermediate(levelOptions(bench.run, {}));
      std::vector<HandleLoop> loops = findHandles(level.mesh, handleLimit_).loops;
      for (HandleLoop& loop : loops)
      {
        loop.vertices = onFinest(loop.vertices, level);
      }
      return loops;
    }
    const ShortLoops& found = bench.run.shortLoops;
    std::vector<HandleLoop> loops;
    std::copy_if(found.loops.begin(),
      found.loops.begin() + static_cast<std::ptrdiff_t>(found.parts.unresolvedHandles),
      std::back_inserter(loops),
      [&](const HandleLoop& loop) { return loop.length < handleLimit_; });
    return loops;
  }

  /// The number of handles below the limit that were cut; 0 where it is not worth going on. All were measured.
  std::size_t cut()
  {
    std::vector<std::vector<Index>> places;
    std::vector<double> lengths;
    std::vector<Vector3> at;
    for (HandleLoop& loop : handlesBelowLimit())
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
      kLongerAlongEdges * handleLimit_, kGirthOfLimb * sized_.edgeLength, options_.threads);
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

  /// The short loops that are at least as long as the limit: all, or those of handles only.
  std::vector<HandleLoop> loopsAboveLimit(bool ofHandles) const
  {
    const ShortLoops& found = made_.bench->run.shortLoops;
    const auto end = ofHandles
      ? found.loops.begin() + static_cast<std::ptrdiff_t>(found.parts.unresolvedHandles)
      : found.loops.end();
    std::vector<HandleLoop> loops;
    std::copy_if(found.loops.begin(), end, std::back_inserter(loops),
      [&](const HandleLoop& loop) { return loop.length >= (ofHandles ? handleLimit_ : limit_); });
    return loops;
  }

  /// The limit grows until smaller quads do for the loops that are at least as long. A crowd of handles is
  /// resolved as a whole or cut.
  void raiseLimit()
  {
    RunContext& run = made_.bench->run;
    const double most = kQuadsOfLoop * sized_.edgeLength;
    const std::vector<HandleLoop> handles = loopsAboveLimit(true);
    const double growth = handles.size() >= kManyHandles ? kMostGrowthOfMany : kMostGrowthOfSeveral;
    if (handles.size() >= kSeveralHandles && !resolvesLoops(run, handles, growth))
    {
      handleLimit_ = most;
      countTry(Try::RaisedLimit);
      isRaised_ = true;
    }
    while (limit_ < most && !resolvesLoops(run, loopsAboveLimit(false)))
    {
      limit_ = std::min(most, limit_ + kLimitStep * sized_.edgeLength);
      countTry(Try::RaisedLimit);
      isRaised_ = true;
    }
    handleLimit_ = std::max(handleLimit_, limit_);
  }

  /// Until no loop below the limit is left that can be closed.
  void simplifyAll()
  {
    for (int cutting = 0; cutting < kMostCuttings; ++cutting)
    {
      measure();
      if (!takesAll_)
      {
        raiseLimit();
      }
      if (cut() + fill() == 0)
      {
        break;
      }
      countTryLed(Try::RaisedLimit, isRaised_ ? 1 : 0);
      isRaised_ = false;
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
    std::vector<ThinPart> parts = findThinParts(
      level.mesh, { handleLimit_, kSimplifiedLoop * sized_.edgeLength, kQuadsOfThinPart * quad });
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

  /// A surface with more handles and holes than so many quads can go round ends in minutes of attempts that fail.
  bool isHopeless(bool isCut)
  {
    const ResultKey key =
      KeyMaker(sized_.key).add(sized_.edgeLength).add(std::uint64_t{ isCut ? 1U : 0U }).key();
    if (store_ != nullptr && store_->find<JudgedPossible>(key))
    {
      return false;
    }
    const double quad = sized_.edgeLength * sized_.edgeLength;
    const SmallComponents small = findSmallComponents(*sized_.surface, sized_.edgeLength,
      std::numeric_limits<double>::infinity(), options_.threads);
    const auto found = std::find_if(small.each.begin(), small.each.end(),
      [&](const SmallComponent& component)
      {
        const double worth = component.area / quad;
        const double block = component.block;
        return block > kQuadsOfFewHandles &&
          (isCut ? block > kMostBlockWorth * worth || block > kLargeBlock
                 : block > kMostBlockBefore * worth ||
                (block > kLargeBlockBefore && block > kWorthOfLargeBefore * worth));
      });
    if (found == small.each.end())
    {
      if (store_ != nullptr)
      {
        store_->put(key, std::make_shared<JudgedPossible>(), sizeof(JudgedPossible));
      }
      return false;
    }
    std::ostringstream text;
    text
      << "the handles and boundary loops of the component near " << placeText(found->place)
      << " need at least about " << std::llround(found->block) << " quads, but its area is that of "
      << std::llround(found->area / quad)
      << " of this size: simplify or wrap the surface (Surface Wrap), ask for more quads, or have "
         "it tried (Small Details Resolve, --small-details resolve)";
    made_.status = { StatusCode::Infeasible, text.str() };
    return true;
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
    surface.setRequests(asked_.requests);
    moveRequests(surface.mesh, asked_.valencePlaces, surface.valenceRequests);
    moveRequests(surface.mesh, asked_.sectorPlaces, surface.sectorRequests);
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
  AskedOf asked_;
  bool isRaised_ = false; ///< a limit, since anything was cut
  double limit_;          ///< of boundary loops, in units of the mesh
  double handleLimit_;    ///< of handles
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
