// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Recovery.h"

#include "Base/PlaceText.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

/// From this number of offenders on, an attempt must have halved that of the one before to deserve another.
constexpr std::size_t kManyOffenders = 100;
/// Rings of intermediate vertices that are kept around an offender.
constexpr int kFreedomRings = 2;
/// Where smaller quads make their number grow by more than this factor they may as well be smaller everywhere.
constexpr double kMostGrowth = 1.6;
constexpr double kShrink = 0.5;
constexpr double kShrinkRadius = 1.5; ///< edge lengths round a place
/// So many quads are made to fit round a loop that is too short for three, if they need not be smaller than this for it.
constexpr double kQuadsOfShrunkLoop = 4;
constexpr double kLeastShrink = 0.1;
/// How often features are given up.
constexpr std::size_t kMostFeatureDrops = 4;
/// Features are given up within this part of the edge length the first time, then twice as far each time.
constexpr double kFirstFeatureDrop = 0.5;

/// What there is to mend.
struct Trouble
{
  RunContext& run;
  const History& history;
  const Attempt& attempt;         ///< of the round
  std::vector<Vector3> places;    ///< where the map or its quads failed
  bool failed = true;             ///< else there are quads, but some are turned over at folds of the map
  std::optional<GridTroubles> grid;
  std::size_t bound = 0; ///< of the strategy that is asked
};

struct Strategy
{
  const char* name;
  std::size_t bound; ///< how often, see the function
  std::optional<Plan> (*next)(const Trouble& trouble);
};

/// What the map is scaled to.
double quadsFor(const RunContext& run, const Plan& plan, double sizedArea)
{
  const FinerGrid& finer = plan.finer;
  const double local = finer.areaBefore > 0 && finer.mayShrink ? sizedArea / finer.areaBefore : 1;
  return static_cast<double>(run.targetQuads) * std::pow(2.0, finer.doublings) * local;
}

/// A plan for another round: the levels begin as they did in the first one.
Plan newRound(const RunContext& run, Plan plan)
{
  plan.keptVertices = indexVertices(*run.surface);
  plan.coarseVertices = run.options.coarseVertices;
  plan.levelLength = 1;
  return plan;
}

/// Features that can be given up near the places.
std::vector<Index> featuresNear(
  const RunContext& run, const Plan& plan, const std::vector<Vector3>& places)
{
  const double radius = kFirstFeatureDrop * run.edgeLength * std::pow(2.0, plan.featureDrops);
  return static_cast<std::size_t>(plan.featureDrops) < kMostFeatureDrops
    ? detectedFeaturesNear(run.surface->mesh, places, radius)
    : std::vector<Index>{};
}

void keepAlso(const std::vector<Index>& vertices, Plan& plan)
{
  std::vector<Index>& kept = plan.keptVertices;
  kept.insert(kept.end(), vertices.begin(), vertices.end());
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
}

/// Vertices of the surface that are on the level, within some rings round others.
std::vector<Index> ringsRound(
  const Level& level, const std::vector<Index>& vertices, std::size_t vertexCount)
{
  std::vector<std::uint8_t> near(vertexCount, 0);
  for (const Index v : vertices)
  {
    near[v] = 1;
  }
  for (int ring = 0; ring < kFreedomRings; ++ring)
  {
    std::vector<Index> added;
    for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      const Index from = level.fineVertex[level.mesh.origin[h]];
      const Index to = level.fineVertex[level.mesh.target(h)];
      if (near[from] != near[to])
      {
        added.push_back(near[from] ? to : from);
      }
    }
    for (const Index v : added)
    {
      near[v] = 1;
    }
  }
  std::vector<Index> found;
  for (const Index v : level.fineVertex)
  {
    if (near[v])
    {
      found.push_back(v);
    }
  }
  return found;
}

/// Where the coarse map fails: keeps the intermediate vertices near the offenders and raises the budget by their number and a half. Where the
/// coarse level has all of the intermediate one already, both get about twice as many. Bound: times one after the other.
std::optional<Plan> moreFreedom(const Trouble& trouble)
{
  const History& history = trouble.history;
  const Attempt& last = history.last();
  const std::size_t offenders = last.map->coarseOffenders.size();
  const std::size_t times = history.trailing("more freedom");
  if (last.map->status.ok() || last.map->hopeless || times == trouble.bound ||
    (times > 0 && offenders >= kManyOffenders && 2 * offenders > history.offendersBefore()))
  {
    return std::nullopt;
  }
  RunContext& run = trouble.run;
  run.surface.apply(last.plan);
  const Hierarchy& levels = run.levels.make(levelOptions(run, last.plan), &last.map->phase1);
  const Index coarse = levels.coarse.mesh.vertexCount();
  Plan plan = last.plan;
  if (coarse == levels.intermediate.mesh.vertexCount())
  {
    plan.levelLength /= std::sqrt(2.0);
    plan.coarseVertices = 2 * coarse;
    return plan;
  }
  const std::size_t before = plan.keptVertices.size();
  keepAlso(ringsRound(levels.intermediate, last.map->coarseOffenders,
             run.surface->mesh.vertexCount()),
    plan);
  const std::size_t added = plan.keptVertices.size() - before;
  plan.coarseVertices =
    static_cast<Index>(std::max<std::size_t>(coarse + added, std::size_t{ coarse } * 5 / 4));
  return plan;
}

/// Where the surface's triangles have no room for the map, their vertices are kept on all levels, so that the coarse map shows what there is.
/// Bound: times in a round.
std::optional<Plan> keptOffenders(const Trouble& trouble)
{
  const History& history = trouble.history;
  const RunContext& run = trouble.run;
  const std::size_t times = history.inRound("kept offenders");
  if (!history.lastIsBest() || times == trouble.bound)
  {
    return std::nullopt;
  }
  const MapAttempt& map = *history.last().map;
  const std::vector<Index>& offenders = map.transfer.offenders;
  const Index coarse = map.coarse.mesh.vertexCount();
  // With offenders everywhere it is not a matter of a few places, and the coarse level would grow out of hand.
  if (hasPromised(map.certificate, run.options.method) || offenders.empty() ||
    offenders.size() > coarse / 2)
  {
    return std::nullopt;
  }
  // The last time is left out where features can be given up: what keeping vertices did not mend once is theirs.
  const bool isLast = times + 1 == trouble.bound;
  const std::vector<Vector3> places = positionsOf(run.surface->mesh, offenders);
  if (isLast && !featuresNear(run, history.last().plan, places).empty())
  {
    return std::nullopt;
  }
  Plan plan = history.last().plan;
  keepAlso(offenders, plan);
  if (plan.coarseVertices == 0)
  {
    plan.coarseVertices = coarse; // not fewer elsewhere because of these
  }
  plan.coarseVertices += static_cast<Index>(offenders.size());
  return plan;
}

/// The sizes of before smaller quads were tried near places, where they were.
Plan withoutShrinks(Plan plan)
{
  if (plan.finer.shrinks > 0 && plan.finer.mayShrink)
  {
    plan.sizes = plan.finer.sizesBefore;
  }
  plan.finer.mayShrink = false;
  return plan;
}

std::string nearText(const std::vector<Vector3>& places)
{
  return " near " + placeText(places.front()) + (places.size() > 1 ? " and other places" : "");
}

/// Where quads of the coarse map touch themselves: smaller quads there. Bound: times one after the other.
std::optional<Plan> smallerQuadsNear(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  Plan plan = newRound(run, trouble.attempt.plan);
  FinerGrid& finer = plan.finer;
  // A map with other sizes has other places where quads only just fit, so their number need not fall each time.
  if (!trouble.failed || run.options.coarsestIntegers || !finer.mayShrink ||
    static_cast<std::size_t>(finer.shrinks) == trouble.bound || !trouble.grid ||
    trouble.grid->places.empty())
  {
    return std::nullopt;
  }
  std::vector<Vector3> places = trouble.grid->places;
  if (finer.shrinks++ == 0)
  {
    finer.sizesBefore = plan.sizes;
    finer.areaBefore = run.surface.sizedArea();
    finer.firstTroubles = *trouble.grid;
    const std::vector<Vector3>& hopeless = run.shortLoops.hopelessPlaces;
    places.insert(places.end(), hopeless.begin(), hopeless.end());
  }
  finer.defects = trouble.grid->defects;
  plan.sizes = std::make_shared<const std::vector<float>>(run.surface.changedSizes(
    [&](Mesh& mesh)
    {
      scaleSizesNear(mesh, places, kShrinkRadius * run.edgeLength, kShrink);
      limitSizeGrowth(mesh, run.edgeLength);
    }));
  const double area = run.surface.sizedArea(*plan.sizes);
  if (area > kMostGrowth * finer.areaBefore)
  {
    return std::nullopt;
  }
  plan.quads = quadsFor(run, plan, area);
  std::ostringstream text;
  text << "quads of the wanted size do not fit round a handle or a thin part"
       << nearText(finer.firstTroubles.places) << ": they are made smaller there, about "
       << std::llround(plan.quads)
       << " quads altogether; close the handle for a result without this";
  finer.notice = text.str();
  return plan;
}

/// Whether quads that are smaller everywhere had no fewer defects.
bool isNoMatterOfSize(const Plan& plan, const std::optional<GridTroubles>& grid)
{
  return plan.finer.doublings > 0 && grid && grid->defects >= plan.finer.defects;
}

/// Where smaller quads near the places do not do: twice as many everywhere. Bound: times one after the other.
std::optional<Plan> moreQuads(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  Plan plan = newRound(run, withoutShrinks(trouble.attempt.plan));
  FinerGrid& finer = plan.finer;
  // The first time after sizes were tried it is their beginning that counts.
  const bool afterSizes = finer.shrinks > 0 && finer.doublings == 0;
  const GridTroubles* grid = trouble.grid ? &*trouble.grid : nullptr;
  grid = afterSizes ? &finer.firstTroubles : grid;
  if (!trouble.failed || run.options.coarsestIntegers || grid == nullptr ||
    static_cast<std::size_t>(finer.doublings) >= trouble.bound ||
    isNoMatterOfSize(plan, trouble.grid))
  {
    return std::nullopt;
  }
  ++finer.doublings;
  finer.defects = grid->defects;
  plan.quads = quadsFor(run, plan, 0);
  std::ostringstream text;
  text << "quads of the wanted size do not fit round a handle or a thin part";
  if (!grid->places.empty())
  {
    text << " near " << placeText(grid->places.front());
  }
  text << ": made for " << std::llround(plan.quads)
       << " quads instead; ask for that many, or close the handle, for a result without this";
  finer.notice = text.str();
  return plan;
}

/// Features that only the dihedral angle asked for are given up near the places of a failure, or near folds at which quads are turned over,
/// further round them each time. Bound: times in all.
std::optional<Plan> fewerFeatures(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  const Attempt& attempt = trouble.attempt;
  const bool tooLarge = attempt.map->status.code == StatusCode::TooLarge ||
    (attempt.quads && attempt.quads->status.code == StatusCode::TooLarge);
  std::vector<Vector3> places = trouble.places;
  Plan plan = newRound(run, attempt.plan);
  if (trouble.failed)
  {
    if (isNoMatterOfSize(plan, trouble.grid))
    {
      places.insert(places.end(), trouble.grid->places.begin(), trouble.grid->places.end());
    }
    plan = withoutShrinks(plan);
    plan.finer = {};
    plan.quads = quadsFor(run, plan, 0);
  }
  const std::vector<Index> features = featuresNear(run, plan, places);
  if (tooLarge || features.empty())
  {
    return std::nullopt;
  }
  ++plan.featureDrops;
  auto givenUp = plan.featuresGivenUp
    ? std::make_shared<std::vector<Index>>(*plan.featuresGivenUp)
    : std::make_shared<std::vector<Index>>();
  givenUp->insert(givenUp->end(), features.begin(), features.end());
  plan.featuresGivenUp = std::move(givenUp);
  plan.notices.push_back(std::to_string(features.size()) + " sharp edges" + nearText(places) +
    " leave no room for quads of this edge length and were not used as features");
  return plan;
}

/// The strategies in the order in which they are asked.
constexpr std::array<Strategy, 2> kForMaps{ {
  { "more freedom", 2, moreFreedom },
  { "kept offenders", 2, keptOffenders },
} };
constexpr std::array<Strategy, 3> kForRounds{ {
  { "smaller quads near", 4, smallerQuadsNear },
  { "more quads", 3, moreQuads },
  { "fewer features", kMostFeatureDrops, fewerFeatures },
} };

template <typename Strategies>
std::optional<Plan> firstOffer(const Strategies& strategies, Trouble& trouble)
{
  for (const Strategy& strategy : strategies)
  {
    trouble.bound = strategy.bound;
    if (std::optional<Plan> plan = strategy.next(trouble))
    {
      plan->step = strategy.name;
      return plan;
    }
  }
  return std::nullopt;
}

/// Sizes with which four quads fit round each of the loops.
std::vector<float> sizesAtLoops(RunContext& run)
{
  return run.surface.changedSizes(
    [&](Mesh& mesh)
    {
      mesh.sizing.resize(mesh.vertexCount(), 1.0F);
      std::vector<float> factor(mesh.vertexCount(), 1.0F);
      for (const HandleLoop& loop : run.shortLoops.loops)
      {
        const double wanted = loop.length / (kQuadsOfShrunkLoop * run.edgeLength);
        for (const Index v : loop.vertices)
        {
          factor[v] = std::min(factor[v], static_cast<float>(std::max(kLeastShrink, wanted)));
        }
      }
      for (Index v = 0; v < mesh.vertexCount(); ++v)
      {
        mesh.sizing[v] *= factor[v];
      }
      limitSizeGrowth(mesh, run.edgeLength);
    });
}

} // namespace

Plan firstPlan(RunContext& run)
{
  Plan plan = newRound(run, {});
  plan.quads = quadsFor(run, plan, 0);
  const std::vector<HandleLoop>& loops = run.shortLoops.loops;
  if (loops.empty() || run.options.coarsestIntegers ||
    run.options.method != MapMethod::ScaleAware)
  {
    return plan;
  }
  std::vector<float> sizes = sizesAtLoops(run);
  if (run.surface.sizedArea(sizes) > kMostGrowth * run.surface.sizedArea())
  {
    return plan;
  }
  plan.sizes = std::make_shared<const std::vector<float>>(std::move(sizes));
  plan.notices.push_back("quads are made smaller round " + std::to_string(loops.size()) +
    " handles and holes that are shorter round than three of the wanted size, one of them near " +
    placeText(run.surface->mesh.position[loops.front().vertices.front()]) +
    "; close or fill them for quads of one size");
  return plan;
}

std::optional<Plan> nextMapPlan(RunContext& run, const History& history)
{
  if (history.isSpent())
  {
    return std::nullopt;
  }
  Trouble trouble{ run, history, history.last(), {}, true, {}, 0 };
  return firstOffer(kForMaps, trouble);
}

std::optional<Plan> nextPlan(RunContext& run, const History& history)
{
  const Attempt& attempt = history.last();
  const bool mapped = attempt.map->status.ok();
  const bool hasQuads = attempt.quads && attempt.quads->status.ok();
  if (history.isSpent() || (mapped && isRounded(run.options.method)) ||
    (hasQuads && !attempt.quads->turnedAtFolds))
  {
    return std::nullopt;
  }
  run.surface.apply(attempt.plan);
  Trouble trouble{ run, history, attempt, {}, !hasQuads, {}, 0 };
  trouble.places = mapped ? positionsOf(run.surface->mesh, attempt.map->transfer.offenders)
                          : attempt.map->coarseTroubles;
  if (trouble.failed)
  {
    trouble.grid = gridTroubles(run, *attempt.map);
  }
  return firstOffer(kForRounds, trouble);
}

std::vector<std::string> recoverySteps()
{
  std::vector<std::string> names;
  for (const Strategy& strategy : kForMaps)
  {
    names.emplace_back(strategy.name);
  }
  for (const Strategy& strategy : kForRounds)
  {
    names.emplace_back(strategy.name);
  }
  return names;
}

} // namespace quadrille
