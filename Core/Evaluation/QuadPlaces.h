// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quads near a place: what is there of what a user asked for.
#pragma once

#include "Extraction/Extraction.h"
#include "Mesh/BoxTree.h"
#include "Mesh/NearestTriangle.h"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace quadrille
{

/// Cosine of the angle between normals on the sides of a thin wall, 120 degrees. Points of a wall's rim have normals a
/// right angle from either side at most, those of its other rim and corners more than 125 degrees.
constexpr double kOtherSide = -0.5;

/// Of places with these normals, unit: what lies on the other side of a thin wall can be nearer in space than what is
/// meant. Zero is on all sides.
inline bool areOnOneSide(const Vector3& a, const Vector3& b)
{
  return a.dot(b) > kOtherSide;
}

/// The side of a thin wall that a place is on.
class QuadSide
{
public:
  /// normal: of the surface at the place; zero: all points are on its side. pointNormals: unit, stay.
  QuadSide(const Vector3& normal, const std::vector<Vector3>& pointNormals)
    : normal_(normal), pointNormals_(pointNormals)
  {
  }
  bool has(Index point) const { return areOnOneSide(normal_, pointNormals_[point]); }

private:
  Vector3 normal_;
  const std::vector<Vector3>& pointNormals_;
};

/// Points of the quads near places, with their valences as they are asked for: on boundaries one more than the edges.
class ReachedValences
{
public:
  /// Here, and below, mesh stays as it is while the object is used.
  explicit ReachedValences(const QuadMesh& mesh);
  /// None where there is no point (of that valence) on the side of that place, see QuadSide.
  std::optional<Index> nearest(const Vector3& p, const QuadSide& side) const;
  std::optional<Index> nearestOf(int valence, const Vector3& p, const QuadSide& side) const;
  int valence(Index point) const
  {
    return mesh_.valence[point] + (mesh_.onBoundary[point] != 0 ? 1 : 0);
  }

private:
  struct Points
  {
    std::vector<Index> ids;
    BoxTree tree;
  };
  std::optional<Index> nearestIn(
    const Points& points, const Vector3& p, const QuadSide& side) const;

  const QuadMesh& mesh_;
  Points all_;
  std::map<int, Points> byValence_; ///< but for the regular ones
};

/// The quad nearest to a place, as two triangles.
class NearestQuads
{
public:
  struct Place
  {
    Index quad = kInvalidIndex;
    Vector3 point = Vector3::Zero();
    /// Of the quads at that of its corners which is nearest to the place, the mean of their edges: where a place is a
    /// vertex of the quads, or on an edge, it does not depend on which of the quads there is taken for the nearest.
    double edgeLength = 0;
    /// Unit tangents of its two families of edges, blended from opposite edges.
    std::array<Vector3, 2> along;
    /// The mean of those of the quad's corners, unit; zero where there is none. So one of them at least is on the side
    /// of the place, also where the quad is inverted.
    Vector3 normal = Vector3::Zero();
  };

  explicit NearestQuads(const QuadMesh& mesh);
  std::optional<Place> at(const Vector3& p) const;
  QuadSide sideOf(const Place& place) const { return { place.normal, pointNormals_ }; }
  /// Of the quad nearest to a place, see Place; zero where there are no quads.
  Vector3 normalAt(const Vector3& p) const;
  QuadSide sideAt(const Vector3& p) const { return { normalAt(p), pointNormals_ }; }
  /// Unit; zero where the quads have no area.
  const Vector3& pointNormal(Index point) const { return pointNormals_[point]; }
  /// Without the mesh.
  std::size_t bytes() const;

private:
  const QuadMesh& mesh_;
  NearestTriangle halves_;              ///< 0 1 2 and 0 2 3 of each quad
  std::vector<double> edgeLengthRound_; ///< #points, see Place
  std::vector<Vector3> pointNormals_;   ///< #points, unit; zero where the quads have no area
};

/// The edge of the quads on a feature or boundary that is nearest to a place.
class NearestLines
{
public:
  explicit NearestLines(const QuadMesh& mesh);
  /// In units of the points; none where there are no such edges.
  std::optional<double> distance(const Vector3& p) const;

private:
  NearestTriangle lines_;
};

} // namespace quadrille
