// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/CurveLines.h"

#include "Base/Progress.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <cstdlib>

namespace quadrille
{
namespace
{

/// A constrained edge, by the lower of its half-edges, and which way a walk runs along it.
struct DirectedEdge
{
  Index h = kInvalidIndex;
  bool forward = true; ///< in the direction of h

  Index cornerAhead() const { return forward ? Mesh::next(h) : h; }
  Index cornerBehind() const { return forward ? h : Mesh::next(h); }
};

/// A grid vertex on an edge.
struct Node
{
  Index vertex;
  std::int64_t distance; ///< in the map from where the walk enters the edge
};

class CurveWalker
{
public:
  CurveWalker(const ExactMap& map, const GridVertices& grid) : map_(map), grid_(grid) {}

  std::vector<CurveLine> run()
  {
    const Mesh& mesh = map_.mesh;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isConstrained(h) && h < mesh.twin[h])
      {
        visitEdge(h);
      }
    }
    return std::move(lines_);
  }

private:
  void visitEdge(Index h)
  {
    const std::vector<Node> nodes = nodesAlong({ h, true });
    for (std::size_t i = 1; i < nodes.size(); ++i)
    {
      add(nodes[i - 1].vertex, nodes[i].vertex, h, false);
    }
    if (!nodes.empty()) // otherwise others walk over it
    {
      walkOn({ h, true }, nodes.back());
      if (!map_.mesh.isBoundary(h)) // boundaries are walked one way only
      {
        walkOn({ h, false }, nodes.front());
      }
    }
  }

  void add(Index a, Index b, Index h, bool zero)
  {
    const bool boundary = map_.mesh.isBoundary(h);
    if (boundary || a < b)
    {
      lines_.push_back({ a, b, h, boundary, zero });
    }
    else if (b < a)
    {
      lines_.push_back({ b, a, h, boundary, zero });
    }
  }

  std::int64_t length(Index h) const
  {
    const FixedVec2 e = map_.edge(h);
    return std::abs(e.u) + std::abs(e.v);
  }

  /// The grid vertices on the edge in the order of the walk, with those on its ends.
  std::vector<Node> nodesAlong(DirectedEdge edge) const
  {
    const FixedVec2 from = map_.at(edge.h);
    std::vector<Node> nodes;
    if (const std::optional<Index> q = grid_.findCorner(edge.h))
    {
      nodes.push_back({ *q, 0 });
    }
    const std::size_t corners = nodes.size();
    grid_.forEachOnEdge(edge.h,
      [&](Index q, FixedVec2 point)
      {
        const FixedVec2 way = point - from;
        nodes.push_back({ q, std::abs(way.u) + std::abs(way.v) });
      });
    std::sort(nodes.begin() + static_cast<std::ptrdiff_t>(corners), nodes.end(),
      [](const Node& a, const Node& b) { return a.distance < b.distance; });
    if (const std::optional<Index> q = grid_.findCorner(Mesh::next(edge.h)))
    {
      nodes.push_back({ *q, length(edge.h) });
    }
    if (!edge.forward)
    {
      std::reverse(nodes.begin(), nodes.end());
      for (Node& node : nodes)
      {
        node.distance = length(edge.h) - node.distance;
      }
    }
    return nodes;
  }

  /// Adds the line to the first grid vertex behind the end of an edge, `last` being the last one on it, at its distance
  /// from the origin of start.h. There is none where that end is a grid vertex itself, or the curve ends before the
  /// next.
  void walkOn(const DirectedEdge start, Node last)
  {
    DirectedEdge edge = start;
    DirectedEdge lastLong = start; // the last one whose image is longer than zero
    // From `last`, along the way that the walk has there.
    std::int64_t place = start.forward ? length(start.h) - last.distance : last.distance;
    int way = 1; // -1: turned back
    while (!grid_.findCorner(edge.cornerAhead()))
    {
      const std::vector<Index> edges = constrainedEdgesAt(map_.mesh, edge.cornerAhead());
      if (edges.size() != 2)
      {
        return;
      }
      const Index vertex = map_.mesh.origin[edge.cornerAhead()];
      edge.h = edges[0] == edge.h ? edges[1] : edges[0];
      edge.forward = map_.mesh.origin[edge.h] == vertex;
      if (length(edge.h) > 0)
      {
        way = turnsBack(lastLong, edge) ? -way : way;
        lastLong = edge;
      }
      const std::vector<Node> nodes = nodesAlong(edge);
      if (!nodes.empty())
      {
        place += way * nodes.front().distance;
        // Between two edges of a feature the walk from the other end comes here, too.
        if (map_.mesh.isBoundary(start.h) || last.vertex < nodes.front().vertex)
        {
          add(last.vertex, nodes.front().vertex, start.h, place == 0);
        }
        return;
      }
      place +=
        way * length(edge.h); // a closed curve comes back to start.h, which has a grid vertex
    }
  }

  /// Where the edge begins or ends, along the way that the walk takes, less the whole units.
  std::int64_t fractionAt(DirectedEdge edge, bool atEnd) const
  {
    const Index corner = atEnd ? edge.cornerAhead() : edge.cornerBehind();
    const FixedVec2 e = edge.forward ? map_.edge(edge.h) : -map_.edge(edge.h);
    const FixedVec2 p = map_.at(corner);
    const std::int64_t along =
      std::abs(e.u) >= std::abs(e.v) ? (e.u < 0 ? -p.u : p.u) : (e.v < 0 ? -p.v : p.v);
    return along & (kOne - 1);
  }

  /// Does the image of the curve turn back between two edges? Transitions are whole, so that the fraction
  /// of the coordinate along the curve tells, but for the middle between two grid vertices.
  bool turnsBack(DirectedEdge before, DirectedEdge after) const
  {
    const std::int64_t fraction = fractionAt(before, true);
    if (fraction != kOne / 2)
    {
      return fraction != fractionAt(after, false);
    }
    if (map_.mesh.origin[before.cornerAhead()] != map_.mesh.origin[after.cornerBehind()])
    {
      return false; // edges of length zero between them hide the rotations of the charts
    }
    const auto halfEdgeAlong = [this](DirectedEdge edge)
    { return edge.forward ? edge.h : map_.mesh.twin[edge.h]; };
    const std::optional<bool> left = turnsBackInFan(halfEdgeAlong(after), halfEdgeAlong(before));
    const std::optional<bool> right = turnsBackInFan(
      halfEdgeAlong({ before.h, !before.forward }), halfEdgeAlong({ after.h, !after.forward }));
    return left.value_or(right.value_or(false));
  }

  /// Compares the images of two edges at a vertex through the fan counterclockwise from the half-edge `from` that
  /// leaves it to the half-edge `to` that ends there. None where a boundary or an image of length zero lies between.
  std::optional<bool> turnsBackInFan(Index from, Index to) const
  {
    if (from == kInvalidIndex || to == kInvalidIndex)
    {
      return std::nullopt;
    }
    FixedVec2 image = map_.edge(from);
    Index corner = from;
    while (Mesh::previous(corner) != to)
    {
      Transition t;
      if (!map_.transition(Mesh::previous(corner), t))
      {
        return std::nullopt;
      }
      image = rotate(image, t.rotation);
      corner = map_.mesh.rotateCounterclockwise(corner);
    }
    const FixedVec2 other = -map_.edge(to);
    return Int128{ image.u } * other.u + Int128{ image.v } * other.v > 0;
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  std::vector<CurveLine> lines_;
};

} // namespace

std::vector<CurveLine> findCurveLines(const ExactMap& map, const GridVertices& grid)
{
  return CurveWalker(map, grid).run();
}

} // namespace quadrille
