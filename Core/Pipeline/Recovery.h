// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is tried where a map or its quads fail: each strategy makes another plan of the attempts so far, or has nothing
/// to offer.
#pragma once

#include "Pipeline/Attempt.h"
#include "Pipeline/History.h"
#include "Pipeline/Plan.h"

#include <optional>

namespace quadrille
{

/// Another map in this round, before quads are made; none where the last one is good, or another would not be better.
std::optional<Plan> nextMapPlan(RunContext& run, const History& history);

/// Another round; none where the quads are good, or another would not be better. isLast: nothing else follows where
/// there are no quads, so that the last resort is tried, too, whatever the work.
std::optional<Plan> nextPlan(RunContext& run, const History& history, bool isLast = true);

/// Whether the plan is one of those that are made where nothing else is left.
bool isLastResort(const Plan& plan);

} // namespace quadrille
