// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Re-embeds small patches round the triangles that a replay left inverted or degenerate, and round vertices
/// about which the map winds otherwise than it should.
///
/// The unknowns are displacements of the patch's inner vertices, each in the chart of one of its corners and rotated
/// into the charts of the others; so transitions stay exactly as they are, whatever charts, curves or holes the
/// patch has. Inner vertices of curves slide along their isoline; the patch's border, irregular vertices
/// and corners of curves stay. The untangler moves the rest, the result is rounded to the grid and tested
/// exactly, and it is taken only if fewer defects are left.
///
/// Where its energy, which rotations cost nothing, leaves defects, that of the coarse map is tried, with triangles
/// turned as the map round the patch asks for (PatchRotations.h): a cone that would otherwise pass its turns to a
/// neighbour keeps them, and no vertex of a curve slides past the corner that the curve ends in. Triangles weigh one
/// over their squared distance from the nearest vertex that stays, so that those round a cone go along with it to its
/// whole point; those at what defects are left weigh more in the next round, as in FieldUntangling.h.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct MendResult
{
  std::size_t patches = 0;     ///< patches that were improved
  std::size_t notPositive = 0; ///< triangles of the whole mesh with !(det > 0) in the end
  std::vector<Index> defects;  ///< these; if there are none, the faces at vertices of wrong turns
};

/// Changes uv in place. expectedTurns: #V quarter turns round each vertex. Deterministic, for any number of threads
/// (0: all); the work is bounded, so a map that is invalid all over stays so. After one pass over the mesh that
/// finds the defects, the cost is that of the patches.
MendResult mendPatches(const Mesh& mesh, std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, int threads, const ProgressCallback& progress);

} // namespace quadrille
