// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places of a surface as the user handed it in, for what is drawn beside it.
#pragma once

#include "Mesh/BoxTree.h"
#include "Mesh/Surface.h"

#include <array>
#include <optional>
#include <vector>

namespace quadrille
{

/// The mean length of a polygon's edges.
double meanEdge(const SurfaceInput& input, Index polygon);

/// The diagonal of the box round all points.
double diagonalOf(const std::vector<Vector3>& points);

/// The sum over all polygons, whatever their corners are in.
double areaOfPolygons(const SurfaceInput& input);

/// Throws InvalidInput, naming the polygon or the point, where offsets or ids are out of range, or a coordinate that a
/// polygon uses is not finite.
void requirePolygons(const SurfaceInput& input);

/// The nearest place on the polygons; of places that are equally near, that on the polygon with the lowest id. The
/// first questions look at all triangles, further ones make a tree: that of two million triangles takes a tenth of a
/// run. Not for several threads at once.
class SurfacePlaces
{
public:
  struct Place
  {
    Index polygon = kInvalidIndex;
    Vector3 point = Vector3::Zero();
  };

  /// input: has a polygon with corners, and its points and polygons stay as they are while this is used. Throws as
  /// requirePolygons does.
  explicit SurfacePlaces(const SurfaceInput& input, int threads = 1);

  /// A point that lies on the surface up to rounding stays as it is. Throws InvalidInput for one that is not finite.
  Place nearestPlace(const Vector3& p) const;
  double diagonal() const { return diagonal_; }
  /// It lies on an edge that one polygon only has, up to rounding; points at one place count as one.
  bool isOnBoundary(const Place& place) const;

private:
  std::array<Vector3, 3> triangle(Index i) const;
  Index triangleCount() const;
  void makeTriangles() const;
  Index nearestOfAll(const Vector3& p) const;
  void makeTriangleTree() const;

  const SurfaceInput& input_;
  int threads_;
  double diagonal_ = 0;
  mutable std::vector<Index> trianglePoints_;  ///< empty where all polygons are triangles
  mutable std::vector<Index> trianglePolygon_; ///< the same
  mutable bool hasTriangles_ = false;          ///< these two are made, if they are needed
  mutable int questions_ = 0;
  mutable std::optional<BoxTree> triangleTree_;
};

} // namespace quadrille
