// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the quarter turns of each fan should be: the geometry's own wish, free of zigzag.
#pragma once

#include "CrossField/FieldTopology.h"

#include <vector>

namespace quadrille
{

/// Quarter turns that the surface itself makes in each fan (a real number). The angle that a sector
/// adds to its border curve counts only as far as the curve, seen over `window` to either side, turns the
/// same way: noise that turns left and right again within the window is straight. A sharp angle always counts.
std::vector<double> naturalTurns(const FieldTopology& topology, double window);

} // namespace quadrille
