// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Faces on the same three vertices.
#pragma once

#include "Mesh/EdgeRuns.h"
#include "Mesh/Surface.h"

namespace quadrille
{

/// Removes surplus faces on the same three vertices and returns how many. One of each orientation may be
/// left, and of such a pair one stays, except in two cases. A wall between two solids that touch stays
/// whole, because removing one side would open a solid; it ends only at edges where both solids go on.
/// A small flap on a sheet that is complete without it goes whole.
std::size_t removeDuplicateFaces(PreparedSurface& surface, const EdgeRuns& runs);

} // namespace quadrille
