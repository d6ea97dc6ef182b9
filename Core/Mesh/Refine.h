// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The steps of refineSurface. Each keeps the surface's geometry and its sources exact; the storage
/// order is that of the splits.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Halves the longest edge of the surface, in sizes, until none is longer than maximumLength, as in longest-edge
/// bisection [Rivara 1984], with the whole surface as one queue: the edge is then the longest of both of
/// its faces and the smallest angle at most halves. Ends early at mostFaces; false then.
bool splitLongEdges(PreparedSurface& surface, double maximumLength, std::size_t mostFaces,
  const ProgressCallback& progress, int threads = 1);

/// Gives faces with three constrained edges a vertex inside.
void splitEnclosedFaces(PreparedSurface& surface);

/// Halves each unconstrained edge whose two ends lie on constrained edges. Every face has at most one
/// constrained edge afterwards, if none had three.
void splitChords(PreparedSurface& surface);

} // namespace quadrille
