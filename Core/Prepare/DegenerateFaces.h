// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Faces without area go, and no hole opens.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// True when the area is zero within the rounding of the coordinates, so that no normal exists.
bool isDegenerate(const Mesh& mesh, Index f);

/// Removes faces without area from a manifold: a short edge is collapsed, else the longest edge is
/// flipped towards the neighbour (longest first, so that rows of such faces end), else the face is cut
/// off at the boundary. Returns their number. Afterwards vertices may have several fans.
std::size_t removeDegenerateFaces(PreparedSurface& surface, int threads);

/// Flips the longest edges of caps, faces one of whose vertices is as good as on the opposite edge: nearer to it than a
/// thousandth of its length and a ten-thousandth of the diagonal of the bounding box. Where solids were joined, or cut
/// off from each other, such faces fill cracks: they stand across the faces on both sides, so that each of their edges
/// would be a sharp one, with no room for quads between. Caps whose flip makes faces as flat, or turns the face beyond
/// by more than six degrees, stay: there the vertex is not on the edge. surface: with the diagonal of its box. Returns
/// the number of flips.
std::size_t flipCaps(PreparedSurface& surface, int threads);

} // namespace quadrille
