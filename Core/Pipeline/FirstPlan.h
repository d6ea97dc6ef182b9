// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run begins with, and the sizes that loops too short for the quads ask for.
#pragma once

#include "Pipeline/Attempt.h"

#include <vector>

namespace quadrille
{

/// The plan that a run begins with: smaller quads round loops that are too short for three, where that does not take
/// too many. Waiting for the failure that most of them are would cost several maps.
/// RemeshOptions::smallDetails may want it whatever it takes, up to the limit of quads, or never.
Plan firstPlan(RunContext& run);

/// The levels that it begins with, and another beginning, too.
LevelPlan firstLevels(const RunContext& run);

/// Edges of quads become no shorter than this part of s for the sake of a loop.
constexpr double kLeastShrink = 0.1;

/// Whether quads may become smaller, or more, for the sake of loops that are too short for them.
bool mayResolve(const RemeshOptions& options);

/// Whether the first plan had smaller quads round these short loops; true where there is none. most: how many times as
/// many quads they may make, beside the bound that the plan has.
bool resolvesLoops(
  const RunContext& run, const std::vector<HandleLoop>& loops, double most = kInfinity);

} // namespace quadrille
