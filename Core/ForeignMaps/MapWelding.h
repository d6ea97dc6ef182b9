// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connectivity of a mapped surface whose points are doubled where the map is cut, as point texture
/// coordinates demand, or at every corner, as readers of OBJ files do it.
#pragma once

#include "Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace quadrille
{

/// Triangles whose points may be doubled.
struct MappedTriangles
{
  std::vector<Index> corners;    ///< #H points
  std::vector<Vector3> position; ///< #points
  std::vector<Vector2> uv;       ///< #H
  /// Whether two points at the same place agree in all of their data. Then nothing asked for two
  /// points but that they are different vertices. Empty: never.
  std::function<bool(Index, Index)> sameData;
};

/// Joins triangles over edges whose ends lie at exactly the same places; a vertex is what can be
/// reached through such edges, so that fans that merely touch in a point stay apart. What is told
/// apart:
/// - two triangles that share both points of an edge are joined before all others;
/// - copies of an edge that differ in no data at either end are two edges (a slit), unless no point
///   belongs to two triangles: then the file has no vertices at all, and places are all there is;
/// - where more than two triangles meet at an edge, those with equal uv belong together, and of the
///   rest those whose images a quarter turn and a whole translation takes to each other.
/// Flags are 0. Linear. Throws InvalidInput, naming cells, for a corner out of range, a position
/// that is not finite, a triangle with two corners at one place, neighbours that are not oriented
/// alike, and edges of which nothing tells which triangles belong together.
Mesh weldMap(const MappedTriangles& triangles);

} // namespace quadrille
