// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/GeodesicGraph.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <functional>
#include <queue>

namespace quadrille
{
namespace
{

/// The arcs of one vertex. Strips begin with a face at the vertex, laid out with the vertex at the origin.
class StripWalk
{
public:
  StripWalk(const Mesh& mesh, std::vector<std::pair<Index, float>>& arcs) : mesh_(mesh), arcs_(arcs)
  {
  }

  /// h: a half-edge from the vertex. Adds its edge, and what is seen through the opposite edge of its face.
  void lookThrough(Index h)
  {
    addArc(mesh_.target(h), mesh_.edgeVector(h).norm());
    const Index last = Mesh::previous(h);
    if (mesh_.isBoundary(last)) // its edge is no half-edge from the vertex
    {
      addArc(mesh_.origin[last], mesh_.edgeVector(last).norm());
    }
    const Vector3 a = mesh_.edgeVector(h);
    const Vector3 b = -mesh_.edgeVector(last);
    const double length = a.norm();
    if (!(length > 0))
    {
      return;
    }
    const double x = a.dot(b) / length;
    const Vector2 right(length, 0);
    const Vector2 left(x, a.cross(b).norm() / length);
    goThrough({ Mesh::next(h), right, left, right, left, 0 });
  }

private:
  /// The edge that is looked through, from `from` to `to` counterclockwise as seen from the origin, and what of it is
  /// in sight: between the directions `right` and `left`.
  struct Window
  {
    Index halfEdge; ///< of the face on this side
    Vector2 from, to;
    Vector2 right, left;
    int crossings;
  };

  void addArc(Index v, double length) { arcs_.emplace_back(v, static_cast<float>(length)); }

  void goThrough(const Window& window)
  {
    const Index twin = mesh_.twin[window.halfEdge];
    if (twin == kInvalidIndex || window.crossings == GeodesicGraph::kMostCrossings ||
      !(parallelogram(window.right, window.left) > 0))
    {
      return;
    }
    const Index toApex = Mesh::next(twin); // from the corner at `from` on
    const Vector2 along = window.to - window.from;
    const double length = along.norm();
    if (!(length > 0))
    {
      return;
    }
    const Vector3 edge = -mesh_.edgeVector(twin);
    const Vector3 side = mesh_.edgeVector(toApex);
    const double x = edge.dot(side) / length;
    const double y = edge.cross(side).norm() / length;
    // The apex lies beyond the edge, to its right as it runs counterclockwise round the origin.
    const Vector2 unit = along / length;
    const Vector2 apex = window.from + x * unit + y * Vector2(unit.y(), -unit.x());
    const bool rightOfLeft = parallelogram(apex, window.left) > 0;
    const bool leftOfRight = parallelogram(window.right, apex) > 0;
    if (rightOfLeft && leftOfRight)
    {
      addArc(mesh_.origin[Mesh::next(toApex)], apex.norm());
    }
    if (leftOfRight) // the edge on the side of `from` is in sight
    {
      goThrough({ toApex, window.from, apex, window.right, rightOfLeft ? apex : window.left,
        window.crossings + 1 });
    }
    if (rightOfLeft)
    {
      goThrough({ Mesh::next(toApex), apex, window.to, leftOfRight ? apex : window.right,
        window.left, window.crossings + 1 });
    }
  }

  const Mesh& mesh_;
  std::vector<std::pair<Index, float>>& arcs_;
};

} // namespace

GeodesicGraph::GeodesicGraph(const Mesh& mesh) : firstArc_(mesh.vertexCount() + std::size_t{ 1 }, 0)
{
  std::vector<std::vector<Index>> outgoing(mesh.vertexCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    outgoing[mesh.origin[h]].push_back(h);
  }
  StripWalk walk(mesh, arcs_);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    for (const Index h : outgoing[v])
    {
      walk.lookThrough(h);
    }
    firstArc_[v + std::size_t{ 1 }] = arcs_.size();
  }
}

std::vector<double> GeodesicGraph::distances(Index source, const std::vector<Index>& targets) const
{
  const std::size_t vertices = firstArc_.size() - 1;
  const auto check = [&](Index v)
  { refuseIf(v >= vertices, "distances: there is no vertex ", v, " in a mesh of ", vertices); };
  check(source);
  std::vector<double> distance(vertices, kInfinity);
  std::vector<std::uint8_t> wanted(vertices, 0);
  std::size_t open = 0;
  for (const Index v : targets)
  {
    check(v);
    open += wanted[v] == 0 ? 1 : 0;
    wanted[v] = 1;
  }
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  distance[source] = 0;
  queue.emplace(0.0, source);
  for (std::size_t steps = 0; !queue.empty() && open > 0; ++steps)
  {
    pollNowAndThen(steps);
    const auto [far, v] = queue.top();
    queue.pop();
    if (far > distance[v])
    {
      continue;
    }
    open -= wanted[v];
    for (std::size_t a = firstArc_[v]; a < firstArc_[v + std::size_t{ 1 }]; ++a)
    {
      const auto [head, length] = arcs_[a];
      if (far + length < distance[head])
      {
        distance[head] = far + length;
        queue.emplace(distance[head], head);
      }
    }
  }
  std::vector<double> result;
  result.reserve(targets.size());
  for (const Index v : targets)
  {
    result.push_back(distance[v]);
  }
  return result;
}

} // namespace quadrille
