// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small holes of a surface, filled.
#pragma once

#include "Details/Handles.h"
#include "Mesh/Surface.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Fills the holes that boundary loops of the surface go round, vertices in the order of the boundary (see
/// measureBoundary). A fan round the mean of a loop's vertices does: of what is smaller than a quad nothing but its
/// topology is seen. Faces of a fan have the sources of the faces that they are joined to (see fillWithFan), and
/// features on a loop go with it. Loops whose fan would have a triangle without area, such as slits, stay open. Returns
/// the entries that were filled, ascending; if there are any, area and hash are made anew, and vertices may have
/// other ids. Linear.
std::vector<std::size_t> fillHoles(PreparedSurface& surface, const std::vector<HandleLoop>& loops);

} // namespace quadrille
