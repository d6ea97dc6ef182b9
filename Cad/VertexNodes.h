// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Nodes for the vertices of a shape that lie within a smooth line of edges, where quads need none by themselves.
#pragma once

#include "Base/Types.h"
#include "Cad/Placement.h"
#include "Cad/Shape.h"
#include "Cad/Tessellation.h"

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

struct TakenVertices
{
  std::size_t taken = 0; ///< vertices that have a node now
  /// Nodes that made room, on triangles or polylines: they have to be placed again.
  std::vector<Index> beside;
  /// Vertices that have none, at ends of edges longer than two mean sides of quads.
  std::vector<Index> without;
};

/// Of each vertex at an end of a sharp or free edge that has no node: the nearest node on one of its edges goes there,
/// where it is nearer than the mesh is wide, and no quad at it loses more than half of its least sine of a corner.
/// Where one does, the nodes beside it make room, if no quad of theirs loses more than that then.
/// quads: corners as numbers of places.
TakenVertices takeVertices(const CadShape& shape, const CadSurface& surface,
  const std::vector<std::array<Index, 4>>& quads, std::vector<CadPlace>& places);

/// Quads that were good and are turned over by their places have their corners where they were, until there are none.
/// before: the points that were placed.
void keepQuads(const std::vector<std::array<Index, 4>>& quads, const std::vector<Vector3>& before,
  std::vector<CadPlace>& places);

} // namespace quadrille
