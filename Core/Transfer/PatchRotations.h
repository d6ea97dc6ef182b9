// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How a map turns the triangles of a small patch, where it has no valid one yet.
///
/// Next to an irregular vertex the energy of a map without orientation has minima in which the triangles wind once less
/// round it, one of them inverted, and no path of descent leads out. What the coarse map has for this, a field that its
/// triangles follow, is made here from what is known: the map round the patch and the rotations of its transitions. The
/// smoothest field of directions between them [the complex Laplacian of Knoeppel et al. 2013, of first power, since the
/// transitions tell quarter turns apart] has no winding that these do not ask for.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Radians, one per face of `patch` (ascending ids): by how much a map that follows those of the faces round the patch
/// turns the face, laid out in the plane with its first edge along x. uv: #H; inPatch: #F flags of the patch. Empty
/// where no valid triangle is next to the patch, or the equations have no solution.
std::vector<double> patchRotations(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<Index>& patch, const std::vector<std::uint8_t>& inPatch);

/// Direction of half-edge h in the plane that its face is laid out in, radians.
double directionOf(const Mesh& mesh, Index h);

} // namespace quadrille
