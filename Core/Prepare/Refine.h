// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Refinement where the triangles are too large for the quads that are asked for. Each step keeps the surface's
/// geometry and its sources exact; the storage order is that of the splits.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Surface.h"

namespace quadrille
{

/// Splits edges longer than maximumEdgeLength times the size there, and times triangulationScale() in small components
/// (conforming, at edge midpoints, longest first), and
/// chords: unconstrained edges whose two ends lie on constrained edges, that no decimation could ever
/// repair. Afterwards every face has at most one constrained edge and no chord is left. The geometry
/// does not change: new vertices lie on the old triangles. Long thin triangles can multiply; past
/// about 16 #F + 20 area / maximumEdgeLength^2 faces (160 #F up to four million) the longest edges are
/// split and the rest is left, which `notice` tells. Throws InvalidInput unless maximumEdgeLength is
/// positive and finite. The hash is taken anew. threads: 0: all; the result does not depend on it.
void refineSurface(PreparedSurface& surface, double maximumEdgeLength,
  const ProgressCallback& progress, int threads = 1);

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
