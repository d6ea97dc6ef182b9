// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The strategies of Recovery, each a function of the attempts so far; see Documentation/Design/Recovery.md.
/// Each says what its bound counts.
#pragma once

#include "Pipeline/Attempt.h"
#include "Pipeline/History.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

/// How often features are given up for quads that are inverted.
constexpr std::size_t kMostFeatureDrops = 4;

/// What there is to mend: an attempt without quads, or with some that are inverted at folds of its map.
struct AttemptFailure
{
  RunContext& run;
  const History& history;
  const Attempt& attempt;      ///< of the round
  PlannedSurface surface;      ///< by its plan
  std::vector<Vector3> places; ///< where the map or its quads failed
  bool withoutQuads = true;    ///< else some of them are inverted
  std::size_t bound = 0;       ///< of the strategy that is asked
};

// For another map of the same round.

/// Where the coarse map fails: keeps the intermediate vertices near those that it failed at, and raises the budget by
/// their number, at least by a quarter. Where the coarse level has all of the intermediate one already, both get about
/// twice as many. Where faces can be filled instead, once, and for a few vertices. Bound: times in a round.
std::optional<Plan> moreFreedom(const AttemptFailure& failure);

// For another round.

/// Irregular vertices that were asked for near the places of a failure get counterparts (see Requests/Counterparts.h).
/// Not where the others are asked for as well. Bound: times in all.
std::optional<Plan> withCounterparts(const AttemptFailure& failure);

/// Detected features near the places of a failure are given up, twice as far as the last time where a place fails
/// again, and after a failure so far that there are some. Not where features stay, see keepsFeatures. Bound: times in
/// all, for quads that are inverted.
std::optional<Plan> fewerFeatures(const AttemptFailure& failure);

/// Where nothing else has led to quads, and those of a valid map touch themselves, as round a thin part: twice as many
/// everywhere; where small details are to be resolved, at once as many as go three times round the shortest loop,
/// unless their edges were shorter than kLeastShrink. Bound: doublings.
std::optional<Plan> moreQuads(const AttemptFailure& failure);

/// Calls the plan by what has made it.
void setStep(Plan& plan, Try which);

/// Whether a limit of the user stands in the way.
bool isTooLarge(const Attempt& attempt);

} // namespace quadrille
