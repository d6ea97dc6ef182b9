// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Triangles of an exact shape, with what they know of it.
#pragma once

#include "Base/Types.h"
#include "Cad/Shape.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

enum class CadEdgeKind : std::uint8_t
{
  Sharp,   ///< its faces meet at an angle, or they are three or more
  Tangent, ///< its two faces go on into each other
  Seam,    ///< where one face closes, as along a cylinder
  Free,    ///< of one face
  Pole,    ///< without length, where a face is drawn together to a point
  Wire     ///< of no face
};

enum class CadSurfaceKind : std::uint8_t
{
  Plane,
  Cylinder,
  Cone,
  Sphere,
  Torus,
  Bezier,
  Spline,
  Revolution,
  Extrusion,
  Offset,
  Other
};

const char* wordOf(CadEdgeKind kind);
const char* wordOf(CadSurfaceKind kind);

struct CadEdge
{
  CadEdgeKind kind = CadEdgeKind::Wire;
  /// The largest angle between the normals of its two faces along it, in [0, pi]; 0 where it has not two.
  double angle = 0;
  std::vector<Index> points; ///< in their order along the curve; a closed one ends where it begins
  std::vector<double> parameters; ///< #points, of its curve; ascending
  /// #points - 1, or empty: the largest curvature of the curve between two of them, 1 over the unit of the shape.
  std::vector<float> curvatures;
};

struct TessellationOptions
{
  /// By how much triangles and polylines may lie off the shape, as part of its diagonal, in [1e-6, 0.1].
  double chordError = 0.0005;
  /// By how much the direction may change from one segment to the next one, radians in [0.01, 1.5].
  double angle = 0.35;
  /// Edges whose faces meet at a larger angle are sharp, radians in (0, pi).
  double sharpAngle = 0.0873;
};

/// Watertight wherever the shape is: there is one point a vertex, and faces that share an edge share its points.
struct CadSurface
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> triangles; ///< turned as the faces of the shape are
  std::vector<Index> faceOf;                   ///< #triangles; id of a face
  std::vector<std::array<Vector2, 3>>
    parameters; ///< #triangles; of the corners, on the surface of the face
  /// #triangles, or empty: the largest absolute normal curvature of the face at the corners, 1 over the unit of the
  /// shape; NaN where it has none.
  std::vector<std::array<float, 3>> curvatures;
  std::vector<CadEdge> edges;               ///< by id
  std::vector<Index> vertexPoints;          ///< by id; kInvalidIndex where no face has it
  std::vector<CadSurfaceKind> surfaceKinds; ///< by id of the face
  double chordError = 0;                    ///< that was asked for, in the unit of the shape
  std::vector<std::string> notices;         ///< faces without triangles, edges that do not fit
};

/// Without curvatures. Throws InvalidInput where no face has triangles, and where an option is out of its range.
CadSurface tessellate(const CadShape& shape, const TessellationOptions& options = {});

} // namespace quadrille
