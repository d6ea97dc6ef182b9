// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Nodes of quads put onto the exact shape, with all that keeps the quads good.
#pragma once

#include "Cad/Placement.h"

#include <array>
#include <vector>

namespace quadrille
{

struct CadQuads
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 4>> corners; ///< of elements of second order those at the corners
  bool isFirstOrder = true;                  ///< else no node moves along an edge to a vertex
  /// #points, or empty: a face of the part that the point is of, see placeOnShape.
  std::vector<Index> faces;
};

struct PlacedQuads
{
  std::vector<CadPlace> places; ///< #points
  /// Of quads of first order: vertices at ends of sharp or free edges that no node is on, and where they are.
  std::vector<Index> verticesWithout;
  std::vector<Vector3> verticesWithoutAt;
};

/// See placeOnShape, takeVertices and keepQuads. tessellation: that of the triangles which the quads were made on.
PlacedQuads placeQuads(const CadShape& shape, const TessellationOptions& tessellation,
  const CadQuads& quads, const PlacementOptions& options);

} // namespace quadrille
