// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Recovery.h"

#include "Pipeline/Strategies.h"

#include <array>

namespace quadrille
{
namespace
{

struct Strategy
{
  const char* name;
  std::size_t bound; ///< how often, see the function
  std::optional<Plan> (*next)(const Trouble& trouble);
};

/// The strategies in the order in which they are asked.
constexpr std::array<Strategy, 3> kForMaps{ {
  { "more freedom", 2, moreFreedom },
  { "room for curves", 1, roomForCurves },
  { "kept offenders", 2, keptOffenders },
} };
constexpr std::array<Strategy, 4> kForRounds{ {
  { "smaller quads near", 4, smallerQuadsNear },
  { "more quads", 3, moreQuads },
  { kFewerBorders, kMostBorderDrops, fewerBorders },
  { "fewer features", kMostFeatureDrops, fewerFeatures },
} };

/// Where no round has quads and none of the others is left, or may be tried any more.
constexpr std::array<Strategy, 2> kLastResort{ {
  { kNoFeatures, 1, noFeatures },
  { kNoBorders, 2, noBorders },
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
  if (attempt.quads && !attempt.quads->status.ok())
  {
    return "no valid quads";
  }
  if (attempt.quads)
  {
    return std::to_string(attempt.quads->invertedQuads) + " quads inverted";
  }
  return map.defects() > 0 ? std::to_string(map.defects()) + " defects of the map"
                           : "curves that are not met";
}

template <typename Strategies>
std::optional<Plan> firstOffer(const Strategies& strategies, Trouble& trouble)
{
  for (const Strategy& strategy : strategies)
  {
    trouble.bound = strategy.bound;
    if (std::optional<Plan> plan = strategy.next(trouble))
    {
      plan->step = strategy.name;
      plan->why = whyNotGood(trouble.attempt);
      return plan;
    }
  }
  return std::nullopt;
}

} // namespace

std::optional<Plan> nextMapPlan(RunContext& run, const History& history)
{
  if (history.isSpent())
  {
    return std::nullopt;
  }
  Trouble trouble{ run, history, history.last(), {}, true, {}, 0 };
  return firstOffer(kForMaps, trouble);
}

std::optional<Plan> nextPlan(RunContext& run, const History& history, bool isLast)
{
  const Attempt& attempt = history.last();
  const bool mapped = attempt.map->status.ok();
  const bool hasQuads = attempt.quads && attempt.quads->status.ok();
  if ((!hasQuads && run.hasCrowd) || (mapped && isRounded(run.options.method)) ||
    (hasQuads && !attempt.quads->invertedAtFolds))
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
  std::optional<Plan> plan;
  if (!history.isSpent())
  {
    plan = firstOffer(kForRounds, trouble);
  }
  return plan || !isLast || history.hasResult() ? plan : firstOffer(kLastResort, trouble);
}

std::vector<std::string> recoverySteps()
{
  std::vector<std::string> names;
  names.reserve(kForMaps.size() + kForRounds.size());
  for (const Strategy& strategy : kForMaps)
  {
    names.emplace_back(strategy.name);
  }
  for (const Strategy& strategy : kForRounds)
  {
    names.emplace_back(strategy.name);
  }
  for (const Strategy& strategy : kLastResort)
  {
    names.emplace_back(strategy.name);
  }
  return names;
}

} // namespace quadrille
