// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Storage order along a Hilbert curve, so that neighbours on the surface are neighbours in memory.
/// Without it every later stage waits for the memory [Ebke et al. 2016, Section 5.3].
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// Position of a cell of the grid of 2^bits cells an axis on the Hilbert curve [Skilling 2004].
std::uint64_t hilbertKey(std::array<std::uint32_t, 3> cell, int bits);

/// Ids of the points in the order of the curve: entry i is the point that comes i-th. Points of one
/// cell keep their order. Linear; the same for any number of threads.
std::vector<Index> spaceFillingOrder(const std::vector<Vector3>& points, int threads);

/// Orders the vertices along the curve and the faces by their lowest vertex, and permutes all arrays of
/// the surface. Vertices without a face and faces whose first corner is kInvalidIndex go. Twins may be
/// empty.
void orderSurface(PreparedSurface& surface, int threads);

} // namespace quadrille
