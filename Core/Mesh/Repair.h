// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Validation and repair of the user's surface.
#pragma once

#include "Mesh/EdgeRuns.h"
#include "Mesh/Surface.h"

namespace quadrille
{

/// Throws InvalidInput, naming the element, for empty input, arrays of wrong size, ids out of range and
/// coordinates that are not finite; and as checkRequests does.
void checkInput(const SurfaceInput& input, int threads);

/// Of these, the arrays that stand beside points and polygons: their sizes, and what checkRequests and checkSizing ask.
void checkArrays(const SurfaceInput& input);

/// Makes a surface whose corners are set, and whose vertices and faces are in order, an oriented manifold
/// with twins (`runs` are its edges); counts what it changed, and the components. Linear, and little more than the
/// pairing of half-edges where nothing has to be changed. Throws InvalidInput when a component is not orientable.
void repairSurface(PreparedSurface& surface, EdgeRuns runs, int threads);

} // namespace quadrille
