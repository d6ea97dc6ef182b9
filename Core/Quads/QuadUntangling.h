// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads that are inverted at a corner, or nearly so, mended by moving points over the input surface.
#pragma once

#include "Mesh/Mesh.h"
#include "Quads/QuadMesh.h"

namespace quadrille
{

struct UntanglingOptions
{
  std::vector<Index> fixedVertices; ///< of the mesh, ascending; points on them stay
  int threads = 0;
};

/// Where a map is valid, but a quad of it spans a sharp tip, a crease or a thin part of the surface, the corners of the
/// quad may make it bad in space, or inverted (see QuadShape.h). Points within a ring of bad quads move over the faces
/// of the mesh, those of features and boundaries along their curves (see QuadMoves.h), so that the areas at the corners
/// become positive, the worst ones first. Points round a place keep their moves only if fewer quads are inverted there,
/// or as many and fewer are bad. Nothing changes where no quad is bad, or away from these places. The result does not
/// depend on the number of threads. quads must be a manifold that was extracted from mesh.
/// Returns the number of quads that are inverted after it.
std::size_t untangleQuads(const Mesh& mesh, QuadMesh& quads, const UntanglingOptions& options);

/// What places on the surface cannot mend: where two features touch each other, or are nearer than their quads, one of
/// these is flat or inverted wherever its points lie on them. Points of bad quads and of the ring round them leave the
/// surface and its features by at most 0.15 edge lengths, and 0.3 where quads are inverted still, so that the sines at
/// the corners become positive; those of the boundary and those that are held (see QuadMoves.h) do not. As
/// untangleQuads() otherwise. sourceFace and sourceWeights remain the places that the points have left.
void loosenQuads(const Mesh& mesh, QuadMesh& quads, const UntanglingOptions& options);

} // namespace quadrille
