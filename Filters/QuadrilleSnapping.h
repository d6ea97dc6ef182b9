// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places, edges and paths of a surface as the user handed it in, for what is drawn beside it.
#pragma once

#include "Base/Types.h"
#include "Mesh/Surface.h"

#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>
#include <vtkStaticPointLocator.h>

#include <cstddef>
#include <cstdint>
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

/// Points from b back to a along edges, by Dijkstra's algorithm; edges cost more the farther they are from the straight
/// segment.
/// Empty: no path.
std::vector<Index> findEdgePath(
  const SurfaceInput& input, const EdgeGraph& graph, Index a, Index b);

/// The mean length of a polygon's edges.
double meanEdge(const SurfaceInput& input, Index polygon);

/// The diagonal of the box round all points.
double diagonalOf(const SurfaceInput& input);

/// The nearest place on the polygons, and the nearest of the points that they use: an isolated one would be nobody's
/// edge.
class Snapper
{
public:
  struct Place
  {
    Index polygon = kInvalidIndex;
    Vector3 point = Vector3::Zero();
  };

  explicit Snapper(const SurfaceInput& input);
  Index nearestCorner(const Vector3& p) const;
  /// Throws InvalidInput for a point that is not finite.
  Place nearestPlace(const Vector3& p) const;

private:
  vtkNew<vtkPolyData> polygons_;
  vtkNew<vtkStaticCellLocator> polygonLocator_;
  vtkNew<vtkGenericCell> cell_;
  vtkNew<vtkPolyData> corners_;
  vtkNew<vtkStaticPointLocator> cornerLocator_;
  std::vector<Index> id_;
};

} // namespace quadrille
