// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/TurnCosts.h"

#include "Base/Angles.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

constexpr double kIrregular = 1.0;   // an irregular vertex: a pair closer than about 2 s vanishes
constexpr double kCostOfBend = 0.25; // a sector that is not straight
constexpr double kUnnatural = 2.0;   // squared difference of a sector's turns to the natural ones
constexpr double kCone = 0.1;        // the same inside; weak, because scans are full of small cones
constexpr double kRare = 1e3;        // valence 2 and 6

} // namespace

int turnLimit(const Fan& fan)
{
  return 2 * static_cast<int>(fan.corners) - 1;
}

double fanCost(const Fan& fan, double natural, int turns, double irregular)
{
  const int limit = turnLimit(fan);
  double cost = kForbiddenTurn * (std::max(0, 1 - turns) + std::max(0, turns - limit));
  if (fan.sector)
  {
    return cost + kUnnatural * (turns - natural) * (turns - natural) +
      kCostOfBend * std::abs(turns - 2);
  }
  const int away = std::abs(turns - 4);
  cost += kCone * (turns - natural) * (turns - natural) +
    (kIrregular + irregular) * std::min(away, 1) + kRare * std::max(away - 1, 0);
  return cost + kForbiddenTurn * std::max(away - 2, 0);
}

int cheapestTurns(const Fan& fan, double natural, double irregular)
{
  int best = fan.sector ? 2 : 4;
  for (const int step : { 1, -1 })
  {
    while (fanCost(fan, natural, best + step, irregular) < fanCost(fan, natural, best, irregular))
    {
      best += step;
    }
  }
  return best;
}

double shiftCost(const TurnRepairInput& input, std::size_t e, int shift, int step)
{
  const bool stiff = input.stiffness != nullptr && !input.stiffness->empty();
  const double weight = input.topology->edgeLength[input.topology->edges[e][0]] / input.length *
    (stiff ? (*input.stiffness)[e] : 1.0);
  const double residual = (*input.residual)[e] / kRightAngle;
  // (residual - shift - step)^2 - (residual - shift)^2
  return weight * (1 - 2 * step * (residual - shift));
}

} // namespace quadrille
