// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Strategies.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Features/FeatureFilter.h"
#include "Pipeline/FaceDivision.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/SmallParts.h"
#include "Requests/Counterparts.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

/// Features are given up within this part of the edge length the first time, then twice as far each time.
constexpr double kFirstFeatureDrop = 0.5;

/// Edge lengths between irregular vertices that are put beside one.
constexpr double kSideOfCounterparts = 3;

constexpr const char* kDoNotFit =
  "quads of the wanted size do not fit round a handle, a hole or a thin part near ";

/// These do not show in the plan any more.
void forget(std::initializer_list<Try> steps, Plan& plan)
{
  eraseIf(plan.made, [&](Try step) { return contains(steps, step); });
}

std::string nearText(const std::vector<Vector3>& places)
{
  return " near " + placeText(places.front()) + (places.size() > 1 ? " and other places" : "");
}

/// With the first levels and number of quads.
Plan fromTheBeginning(const RunContext& run, Plan plan)
{
  forget({ Try::MoreFreedom, Try::MoreQuads }, plan);
  plan.quads = static_cast<double>(run.targetQuads);
  plan.levels = firstLevels(run);
  return plan;
}

void giveUp(const std::vector<Index>& features, Plan& plan)
{
  auto all = plan.featuresGivenUp ? std::make_shared<std::vector<Index>>(*plan.featuresGivenUp)
                                  : std::make_shared<std::vector<Index>>();
  all->insert(all->end(), features.begin(), features.end());
  plan.featuresGivenUp = std::move(all);
}

/// How far round each of the places features are given up: half an edge length where it has not failed before, else
/// twice as far as then.
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

/// The features that go then.
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
    append(features, featuresNear(failure.surface->mesh, places, radius));
  }
  sortUnique(features);
  return features;
}

/// As many as go three times round the shortest loop, where details are to be resolved; 0: edges would be too short, or
/// no loop asks for it.
double quadsForLoops(const RunContext& run)
{
  const std::vector<HandleLoop>& loops = run.shortLoops.loops;
  if (loops.empty() || run.options.smallDetails != SmallDetails::Resolve)
  {
    return 0;
  }
  const HandleLoop& shortest = *std::min_element(loops.begin(), loops.end(),
    [](const HandleLoop& a, const HandleLoop& b) { return a.length < b.length; });
  const double finer = kQuadsOfLoop * run.edgeLength / shortest.length;
  return finer * kLeastShrink > 1 ? 0 : static_cast<double>(run.targetQuads) * finer * finer;
}

} // namespace

bool isTooLarge(const Attempt& attempt)
{
  return attempt.map->status.code == StatusCode::TooLarge ||
    (attempt.quads && attempt.quads->status.code == StatusCode::TooLarge);
}

std::optional<Plan> moreQuads(const AttemptFailure& failure)
{
  const RunContext& run = failure.run;
  const Attempt& attempt = failure.attempt;
  const auto wanted = static_cast<double>(run.targetQuads);
  const auto most = wanted * std::pow(2.0, static_cast<double>(failure.bound));
  Plan plan = fromTheBeginning(run, attempt.plan);
  if (isTooLarge(attempt) || !mayResolve(run.options))
  {
    return std::nullopt;
  }
  const double forLoops = attempt.plan.quads > wanted ? 0 : quadsForLoops(run);
  const bool isTouching = attempt.map->status.ok() && attempt.quads &&
    !attempt.quads->failedFaces.empty() && attempt.plan.quads < most;
  if (forLoops == 0 && !isTouching)
  {
    return std::nullopt;
  }
  plan.quads = forLoops > 0 ? forLoops : 2 * attempt.plan.quads;
  eraseIf(plan.notices, [](const std::string& text) { return text.find(kDoNotFit) == 0; });
  const Vector3 place = isTouching
    ? run.surface->mesh.middleOfFace(attempt.quads->failedFaces.front())
    : run.surface->mesh.position[run.shortLoops.loops.front().vertices.front()];
  plan.notices.push_back(kDoNotFit + placeText(place) + ": made for " +
    std::to_string(std::llround(plan.quads)) +
    " quads instead; ask for that many, or close it, for a result without this");
  return plan;
}

std::optional<Plan> withCounterparts(const AttemptFailure& failure)
{
  const PreparedSurface& surface = *failure.surface;
  const double edgeLength = failure.run.edgeLength;
  Plan plan = failure.attempt.plan;
  if (plan.counterparts || surface.regularElsewhere || isTooLarge(failure.attempt))
  {
    return std::nullopt;
  }
  std::map<Index, ValenceRequest> byVertex;
  std::vector<Vector3> places;
  for (const ValenceRequest& asked : surface.valenceRequests)
  {
    const Vector3& at = surface.mesh.position[asked.vertex];
    const bool failsThere = std::any_of(failure.places.begin(), failure.places.end(),
      [&](const Vector3& p) { return (p - at).norm() <= 2 * kSideOfCounterparts * edgeLength; });
    if (asked.valence != kRegularValence && failsThere)
    {
      const std::vector<ValenceRequest> square =
        counterparts(surface, asked, kSideOfCounterparts * edgeLength);
      for (const ValenceRequest& request : square)
      {
        byVertex.emplace(request.vertex, request);
      }
      if (!square.empty())
      {
        places.push_back(at);
      }
    }
  }
  if (byVertex.empty())
  {
    return std::nullopt;
  }
  std::vector<ValenceRequest> more;
  for (const auto& [vertex, request] : byVertex)
  {
    more.push_back(request);
    plan.levels.keptVertices.push_back(vertex);
  }
  sortUnique(plan.levels.keptVertices);
  plan.notices.push_back(
    "a single irregular vertex does not fit between the features round it, so " +
    std::to_string(more.size()) + " others were put beside what was asked for" + nearText(places) +
    "; add a vertex of the opposite valence where it may be, to have fewer");
  plan.counterparts = std::make_shared<const std::vector<ValenceRequest>>(std::move(more));
  return plan;
}

std::optional<Plan> fewerFeatures(const AttemptFailure& failure)
{
  if (keepsFeatures(*failure.surface) || isTooLarge(failure.attempt))
  {
    return std::nullopt;
  }
  Plan plan = failure.attempt.plan;
  std::vector<FeatureDrop> drops = dropsAt(failure, failure.places);
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
  if (features.empty())
  {
    return std::nullopt;
  }
  ++plan.featureDrops;
  append(plan.dropped, drops);
  giveUp(features, plan);
  plan.notices.push_back(std::to_string(features.size()) + " sharp edges" +
    nearText(failure.places) +
    " leave no room for quads of this edge length and were not used as features; ask for more "
    "quads for them to be "
    "followed");
  return plan;
}

} // namespace quadrille
