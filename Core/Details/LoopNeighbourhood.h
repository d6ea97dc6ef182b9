// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The part of a surface where short loops run, so that a search for them need not look at millions of triangles.
///
/// A loop bounds if it is the edge of some faces. Of those outside of the part, all of a connected piece belong to them
/// or none. So whether loops inside bound, and whether they do together, stays what it is when each piece outside gives
/// way to the simplest one with the same edges: a sphere with a hole for each of them.
#pragma once

#include "Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace quadrille
{

struct LoopNeighbourhood
{
  Mesh mesh;                 ///< closed; the part, then what stands for the rest
  std::vector<Index> vertex; ///< of the part, ascending: the id on the surface
  std::vector<Index> face;   ///< of the part, ascending: the id on the surface

  /// On the surface; h: of the part.
  Index halfEdge(Index h) const { return 3 * face[h / 3] + h % 3; }
};

/// The part has all faces at the vertices that paths from one of the roots reach whose points lie no further from it
/// than `radius`. None where the surface has sizes, where the part meets its boundary, or where it is no small part.
/// The mesh passes validate(). threads: 0: all.
std::optional<LoopNeighbourhood> loopNeighbourhood(
  const Mesh& mesh, const std::vector<Index>& roots, double radius, int threads);

} // namespace quadrille
