// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Points of quads put from the tessellation onto the exact shape.
#pragma once

#include "Base/Types.h"
#include "Cad/Shape.h"
#include "Cad/Tessellation.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

enum class CadPlaceKind : std::uint8_t
{
  None, ///< it stays where it was
  Face,
  Edge,
  Vertex
};

struct CadPlace
{
  CadPlaceKind kind = CadPlaceKind::None;
  Index id = kInvalidIndex; ///< of the face, edge or vertex
  /// Where it is: on the face, on the curve of the edge, the vertex; else the point that was given.
  Vector3 point = Vector3::Zero();
  Index face = kInvalidIndex; ///< the face whose triangle is nearest
  Vector3 normal =
    Vector3::Zero(); ///< of that face there, unit, out of the material; zero where it has none
  std::array<double, 2>
    curvatures{}; ///< the larger and the smaller one, positive where the face bends towards its normal
};

struct PlacementOptions
{
  /// Points that lie farther off the tessellation stay, and so do those that would move farther than four times that;
  /// as part of the diagonal. 0: what the tessellation may lie off the shape.
  double reach = 0;
  /// Points within this of a polyline of an edge are of the edge, as part of the diagonal.
  double onEdge = 1e-7;
  bool tangentEdges = false; ///< whether points on tangent edges are put onto their curves, too
};

/// Each point goes to the nearest place of what it belongs to: the vertex it lies on, else the sharp or free edge whose
/// polyline it lies on, else the face of the nearest triangle. Newton starts at the parameters of the tessellation. A
/// place beyond the border of its face goes onto the nearest edge of that face.
/// surface: of tessellate(shape), with any options. faces: #points, or empty: a face of the part that the point is of;
/// parts that touch lie at one place, and faces of one part hang together. kInvalidIndex, or empty: any part.
std::vector<CadPlace> placeOnShape(const CadShape& shape, const CadSurface& surface,
  const std::vector<Vector3>& points, const PlacementOptions& options = {},
  const std::vector<Index>& faces = {});

} // namespace quadrille
