// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Recovery.h"

#include "Base/Lists.h"
#include "Pipeline/Strategies.h"

#include <algorithm>
#include <array>

namespace quadrille
{
namespace
{

struct Strategy
{
  Try which;
  std::size_t bound; ///< how often, see the function
  std::optional<Plan> (*next)(const AttemptFailure& failure);
};

/// The strategies in the order in which they are asked.
constexpr std::array<Strategy, 1> kForMaps{ {
  { Try::MoreFreedom, 2, moreFreedom },
} };
constexpr std::array<Strategy, 2> kForRounds{ {
  { Try::Counterparts, 1, withCounterparts },
  { Try::FewerFeatures, kMostFeatureDrops, fewerFeatures },
} };

/// Where no round has quads and none of the others is left, or may be tried any more.
constexpr std::array<Strategy, 1> kLastResort{ {
  { Try::MoreQuads, 3, moreQuads },
} };

/// What is wrong with an attempt, in a few words.
std::string whyNotGood(const Attempt& attempt)
{
  const MapAttempt& map = *attempt.map;
  if (map.isInterrupted)
  {
    return "the map took too long";
  }
  if (!map.status.ok())
  {
    return "no valid map of the coarse level";
  }
  if (!attempt.quads->status.ok())
  {
    return "no valid quads";
  }
  return std::to_string(attempt.quads->invertedQuads) + " quads inverted";
}

template <typename Strategies>
std::optional<Plan> firstOffer(const Strategies& strategies, AttemptFailure& failure)
{
  for (const Strategy& strategy : strategies)
  {
    failure.bound = strategy.bound;
    if (std::optional<Plan> plan = strategy.next(failure))
    {
      setStep(*plan, strategy.which);
      plan->why = whyNotGood(failure.attempt);
      return plan;
    }
  }
  return std::nullopt;
}

/// Where a map, or without any quads these, have failed.
std::vector<Vector3> placesOf(const Attempt& attempt, const Mesh& surface)
{
  if (!attempt.map->status.ok())
  {
    return attempt.map->failedPlaces;
  }
  std::vector<Vector3> places = positionsOf(surface, attempt.map->transfer.defectVertices);
  if (attempt.quads && !attempt.quads->status.ok())
  {
    append(places, positionsOf(surface, failedVertices(attempt, surface)));
  }
  return places;
}

/// None where no other round would be better.
std::optional<AttemptFailure> failureOfRound(RunContext& run, const History& history)
{
  const Attempt& attempt = history.last();
  const bool mapped = attempt.map->status.ok();
  const bool hasQuads = attempt.quads && attempt.quads->status.ok();
  if ((!hasQuads && run.hasCrowd) || (mapped && isRounded(run.options.method)) ||
    (hasQuads && !attempt.quads->invertedAtFolds))
  {
    return std::nullopt;
  }
  return AttemptFailure{ run, history, attempt, withPlan(run.surface, attempt.plan),
    placesOf(attempt, run.surface->mesh), !hasQuads, 0 };
}

} // namespace

void setStep(Plan& plan, Try which)
{
  plan.step = tryRow(which).name;
  plan.made.push_back(which);
}

std::optional<Plan> nextMapPlan(RunContext& run, const History& history)
{
  if (history.isSpent())
  {
    return std::nullopt;
  }
  const Attempt& attempt = history.last();
  AttemptFailure failure{ run, history, attempt, withPlan(run.surface, attempt.plan), {}, true, 0 };
  return firstOffer(kForMaps, failure);
}

std::optional<Plan> nextPlan(RunContext& run, const History& history, bool isLast)
{
  std::optional<AttemptFailure> failed = failureOfRound(run, history);
  if (!failed)
  {
    return std::nullopt;
  }
  AttemptFailure& failure = *failed;
  std::optional<Plan> plan;
  if (!history.isSpent())
  {
    plan = firstOffer(kForRounds, failure);
  }
  return plan || !isLast || history.hasResult() ? plan : firstOffer(kLastResort, failure);
}

bool isLastResort(const Plan& plan)
{
  return std::any_of(kLastResort.begin(), kLastResort.end(),
    [&](const Strategy& strategy)
    { return !plan.made.empty() && plan.made.back() == strategy.which; });
}

} // namespace quadrille
