// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run begins with, and the sizes that loops too short for the quads ask for.
#pragma once

#include "Pipeline/Attempt.h"

#include <limits>
#include <vector>

namespace quadrille
{

/// Where smaller quads make their number grow by more than this factor they may as well be smaller everywhere.
constexpr double kMostGrowth = 1.6;

/// The plan that a run begins with: smaller quads round loops that are too short for three, where that does not take
/// too many. Waiting for the failure that most of them are would cost several maps.
/// RemeshOptions::smallDetails may want it whatever it takes, up to the limit of quads, or never.
Plan firstPlan(RunContext& run);

/// The levels that it begins with, and another beginning, too.
LevelPlan firstLevels(const RunContext& run);

/// Whether the first plan had smaller quads round these short loops; true where there is none. most: how many times as
/// many quads they may make, beside the bound that the plan has.
bool resolvesLoops(const RunContext& run, const std::vector<HandleLoop>& loops,
  double most = std::numeric_limits<double>::infinity());

/// The number of quads that the map of a plan is scaled to. sizedArea: of the surface with the sizes of the plan; not
/// asked without shrinks.
double quadsFor(const RunContext& run, const Plan& plan, double sizedArea);

/// #V, 1 away from the loops: sizes, as multiples of edgeLength, with which four quads fit round each loop, but none
/// below `least`.
std::vector<float> sizesOfLoops(
  const std::vector<HandleLoop>& loops, double edgeLength, double least, Index vertexCount);

} // namespace quadrille
