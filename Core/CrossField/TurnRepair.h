// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Makes the quarter turns of all fans realizable and few by an exact min-cost flow on the primal edges.
#pragma once

#include "CrossField/FieldTopology.h"
#include "CrossField/TurnPrescription.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct TurnRepairInput
{
  const FieldTopology* topology = nullptr;
  const std::vector<double>* residual = nullptr; ///< per topology edge, radians, of edges[i][0]
  const std::vector<int>* turns = nullptr;       ///< per fan, now
  const std::vector<double>* natural = nullptr;  ///< per fan, see naturalTurns
  double length =
    0; ///< s: a pair of opposite irregular vertices closer than about this is cancelled
  const TurnPrescription* prescription = nullptr; ///< none: all fans are free
  /// Per topology edge, null or empty: what the cost of its shifts is multiplied with (guided regions).
  const std::vector<double>* stiffness = nullptr;
  /// Per fan, null or empty: what it costs on top where it is irregular.
  const std::vector<double>* irregular = nullptr;

  double costOfIrregular(std::size_t fan) const
  {
    return irregular && !irregular->empty() ? (*irregular)[fan] : 0.0;
  }
};

struct TurnRepairResult
{
  std::vector<int> shift; ///< per topology edge: what to add to the period jump of edges[i][0]
  std::vector<int> turns; ///< per fan, afterwards
  bool complete = true;   ///< false: some fan could not get the turns that are prescribed
};

/// Minimizes, over integer shifts of the period jumps, the growth of the squared residuals (weighted by
/// edge length / s) plus a convex cost of each fan's turns. One shift moves a quarter turn from the fan that
/// edges[i][0] points to, to the one it leaves. Prescribed sums are met exactly.
TurnRepairResult repairTurns(const TurnRepairInput& input);

/// Afterwards moves single turns, as cheaply as it can, until an angle structure exists or no move helps; never from or
/// to fans with a prescription. Returns
/// the fans that stay in the way (#fans flags), empty on success.
std::vector<std::uint8_t> completeTurns(
  const Mesh& mesh, const TurnRepairInput& input, TurnRepairResult& result);

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
