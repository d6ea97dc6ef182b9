// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Turns per fan from period jumps [Bommes et al. 2009]: turns change by whole numbers only, exactly as the jumps do.
///
/// jump[h] is the period jump of half-edge h, the matching before it is taken modulo 4: antisymmetric, residual =
/// angle[f] + transport - angle[g] - jump pi/2. Going counterclockwise round a fan one crosses half-edges that point to
/// its vertex, and
///   turns = (angle sum + sum of residuals + start - end) / (pi/2),
/// start, end: how far the constrained half-edges deviate from the axis of their alignment (zero for a whole ring).
#pragma once

#include "CrossField/CrossField.h"
#include "CrossField/FieldTopology.h"
#include "CrossField/PowerField.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Nearest period jumps for the angles (#H, 0 across constrained edges).
std::vector<int> roundJumps(
  const Mesh& mesh, const FieldTopology& topology, const std::vector<double>& angle);

/// Quarter turns of each fan.
std::vector<int> countTurns(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<double>& angle,
  const std::vector<int>& jump);

/// Quarter turns that the surface itself makes in each fan (a real number). The angle that a sector
/// adds to its border curve counts only as far as the curve, seen over `window` to either side, turns the
/// same way: noise that turns left and right again within the window is straight. A sharp angle always counts.
std::vector<double> naturalTurns(const FieldTopology& topology, double window);

} // namespace quadrille
