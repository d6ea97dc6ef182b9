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

} // namespace quadrille
