// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleSnapping.h"

#include "Mesh/Distance.h"

#include "Base/PlaceText.h"
#include "QuadrilleRefuse.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

namespace quadrille
{

namespace
{

/// A path may be this many times longer than needed rather than leave the segment by its own length.
constexpr double kDetourPenalty = 10;

template <class Visit>
void forEachEdge(const SurfaceInput& input, Visit visit)
{
  for (std::size_t p = 0; p + 1 < input.polygonOffsets.size(); ++p)
  {
    const Index begin = input.polygonOffsets[p];
    const Index corners = input.polygonOffsets[p + 1] - begin;
    for (Index i = 0; i < corners && i < 8; ++i) // eight bits a polygon
    {
      visit(static_cast<Index>(p), i, input.polygonPoints[begin + i],
        input.polygonPoints[begin + (i + 1) % corners]);
    }
  }
}

} // namespace

EdgeGraph makeEdgeGraph(const SurfaceInput& input)
{
  EdgeGraph graph;
  graph.first.assign(input.points.size() + 2, 0);
  forEachEdge(input,
    [&](Index, Index, Index a, Index b)
    {
      ++graph.first[a + 2];
      ++graph.first[b + 2];
    });
  for (std::size_t i = 2; i < graph.first.size(); ++i)
  {
    graph.first[i] += graph.first[i - 1];
  }
  graph.uses.resize(graph.first.back());
  forEachEdge(input,
    [&](Index p, Index i, Index a, Index b)
    {
      const auto bit = static_cast<std::uint8_t>(1 << i);
      graph.uses[graph.first[a + 1]++] = { b, p, bit };
      graph.uses[graph.first[b + 1]++] = { a, p, bit };
    });
  return graph;
}
std::vector<Index> findEdgePath(const SurfaceInput& input, const EdgeGraph& graph, Index a, Index b)
{
  struct Reached
  {
    double cost;
    Index from;
  };
  using Entry = std::pair<double, Index>;
  std::unordered_map<Index, Reached> reached; // only looked up, so its order does not matter
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const Vector3& start = input.points[a];
  const Vector3& end = input.points[b];
  const double scale = kDetourPenalty / std::max((end - start).norm(), 1e-300);
  reached[a] = { 0, a };
  front.push({ 0, a });
  while (!front.empty() && front.top().second != b)
  {
    const auto [cost, v] = front.top();
    front.pop();
    if (cost > reached[v].cost)
    {
      continue;
    }
    for (std::size_t i = graph.first[v]; i < graph.first[v + 1]; ++i)
    {
      const Index w = graph.uses[i].target;
      const Vector3& p = input.points[v];
      const Vector3& q = input.points[w];
      const double away = distanceToSegment(0.5 * (p + q), start, end);
      const double next = cost + (q - p).norm() * (1 + scale * away);
      const auto found = reached.find(w);
      if (found == reached.end() || next < found->second.cost)
      {
        reached[w] = { next, v };
        front.push({ next, w });
      }
    }
  }
  std::vector<Index> path;
  if (!front.empty())
  {
    for (Index v = b; v != a; v = reached[v].from)
    {
      path.push_back(v);
    }
    path.push_back(a);
  }
  return path;
}
double meanEdge(const SurfaceInput& input, Index polygon)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index corners = input.polygonOffsets[polygon + 1] - begin;
  double sum = 0;
  for (Index i = 0; i < corners; ++i)
  {
    sum += (input.points[input.polygonPoints[begin + i]] -
      input.points[input.polygonPoints[begin + (i + 1) % corners]])
             .norm();
  }
  return sum / std::max<Index>(corners, 1);
}

double diagonalOf(const SurfaceInput& input)
{
  if (input.points.empty())
  {
    return 0;
  }
  Vector3 low = input.points.front();
  Vector3 high = low;
  for (const Vector3& p : input.points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}
Snapper::Snapper(const SurfaceInput& input)
{
  std::vector<std::uint8_t> used(input.points.size(), 0);
  for (const Index p : input.polygonPoints)
  {
    used[p] = 1;
  }
  vtkNew<vtkPoints> all;
  vtkNew<vtkPoints> corners;
  all->SetDataTypeToDouble();
  corners->SetDataTypeToDouble();
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    all->InsertNextPoint(input.points[i].data());
    if (used[i])
    {
      corners->InsertNextPoint(input.points[i].data());
      id_.push_back(static_cast<Index>(i));
    }
  }
  vtkNew<vtkCellArray> polygons;
  for (std::size_t p = 0; p + 1 < input.polygonOffsets.size(); ++p)
  {
    polygons->InsertNextCell(
      static_cast<int>(input.polygonOffsets[p + 1] - input.polygonOffsets[p]));
    for (Index i = input.polygonOffsets[p]; i < input.polygonOffsets[p + 1]; ++i)
    {
      polygons->InsertCellPoint(input.polygonPoints[i]);
    }
  }
  polygons_->SetPoints(all);
  polygons_->SetPolys(polygons);
  polygonLocator_->SetDataSet(polygons_);
  polygonLocator_->BuildLocator();
  corners_->SetPoints(corners);
  cornerLocator_->SetDataSet(corners_);
  cornerLocator_->BuildLocator();
}

Index Snapper::nearestCorner(const Vector3& p) const
{
  return id_[static_cast<std::size_t>(cornerLocator_->FindClosestPoint(p.data()))];
}

Snapper::Place Snapper::nearestPlace(const Vector3& p) const
{
  Place place;
  vtkIdType cell = -1;
  int part = 0;
  double distance2 = 0;
  polygonLocator_->FindClosestPoint(p.data(), place.point.data(), cell_, cell, part, distance2);
  if (cell < 0)
  {
    refuse("no place on the surface was found for the point ", placeText(p));
  }
  place.polygon = static_cast<Index>(cell);
  return place;
}

} // namespace quadrille
