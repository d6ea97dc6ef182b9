// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Strategies.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Features/FeatureFilter.h"
#include "Features/FeatureNetwork.h"
#include "Features/GivenUpFeatures.h"
#include "Mesh/Sizing.h"
#include "Pipeline/FirstPlan.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kShrink = 0.5;
/// Of the number of defects where there are twice as many quads.
constexpr double kGrowthAlongTubes = 1.35;
constexpr double kShrinkRadius = 1.5; ///< edge lengths round a place
/// How small quads become for a loop at which they have met themselves; sizes that differ so much make maps harder, so
/// the first plan does without.
constexpr double kLeastSizeOfLoop = 0.02;
/// Features are given up within this part of the edge length the first time, then twice as far each time.
constexpr double kFirstFeatureDrop = 0.5;

/// What becomes of borders of patches, one step after the other. size: quads so many times as large as they are to be
/// have to resolve them; or within so many edge lengths of a failure.
struct BorderStep
{
  enum class Way : std::uint8_t
  {
    Merge,      ///< junctions next to each other become one
    Unresolved, ///< by the rules for detected features
    Near
  } way;
  double size = 1;
};
constexpr std::array<BorderStep, kMostBorderDrops> kBorderSteps{ {
  { BorderStep::Way::Merge, 1 },
  { BorderStep::Way::Unresolved, 1 },
  { BorderStep::Way::Near, 0.5 },
  { BorderStep::Way::Near, 1 },
  { BorderStep::Way::Unresolved, 2 },
  { BorderStep::Way::Unresolved, 4 },
} };
/// The same of detected features, where nothing else has led to quads.
constexpr double kCoarserFeatures = 4;
/// Of the last resort, before all of them go.
constexpr double kLastBorderSize = 8;

/// These do not show in the plan any more.
void forget(std::initializer_list<Try> steps, Plan& plan)
{
  std::vector<Try>& made = plan.made;
  made.erase(
    std::remove_if(made.begin(), made.end(),
      [&](Try step) { return std::find(steps.begin(), steps.end(), step) != steps.end(); }),
    made.end());
}

Plan newRound(Plan plan)
{
  plan.levels = plan.nextLevels;
  forget({ Try::KeptDefects, Try::RoomForCurves }, plan);
  return plan;
}

/// The sizes of before smaller quads were tried near places, where they were.
Plan withoutShrinks(Plan plan)
{
  if (plan.finer.shrinks > 0 && plan.finer.mayShrink)
  {
    plan.sizes = plan.finer.sizesBefore;
    forget({ Try::SmallerQuadsNear }, plan);
  }
  plan.finer.mayShrink = false;
  return plan;
}

std::string nearText(const std::vector<Vector3>& places)
{
  return " near " + placeText(places.front()) + (places.size() > 1 ? " and other places" : "");
}

/// Where an earlier round has quads, of which some are inverted, a finer grid would cost more than it gives.
bool asksForFinerGrid(const AttemptFailure& failure)
{
  const RemeshOptions& options = failure.run.options;
  return failure.withoutQuads && !failure.history.hasResult() && !options.coarsestIntegers &&
    options.smallDetails != SmallDetails::Keep;
}

/// Whether quads that are smaller everywhere had no fewer defects. Along a tube that still too few quads go round there
/// are as many as the tube is long, and so sqrt 2 times as many as before: another doubling may help there.
bool isNoMatterOfSize(const Plan& plan, const std::optional<GridDefects>& grid)
{
  return plan.finer.doublings > 0 && grid && grid->count >= plan.finer.defects &&
    static_cast<double>(grid->count) <= kGrowthAlongTubes * static_cast<double>(plan.finer.defects);
}

/// Loops of handles and holes that pass near one of the places.
std::vector<HandleLoop> loopsNear(const RunContext& run, const std::vector<Vector3>& places)
{
  const auto isAtPlace = [&](Index v)
  { return isNear(run.surface->mesh.position[v], places, kShrinkRadius * run.edgeLength); };
  std::vector<HandleLoop> near;
  for (const HandleLoop& loop : run.shortLoops.loops)
  {
    if (std::any_of(loop.vertices.begin(), loop.vertices.end(), isAtPlace))
    {
      near.push_back(loop);
    }
  }
  return near;
}

/// With the first levels, sizes and number of quads: what was kept and made smaller was for the sake of features.
Plan fromTheBeginning(const RunContext& run, const Plan& before)
{
  Plan plan = withoutShrinks(before);
  forget({ Try::MoreFreedom, Try::KeptDefects, Try::RoomForCurves, Try::MoreQuads }, plan);
  plan.finer = {};
  plan.levels = firstLevels(run);
  plan.nextLevels = plan.levels;
  plan.quads = quadsFor(run, plan, 0);
  return plan;
}

void giveUp(const std::vector<Index>& features, Plan& plan)
{
  auto all = plan.featuresGivenUp ? std::make_shared<std::vector<Index>>(*plan.featuresGivenUp)
                                  : std::make_shared<std::vector<Index>>();
  all->insert(all->end(), features.begin(), features.end());
  plan.featuresGivenUp = std::move(all);
}

/// Features that quads so many times as large as they are to be cannot resolve.
std::vector<Index> unresolved(const RunContext& run, Mesh mesh, double times)
{
  const bool isDesigned = run.surface->facets.isDesigned;
  const std::vector<std::uint8_t> before = mesh.flags;
  const double edgeLength = times * run.edgeLength;
  FeatureFilterReport filtered =
    removeUnresolvedFeatures(mesh, edgeLength, isDesigned, run.options.threads);
  simplifyFeatureNetwork(mesh, edgeLength, isDesigned, filtered);
  return lostFeatures(mesh, before);
}

/// The same where those that yield count as detected ones.
std::vector<Index> unresolvedWithBorders(const RunContext& run, Mesh mesh, double times)
{
  for (std::uint8_t& flags : mesh.flags.editAll())
  {
    flags &= (flags & kYieldingFeature) != 0 ? static_cast<std::uint8_t>(~kRequestedFeature) : 0xFF;
  }
  return unresolved(run, std::move(mesh), times);
}

/// Junctions of borders that are too near to each other for quads become one; null where there are none.
std::shared_ptr<const MovedFeatures> mergedJunctions(Mesh mesh, double edgeLength)
{
  constexpr int mostRounds = 4;
  const std::vector<std::uint8_t> before = mesh.flags;
  auto all = std::make_shared<MovedFeatures>();
  for (int round = 0; round < mostRounds; ++round)
  {
    const MovedFeatures moved = mergeNearJunctions(mesh, edgeLength);
    if (moved.junctions == 0)
    {
      break;
    }
    all->place = all->junctions == 0 ? moved.place : all->place;
    all->junctions += moved.junctions;
  }
  if (all->junctions == 0)
  {
    return nullptr;
  }
  all->off = lostFeatures(mesh, before);
  const std::vector<std::uint8_t> after = mesh.flags;
  mesh.flags = before;
  all->on = lostFeatures(mesh, after);
  return all;
}

/// What features are called that yield.
struct YieldingWords
{
  const char* one;    ///< "of so many ..."
  const char* many;   ///< once they were named
  const char* beside; ///< what meets at edges of quads in their place
  const char* remedy;
};

/// Edges of a design (SurfaceInput::featuresYield) are the features of a designed body that were not found by an angle.
YieldingWords yieldingWords(const RunContext& run)
{
  return run.surface->facets.isDesigned && !run.options.featureAngle
    ? YieldingWords{ "CAD edges", "edges", "faces", "ask for more quads" }
    : YieldingWords{ "borders between patches", "borders", "patches",
        "ask for more quads, or for patches that are wider than a quad," };
}

std::string mergedNotice(const MovedFeatures& moved, const YieldingWords& words)
{
  const bool isOne = moved.junctions == 1;
  return std::to_string(moved.junctions) + (isOne ? " junction" : " junctions") + " of " +
    words.one + ", nearer to another one than half a quad, " + (isOne ? "" : "the first ") +
    "near " + placeText(moved.place) + (isOne ? ", counts" : ", count") +
    " as one with it, as there is no map with both: " + words.many +
    " that end there run beside where they were; ask for more quads for all " + words.many +
    " to be followed";
}

/// All borders of patches that a plan gives up, in a sentence.
std::string borderNotice(const RunContext& run, const Mesh& mesh, const Plan& plan)
{
  std::vector<Index> borders;
  for (const Index h : *plan.featuresGivenUp)
  {
    if ((mesh.flags[h] & kYieldingFeature) != 0)
    {
      borders.push_back(h);
    }
  }
  sortUnique(borders);
  const std::vector<GivenUpCurve> curves =
    givenUpCurves(mesh, borders, run.edgeLength, FeatureLoss::FailedMap);
  const auto longest = std::max_element(curves.begin(), curves.end(),
    [](const GivenUpCurve& a, const GivenUpCurve& b) { return a.lengthInQuads < b.lengthInQuads; });
  if (longest == curves.end())
  {
    return {};
  }
  double length = 0, all = 0;
  for (const GivenUpCurve& curve : curves)
  {
    length += curve.lengthInQuads;
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const bool isBorder =
      !mesh.isBoundary(h) && h < mesh.twin[h] && (mesh.flags[h] & kYieldingFeature) != 0;
    all += isBorder ? sizedLength(mesh, h) / run.edgeLength : 0;
  }
  const YieldingWords words = yieldingWords(run);
  std::ostringstream text;
  text << std::setprecision(3) << length << " of " << all << " edge lengths of " << words.one
       << ", the longest curve with " << longest->lengthInQuads << " near "
       << placeText(longest->place)
       << ", leave no room for quads of this size: quads do not follow them, and the "
       << words.beside << " meet at edges of quads beside; " << words.remedy << " for all "
       << words.many << " to be followed";
  return text.str();
}

/// The half-edges that `isOne` says so of.
std::vector<Index> allOf(const Mesh& mesh, bool (*isOne)(const Mesh&, Index))
{
  std::vector<Index> found;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (isOne(mesh, h))
    {
      found.push_back(h);
    }
  }
  return found;
}

} // namespace

bool isTooLarge(const Attempt& attempt)
{
  return attempt.map->status.code == StatusCode::TooLarge ||
    (attempt.quads && attempt.quads->status.code == StatusCode::TooLarge);
}

std::vector<FeatureDrop> dropsAt(const AttemptFailure& failure, const std::vector<Vector3>& places)
{
  const Plan& plan = failure.attempt.plan;
  std::vector<FeatureDrop> drops;
  if (static_cast<std::size_t>(plan.featureDrops) >= kMostFeatureDrops && !failure.withoutQuads)
  {
    return drops;
  }
  for (const Vector3& place : places)
  {
    double radius = kFirstFeatureDrop * failure.run.edgeLength;
    for (const FeatureDrop& before : plan.dropped)
    {
      const double twice = 2 * before.radius;
      radius = (place - before.place).norm() <= twice ? std::max(radius, twice) : radius;
    }
    drops.push_back({ place, radius });
  }
  return drops;
}

std::vector<Index> featuresNear(
  const AttemptFailure& failure, const std::vector<FeatureDrop>& drops)
{
  std::vector<Index> features;
  std::map<double, std::vector<Vector3>> byRadius;
  for (const FeatureDrop& drop : drops)
  {
    byRadius[drop.radius].push_back(drop.place);
  }
  for (const auto& [radius, places] : byRadius)
  {
    append(features, detectedFeaturesNear(failure.surface->mesh, places, radius));
  }
  sortUnique(features);
  return features;
}

std::optional<Plan> smallerQuadsNear(const AttemptFailure& failure)
{
  const RunContext& run = failure.run;
  Plan plan = newRound(failure.attempt.plan);
  FinerGrid& finer = plan.finer;
  // A map with other sizes has other places where quads only just fit, so their number need not fall each time.
  if (!asksForFinerGrid(failure) || !finer.mayShrink ||
    static_cast<std::size_t>(finer.shrinks) == failure.bound || !failure.grid ||
    failure.grid->places.empty())
  {
    return std::nullopt;
  }
  std::vector<Vector3> places = failure.grid->places;
  if (finer.shrinks++ == 0)
  {
    finer.sizesBefore = plan.sizes;
    finer.areaBefore = areaOverSizes(*failure.surface);
    finer.firstDefects = *failure.grid;
    const std::vector<Vector3>& hopeless = run.shortLoops.hopelessPlaces;
    places.insert(places.end(), hopeless.begin(), hopeless.end());
  }
  finer.defects = failure.grid->count;
  const std::vector<HandleLoop> loops = loopsNear(run, failure.grid->places);
  Mesh mesh = failure.surface->mesh;
  scaleSizesNear(mesh, places, kShrinkRadius * run.edgeLength, kShrink);
  const std::vector<float> fitting =
    sizesOfLoops(loops, run.edgeLength, kLeastSizeOfLoop, mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    mesh.sizing.edit()[v] = std::min(mesh.sizing[v], fitting[v]);
  }
  limitSizeGrowth(mesh, run.edgeLength);
  plan.sizes = std::make_shared<const std::vector<float>>(mesh.sizing.take());
  const double area = areaOverSizes(*failure.surface, *plan.sizes);
  if (area > kMostGrowth * finer.areaBefore)
  {
    return std::nullopt;
  }
  plan.quads = quadsFor(run, plan, area);
  std::ostringstream text;
  text << "quads of the wanted size do not fit round a handle or a thin part"
       << nearText(finer.firstDefects.places) << ": they are made smaller there, about "
       << std::llround(plan.quads)
       << " quads altogether; close the handle for a result without this";
  finer.notice = text.str();
  return plan;
}

std::optional<Plan> moreQuads(const AttemptFailure& failure)
{
  const RunContext& run = failure.run;
  Plan plan = newRound(withoutShrinks(failure.attempt.plan));
  FinerGrid& finer = plan.finer;
  // The first time after sizes were tried it is their beginning that counts.
  const bool afterSizes = finer.shrinks > 0 && finer.doublings == 0;
  const GridDefects* grid = failure.grid ? &*failure.grid : nullptr;
  grid = afterSizes ? &finer.firstDefects : grid;
  if (!asksForFinerGrid(failure) || grid == nullptr ||
    static_cast<std::size_t>(finer.doublings) >= failure.bound ||
    isNoMatterOfSize(plan, failure.grid))
  {
    return std::nullopt;
  }
  ++finer.doublings;
  finer.defects = grid->count;
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

std::optional<Plan> fewerFeatures(const AttemptFailure& failure)
{
  const RunContext& run = failure.run;
  const Attempt& attempt = failure.attempt;
  std::vector<Vector3> places = failure.places;
  Plan plan = newRound(attempt.plan);
  if (failure.withoutQuads)
  {
    if (isNoMatterOfSize(plan, failure.grid))
    {
      places.insert(places.end(), failure.grid->places.begin(), failure.grid->places.end());
    }
    plan = withoutShrinks(plan);
    plan.finer = {};
    plan.quads = quadsFor(run, plan, 0);
  }
  std::vector<FeatureDrop> drops = dropsAt(failure, places);
  std::vector<Index> features = featuresNear(failure, drops);
  const double farthest = failure.surface->boundingBoxDiagonal;
  while (
    failure.withoutQuads && features.empty() && !drops.empty() && drops.front().radius < farthest)
  {
    for (FeatureDrop& drop : drops)
    {
      drop.radius *= 2;
    }
    features = featuresNear(failure, drops);
  }
  if (isTooLarge(attempt) || features.empty())
  {
    return std::nullopt;
  }
  ++plan.featureDrops;
  append(plan.dropped, drops);
  giveUp(features, plan);
  plan.notices.push_back(std::to_string(features.size()) + " sharp edges" + nearText(places) +
    " leave no room for quads of this edge length and were not used as features");
  return plan;
}

std::optional<Plan> fewerBorders(const AttemptFailure& failure)
{
  return failure.withoutQuads && !isTooLarge(failure.attempt) &&
      failure.attempt.plan.borderDrops > 0
    ? withFewerBorders(failure.run, failure.attempt.plan, failure.places)
    : std::nullopt;
}

std::optional<Plan> withFewerBorders(
  const RunContext& run, const Plan& before, const std::vector<Vector3>& places)
{
  const PlannedSurface surface = withPlan(run.surface, before, run.options.threads);
  const Mesh& mesh = surface->mesh;
  if (allOf(mesh, isYieldingFeature).empty())
  {
    return std::nullopt;
  }
  Plan plan = fromTheBeginning(run, before);
  while (static_cast<std::size_t>(plan.borderDrops) < kBorderSteps.size())
  {
    const BorderStep& step = kBorderSteps[static_cast<std::size_t>(plan.borderDrops++)];
    if (step.way == BorderStep::Way::Merge && (plan.moved = mergedJunctions(mesh, run.edgeLength)))
    {
      plan.notices.push_back(mergedNotice(*plan.moved, yieldingWords(run)));
      return plan;
    }
    std::vector<Index> features;
    if (step.way == BorderStep::Way::Unresolved)
    {
      features = unresolvedWithBorders(run, mesh, step.size);
    }
    else if (step.way == BorderStep::Way::Near && !places.empty())
    {
      features = yieldingFeaturesNear(mesh, places, step.size * run.edgeLength);
      const std::vector<Index> detected =
        detectedFeaturesNear(mesh, places, step.size * run.edgeLength);
      features.insert(features.end(), detected.begin(), detected.end());
    }
    if (!features.empty())
    {
      giveUp(features, plan);
      plan.borderNotice = borderNotice(run, mesh, plan);
      return plan;
    }
  }
  return std::nullopt;
}

std::optional<Plan> withCoarserFeatures(const RunContext& run, const Plan& before)
{
  const PlannedSurface surface = withPlan(run.surface, before, run.options.threads);
  const std::vector<Index> detected = allOf(surface->mesh, isDetectedFeature);
  std::vector<Index> features;
  const std::vector<Try>& made = before.made;
  if (std::find(made.begin(), made.end(), Try::CoarserFeatures) == made.end() && !detected.empty())
  {
    features = unresolved(run, surface->mesh, kCoarserFeatures);
  }
  features = features.empty() ? detected : features;
  if (features.empty())
  {
    return std::nullopt;
  }
  Plan plan = fromTheBeginning(run, before);
  plan.featureDrops = static_cast<int>(kMostFeatureDrops);
  giveUp(features, plan);
  plan.notices.push_back("with all features no attempt has led to quads: " +
    std::to_string(features.size()) + " of " + std::to_string(detected.size()) +
    " sharp edges that were found by their angle were not used as features" +
    (features.size() < detected.size() ? ", those that much larger quads could not follow" : "") +
    "; ask for smaller quads, or mark the edges that are to stay");
  return plan;
}

std::optional<Plan> noBorders(const AttemptFailure& failure)
{
  const RunContext& run = failure.run;
  const Mesh& mesh = failure.surface->mesh;
  const Plan& before = failure.attempt.plan;
  const std::vector<Index> all = allOf(mesh, isYieldingFeature);
  if (all.empty() || isTooLarge(failure.attempt) || before.borderDrops == 0)
  {
    return std::nullopt;
  }
  const std::vector<Index> some = static_cast<std::size_t>(before.borderDrops) <= kMostBorderDrops
    ? unresolvedWithBorders(run, mesh, kLastBorderSize)
    : std::vector<Index>{};
  Plan plan = fromTheBeginning(run, before);
  plan.borderDrops = static_cast<int>(kMostBorderDrops) + 1;
  giveUp(some.empty() ? all : some, plan);
  plan.borderNotice = borderNotice(run, mesh, plan);
  return plan;
}

std::optional<Plan> coarserFeatures(const AttemptFailure& failure)
{
  const std::vector<std::string>& steps = failure.history.steps();
  const auto times = std::count(steps.begin(), steps.end(), tryRow(Try::CoarserFeatures).name);
  return static_cast<std::size_t>(times) >= failure.bound || isTooLarge(failure.attempt)
    ? std::nullopt
    : withCoarserFeatures(failure.run, failure.attempt.plan);
}

} // namespace quadrille
