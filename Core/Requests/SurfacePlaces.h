// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places, edges and paths of a surface as the user handed it in, for what is drawn beside it.
#pragma once

#include "Mesh/BoxTree.h"
#include "Mesh/Surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

struct EdgeUse
{
  Index target = 0;
  Index polygon = 0;
  std::uint8_t bit = 0;
};

/// Edges of the polygons by their start, both directions: CSR.
struct EdgeGraph
{
  std::vector<std::size_t> first;
  std::vector<EdgeUse> uses;
};

EdgeGraph makeEdgeGraph(const SurfaceInput& input);

/// Points from b back to a along edges, by the A* algorithm [Hart, Nilsson, Raphael 1968] with the distance to b; edges
/// cost more the farther they are from the straight segment. Empty: no path. haste: >= 1; the path costs at most so
/// many times what the best one does, and is found the sooner for it [weighted A*, Pohl 1970].
std::vector<Index> findEdgePath(
  const SurfaceInput& input, const EdgeGraph& graph, Index a, Index b, double haste = 1);

/// The mean length of a polygon's edges.
double meanEdge(const SurfaceInput& input, Index polygon);

/// The diagonal of the box round all points.
double diagonalOf(const SurfaceInput& input);

/// Throws InvalidInput, naming the polygon or the point, where offsets or ids are out of range, or a coordinate that a
/// polygon uses is not finite.
void requirePolygons(const SurfaceInput& input);

/// The nearest place on the polygons, and the nearest of the points that they use: an isolated one would be nobody's
/// edge. Of places that are equally near, the one with the lowest id. What a question needs is made with the first one:
/// trees and edges of two million triangles take a tenth of a run. Not for several threads at once.
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

  Index nearestCorner(const Vector3& p) const;
  /// Throws InvalidInput for a point that is not finite.
  Place nearestPlace(const Vector3& p) const;
  const EdgeGraph& edges() const;
  double diagonal() const { return diagonal_; }
  /// An edge from the point has one polygon only.
  bool isOnBoundary(Index point) const;

private:
  std::array<Vector3, 3> triangle(Index i) const;
  void makeCornerTree() const;
  void makeTriangleTree() const;

  const SurfaceInput& input_;
  int threads_;
  double diagonal_ = 0;
  std::vector<std::uint8_t> isUsed_; ///< per point: by a polygon
  mutable int cornerQuestions_ = 0;
  mutable std::vector<Index> corners_;         ///< points that polygons use
  mutable std::vector<Index> trianglePoints_;  ///< empty where all polygons are triangles
  mutable std::vector<Index> trianglePolygon_; ///< the same
  mutable std::optional<BoxTree> cornerTree_, triangleTree_;
  mutable std::optional<EdgeGraph> edges_;
};

} // namespace quadrille
