// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What quarter turns of fans and shifts of jumps cost, in units of "moving a quarter turn by s through
/// a field at rest".
#pragma once

#include "CrossField/TurnRepair.h"

namespace quadrille
{

constexpr double kForbiddenTurn = 1e5; ///< what no map can realize, or a valence beyond 2 and 6

/// The largest number of quarter turns that a fan of so many triangles can carry: each corner stays
/// below half a turn.
int turnLimit(const Fan& fan);

/// Convex in the turns.
/// irregular: what the fan costs on top where it is irregular, >= 0.
double fanCost(const Fan& fan, double natural, int turns, double irregular = 0);

/// The turns of least cost.
int cheapestTurns(const Fan& fan, double natural, double irregular = 0);

/// Growth of the weighted squared residual of topology edge e when its shift goes from `shift` to
/// shift + step (1 or -1).
double shiftCost(const TurnRepairInput& input, std::size_t e, int shift, int step);

} // namespace quadrille
