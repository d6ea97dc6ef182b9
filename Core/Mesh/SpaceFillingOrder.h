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

/// The same for a surface that was in order before it was changed at few places: the last faces and vertices take the
/// places of those that go, and what was added stays where it is. Nothing else moves.
void compactSurface(PreparedSurface& surface, int threads);

/// The one or the other, by the number of places where the surface was changed: few of a large one need no new order.
void orderAfterChanges(PreparedSurface& surface, std::size_t places, int threads);

} // namespace quadrille
