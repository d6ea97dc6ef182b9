// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Strategies.h"

#include "Base/PlaceText.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/Guides.h"
#include "Mesh/Sizing.h"
#include "Pipeline/FirstPlan.h"

#include <algorithm>
#include <cmath>
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

Plan newRound(Plan plan)
{
  plan.levels = plan.nextLevels;
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

/// Whether a limit of the user stands in the way, which features have no part in.
bool isTooLarge(const Attempt& attempt)
{
  return attempt.map->status.code == StatusCode::TooLarge ||
    (attempt.quads && attempt.quads->status.code == StatusCode::TooLarge);
}

/// Where an earlier round has quads, of which some are inverted, a finer grid would cost more than it gives.
bool asksForFinerGrid(const Trouble& trouble)
{
  const RemeshOptions& options = trouble.run.options;
  return trouble.failed && !trouble.history.hasResult() && !options.coarsestIntegers &&
    options.smallDetails != SmallDetails::Keep;
}

/// Whether quads that are smaller everywhere had no fewer defects. Along a tube that still too few quads go round there
/// are as many as the tube is long, and so sqrt 2 times as many as before: another doubling may help there.
bool isNoMatterOfSize(const Plan& plan, const std::optional<GridTroubles>& grid)
{
  return plan.finer.doublings > 0 && grid && grid->defects >= plan.finer.defects &&
    static_cast<double>(grid->defects) <=
    kGrowthAlongTubes * static_cast<double>(plan.finer.defects);
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

} // namespace

std::vector<Index> featuresNear(
  const RunContext& run, const Plan& plan, const std::vector<Vector3>& places)
{
  const double radius = kFirstFeatureDrop * run.edgeLength * std::pow(2.0, plan.featureDrops);
  return static_cast<std::size_t>(plan.featureDrops) < kMostFeatureDrops
    ? detectedFeaturesNear(run.surface->mesh, places, radius)
    : std::vector<Index>{};
}

std::optional<Plan> smallerQuadsNear(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  Plan plan = newRound(trouble.attempt.plan);
  FinerGrid& finer = plan.finer;
  // A map with other sizes has other places where quads only just fit, so their number need not fall each time.
  if (!asksForFinerGrid(trouble) || !finer.mayShrink ||
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
  const std::vector<HandleLoop> loops = loopsNear(run, trouble.grid->places);
  plan.sizes = std::make_shared<const std::vector<float>>(run.surface.changedSizes(
    [&](Mesh& mesh)
    {
      scaleSizesNear(mesh, places, kShrinkRadius * run.edgeLength, kShrink);
      const std::vector<float> fitting =
        sizesOfLoops(loops, run.edgeLength, kLeastSizeOfLoop, mesh.vertexCount());
      for (Index v = 0; v < mesh.vertexCount(); ++v)
      {
        mesh.sizing[v] = std::min(mesh.sizing[v], fitting[v]);
      }
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

std::optional<Plan> moreQuads(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  Plan plan = newRound(withoutShrinks(trouble.attempt.plan));
  FinerGrid& finer = plan.finer;
  // The first time after sizes were tried it is their beginning that counts.
  const bool afterSizes = finer.shrinks > 0 && finer.doublings == 0;
  const GridTroubles* grid = trouble.grid ? &*trouble.grid : nullptr;
  grid = afterSizes ? &finer.firstTroubles : grid;
  if (!asksForFinerGrid(trouble) || grid == nullptr ||
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

std::optional<Plan> fewerFeatures(const Trouble& trouble)
{
  RunContext& run = trouble.run;
  const Attempt& attempt = trouble.attempt;
  std::vector<Vector3> places = trouble.places;
  Plan plan = newRound(attempt.plan);
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
  if (isTooLarge(attempt) || features.empty())
  {
    return std::nullopt;
  }
  ++plan.featureDrops;
  auto givenUp = plan.featuresGivenUp ? std::make_shared<std::vector<Index>>(*plan.featuresGivenUp)
                                      : std::make_shared<std::vector<Index>>();
  givenUp->insert(givenUp->end(), features.begin(), features.end());
  plan.featuresGivenUp = std::move(givenUp);
  plan.notices.push_back(std::to_string(features.size()) + " sharp edges" + nearText(places) +
    " leave no room for quads of this edge length and were not used as features");
  return plan;
}

std::optional<Plan> withoutFeatures(RunContext& run, const Plan& before)
{
  run.surface.apply(before);
  const Mesh& mesh = run.surface->mesh;
  auto givenUp = before.featuresGivenUp
    ? std::make_shared<std::vector<Index>>(*before.featuresGivenUp)
    : std::make_shared<std::vector<Index>>();
  const std::size_t known = givenUp->size();
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (isDetectedFeature(mesh, h))
    {
      givenUp->push_back(h);
    }
  }
  if (givenUp->size() == known)
  {
    return std::nullopt;
  }
  // From the beginning: what was kept and made smaller was for the sake of the features.
  Plan plan = withoutShrinks(before);
  plan.finer = {};
  plan.levels = {};
  plan.levels.keptVertices = keptVertices(*run.surface);
  plan.levels.coarseVertices = run.options.coarseVertices;
  plan.nextLevels = plan.levels;
  plan.quads = quadsFor(run, plan, 0);
  plan.featureDrops = static_cast<int>(kMostFeatureDrops);
  plan.notices.push_back("with features no attempt has led to quads: all " +
    std::to_string(givenUp->size()) +
    " sharp edges that were found by their angle were not used as features; ask for smaller "
    "quads, or mark the edges that are to stay");
  plan.featuresGivenUp = std::move(givenUp);
  plan.step = kNoFeatures;
  return plan;
}

std::optional<Plan> noFeatures(const Trouble& trouble)
{
  const std::vector<std::string>& steps = trouble.history.steps();
  const auto times = std::count(steps.begin(), steps.end(), kNoFeatures);
  return static_cast<std::size_t>(times) >= trouble.bound || isTooLarge(trouble.attempt)
    ? std::nullopt
    : withoutFeatures(trouble.run, trouble.attempt.plan);
}

} // namespace quadrille
