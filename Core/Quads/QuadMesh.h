// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quad mesh of an integer-grid map: each point and quad knows its place on the mapped surface.
#pragma once

#include "Base/Lists.h"
#include "Base/Types.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// An edge of the quad mesh that lies on a feature or on the boundary.
struct QuadLine
{
  Index a = 0, b = 0;             ///< quad vertices
  Index halfEdge = kInvalidIndex; ///< a constrained half-edge of the input that it runs along
  bool boundary = false;
};

/// Half-edge 4q + i runs from corner i of quad q to corner i + 1.
inline Index nextInQuad(Index h)
{
  return h % 4 == 3 ? h - 3 : h + 1;
}

struct QuadMesh
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 4>> quads;          ///< counterclockwise like the input's faces
  std::vector<Index> sourceFace;                    ///< per point: face of the mapped mesh
  std::vector<std::array<double, 3>> sourceWeights; ///< per point: barycentric in that face
  std::vector<Index> quadSourceFace; ///< per quad: face of the mapped mesh under its uv centre
  /// Per quad: barycentric of the uv centre in that face, in whatever charts the map has; all zero for a quad that
  /// is no unit square of the map (see HoleFilling.h).
  std::vector<std::array<double, 3>> quadSourceWeights;
  /// Polygon i has the points polygonPoints[polygonOffsets[i]] to polygonPoints[polygonOffsets[i + 1] - 1],
  /// counterclockwise; three, or more than that. Both empty unless BoundaryMode::Polygons makes some.
  std::vector<Index> polygonOffsets, polygonPoints;
  std::vector<Index> polygonSourceFace; ///< per polygon: a face of the mapped mesh in it
  std::vector<int> valence;             ///< per point: number of edges
  std::vector<std::uint8_t> onBoundary; ///< per point
  std::vector<QuadLine> lines;          ///< features and boundary

  /// The points that a half-edge comes from and leads to.
  Index origin(Index h) const { return quads[h / 4][h % 4]; }
  Index target(Index h) const { return origin(nextInQuad(h)); }
};

/// The half-edges that leave each point, and the quads there; ascending.
Grouped<> halfEdgesAtPoints(const std::vector<std::array<Index, 4>>& quads, std::size_t points);
Grouped<> quadsAtPoints(const std::vector<std::array<Index, 4>>& quads, std::size_t points);

inline Index previousInQuad(Index h)
{
  return h % 4 == 0 ? h + 3 : h - 1;
}

inline Index oppositeInQuad(Index h)
{
  return h % 4 < 2 ? h + 2 : h - 2;
}

/// The corner of the mapped mesh that point p lies on exactly; none where it lies on an edge or in a face.
std::optional<Index> meshCorner(const QuadMesh& quads, Index p);

/// Flags of the points of features and on the boundary.
std::vector<std::uint8_t> pointsOnCurves(const QuadMesh& mesh);

/// Takes all other points away, and what is told of their sources; quads and lines are the caller's. Returns the points
/// that those which stay become.
std::vector<Index> keepPoints(QuadMesh& mesh, const std::vector<std::uint8_t>& isKept);

/// Per quad, then per polygon: bit i, of eight, says whether its edge from corner i to i + 1 lies on a feature.
std::vector<std::uint8_t> featureEdgeBits(const QuadMesh& mesh);

} // namespace quadrille
