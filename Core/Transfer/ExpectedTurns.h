// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a map of the finest level has to turn round each vertex, from what its map of the coarse level does.
#pragma once

#include "Hierarchy/Hierarchy.h"

#include <vector>

namespace quadrille
{

/// Quarter turns, #V of `fine`: those of the coarse level at its vertices (coarseTurns: #V of coarse.mesh); the
/// vertices that the decimation removed are regular.
std::vector<int> expectedTurns(
  const Mesh& fine, const Level& coarse, const std::vector<int>& coarseTurns);

} // namespace quadrille
