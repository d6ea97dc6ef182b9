// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/SurfacePlaces.h"

#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Mesh/Triangulate.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <string>
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

std::vector<Index> findEdgePath(
  const SurfaceInput& input, const EdgeGraph& graph, Index a, Index b, double haste)
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
  const auto awayOf = [&](Index v) { return distanceToSegment(input.points[v], start, end); };
  // A way back to the segment is as long as it is far, and what it costs beside it is the integral of the distance.
  const auto atLeast = [&](double cost, Index v)
  {
    const double away = awayOf(v);
    return cost + haste * ((input.points[v] - end).norm() + 0.5 * scale * away * away);
  };
  reached[a] = { 0, a };
  front.push({ atLeast(0, a), a });
  while (!front.empty() && front.top().second != b)
  {
    const auto [whole, v] = front.top();
    front.pop();
    const double cost = reached[v].cost;
    if (whole > atLeast(cost, v))
    {
      continue;
    }
    const double awayHere = awayOf(v);
    for (std::size_t i = graph.first[v]; i < graph.first[v + 1]; ++i)
    {
      const Index w = graph.uses[i].target;
      const double length = (input.points[w] - input.points[v]).norm();
      const double next = cost + length * (1 + 0.5 * scale * (awayHere + awayOf(w)));
      const auto found = reached.find(w);
      if (found == reached.end() || next < found->second.cost)
      {
        reached[w] = { next, v };
        front.push({ atLeast(next, w), w });
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

void requirePolygons(const SurfaceInput& input)
{
  const auto fail = [](const std::string& text) { throw InvalidInput(text + "."); };
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    if (input.polygonOffsets[i] > input.polygonOffsets[i + 1])
    {
      fail("polygon " + std::to_string(i) + " ends before it begins");
    }
  }
  if (!input.polygonOffsets.empty() && input.polygonOffsets.back() > input.polygonPoints.size())
  {
    fail("the polygons have " + std::to_string(input.polygonOffsets.back()) +
      " corners, but only " + std::to_string(input.polygonPoints.size()) + " are given");
  }
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    pollNowAndThen(i);
    for (Index k = input.polygonOffsets[i]; k < input.polygonOffsets[i + 1]; ++k)
    {
      const Index p = input.polygonPoints[k];
      if (p >= input.points.size())
      {
        fail("polygon " + std::to_string(i) + " has the point " + std::to_string(p) +
          ", but there are only " + std::to_string(input.points.size()));
      }
      if (!input.points[p].allFinite())
      {
        fail("point " + std::to_string(p) + " has a coordinate that is not finite");
      }
    }
  }
}

SurfacePlaces::SurfacePlaces(const SurfaceInput& input, int threads)
  : input_(input), threads_(threads), diagonal_(diagonalOf(input)), isUsed_(input.points.size(), 0)
{
  requirePolygons(input);
  for (const Index p : input.polygonPoints)
  {
    isUsed_[p] = 1;
  }
}

void SurfacePlaces::makeCornerTree() const
{
  std::vector<BoxTree::Box> boxes;
  for (std::size_t i = 0; i < isUsed_.size(); ++i)
  {
    if (isUsed_[i] != 0)
    {
      corners_.push_back(static_cast<Index>(i));
      boxes.push_back({ input_.points[i], input_.points[i] });
    }
  }
  cornerTree_.emplace(boxes, threads_);
}

void SurfacePlaces::makeTriangleTree() const
{
  bool onlyTriangles = true;
  for (std::size_t i = 0; i + 1 < input_.polygonOffsets.size(); ++i)
  {
    onlyTriangles &= input_.polygonOffsets[i + 1] - input_.polygonOffsets[i] == 3;
  }
  if (!onlyTriangles)
  {
    PreparedSurface triangles;
    triangulate(input_, triangles);
    trianglePoints_ = triangles.mesh.origin.take();
    trianglePolygon_ = triangles.sourcePolygon.take();
  }
  std::vector<BoxTree::Box> boxes(
    (onlyTriangles ? input_.polygonPoints.size() : trianglePoints_.size()) / 3);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    pollNowAndThen(i);
    const std::array<Vector3, 3> corner = triangle(static_cast<Index>(i));
    boxes[i] = { corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
      corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) };
  }
  triangleTree_.emplace(boxes, threads_);
}

const EdgeGraph& SurfacePlaces::edges() const
{
  if (!edges_)
  {
    edges_ = makeEdgeGraph(input_);
  }
  return *edges_;
}

std::array<Vector3, 3> SurfacePlaces::triangle(Index i) const
{
  const std::vector<Index>& points =
    trianglePoints_.empty() ? input_.polygonPoints.vector() : trianglePoints_;
  const Index first =
    trianglePoints_.empty() ? input_.polygonOffsets[i] : static_cast<Index>(3 * i);
  return { input_.points[points[first]], input_.points[points[first + 1]],
    input_.points[points[first + 2]] };
}

Index SurfacePlaces::nearestCorner(const Vector3& p) const
{
  constexpr int kQuestionsForTree = 16; // so many looks at all points take as long as making one
  const auto squaredDistance = [&](std::size_t i) { return (input_.points[i] - p).squaredNorm(); };
  Index nearest = kInvalidIndex;
  if (!cornerTree_ && ++cornerQuestions_ > kQuestionsForTree)
  {
    makeCornerTree();
  }
  if (cornerTree_)
  {
    const Index i = cornerTree_->nearest(p, [&](Index k) { return squaredDistance(corners_[k]); });
    nearest = i == kInvalidIndex ? i : corners_[i];
  }
  else
  {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < isUsed_.size(); ++i)
    {
      const double squared = squaredDistance(i);
      if (squared < least && isUsed_[i] != 0)
      {
        least = squared;
        nearest = static_cast<Index>(i);
      }
    }
  }
  if (nearest == kInvalidIndex)
  {
    throw InvalidInput("no point of the surface was found near the place " + placeText(p));
  }
  return nearest;
}

SurfacePlaces::Place SurfacePlaces::nearestPlace(const Vector3& p) const
{
  if (!triangleTree_)
  {
    makeTriangleTree();
  }
  const auto placeOn = [&](Index i)
  {
    const std::array<Vector3, 3> corner = triangle(i);
    return nearestOnTriangle(p, corner[0], corner[1], corner[2]);
  };
  const Index nearest =
    triangleTree_->nearest(p, [&](Index i) { return (placeOn(i) - p).squaredNorm(); });
  if (nearest == kInvalidIndex)
  {
    throw InvalidInput("no place on the surface was found for the point " + placeText(p));
  }
  return { trianglePolygon_.empty() ? nearest : trianglePolygon_[nearest], placeOn(nearest) };
}

bool SurfacePlaces::isOnBoundary(Index point) const
{
  std::map<Index, int> polygons; // by the other end of the edge
  for (std::size_t i = 0; i + 1 < input_.polygonOffsets.size(); ++i)
  {
    const Index begin = input_.polygonOffsets[i];
    const Index corners = input_.polygonOffsets[i + 1] - begin;
    for (Index k = 0; k < corners; ++k)
    {
      if (input_.polygonPoints[begin + k] == point)
      {
        ++polygons[input_.polygonPoints[begin + (k + 1) % corners]];
        ++polygons[input_.polygonPoints[begin + (k + corners - 1) % corners]];
      }
    }
  }
  return std::any_of(
    polygons.begin(), polygons.end(), [](const auto& edge) { return edge.second == 1; });
}

} // namespace quadrille
