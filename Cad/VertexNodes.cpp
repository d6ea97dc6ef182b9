// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/VertexNodes.h"

#include "Base/Lists.h"
#include "Cad/ShapeData.h"
#include "Mesh/NearestTriangle.h"

#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace quadrille
{

namespace
{

/// So many quads away from a vertex nodes make room for the one that goes there.
constexpr std::size_t kRings = 3;
/// Of the means of displacements over so few nodes, which they no longer change much.
constexpr int kSweeps = 20;

/// The least sine of a corner, seen along the normal of the diagonals; at most 0 where one has 180 degrees or more.
double leastSine(const std::array<Vector3, 4>& p)
{
  const Vector3 normal = (p[2] - p[0]).cross(p[3] - p[1]).stableNormalized();
  double least = 1;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Vector3 a = (p[(i + 1) % 4] - p[i]).stableNormalized();
    const Vector3 b = (p[(i + 3) % 4] - p[i]).stableNormalized();
    least = std::min(least, a.cross(b).dot(normal));
  }
  return least;
}

class VertexTaker
{
public:
  VertexTaker(const CadShape::Data& data, const CadSurface& surface,
    const std::vector<std::array<Index, 4>>& quads, std::vector<CadPlace>& places)
    : data_(data), surface_(surface), quads_(quads), places_(places), quadsAt_(places.size()),
      nodesOf_(surface.edges.size()), isTaken_(surface.vertexPoints.size(), false),
      edgesAt_(surface.vertexPoints.size()), endsOf_(surface.edges.size())
  {
    for (Index q = 0; q < quads.size(); ++q)
    {
      for (const Index node : quads[q])
      {
        quadsAt_[node].push_back(q);
      }
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Vector3& a = places[quads[q][i]].point;
        side_ += (places[quads[q][(i + 1) % 4]].point - a).norm() /
          (4.0 * static_cast<double>(quads.size()));
      }
    }
    for (Index node = 0; node < places.size(); ++node)
    {
      const CadPlace& place = places[node];
      if (place.kind == CadPlaceKind::Edge)
      {
        nodesOf_[place.id].push_back(node);
      }
      else if (place.kind == CadPlaceKind::Vertex)
      {
        isTaken_[place.id] = true;
      }
    }
    for (Index e = 0; e < surface.edges.size(); ++e)
    {
      addEnds(e);
    }
  }

  TakenVertices run()
  {
    TakenVertices result;
    for (Index vertex = 0; vertex < edgesAt_.size(); ++vertex)
    {
      if (isTaken_[vertex] || edgesAt_[vertex].empty() ||
        surface_.vertexPoints[vertex] == kInvalidIndex)
      {
        continue;
      }
      const std::optional<Moves> moves = movesTo(vertex);
      if (!moves)
      {
        if (isOfLongEdge(vertex))
        {
          result.without.push_back(vertex);
        }
        continue;
      }
      apply(*moves);
      places_[moves->node].kind = CadPlaceKind::Vertex;
      places_[moves->node].id = vertex;
      isTaken_[vertex] = true;
      ++result.taken;
    }
    result.beside.assign(beside_.begin(), beside_.end());
    return result;
  }

private:
  void addEnds(Index edge)
  {
    const CadEdgeKind kind = surface_.edges[edge].kind;
    if (kind != CadEdgeKind::Sharp && kind != CadEdgeKind::Free)
    {
      return;
    }
    TopoDS_Vertex first, last;
    TopExp::Vertices(TopoDS::Edge(data_.edges(static_cast<int>(edge) + 1)), first, last);
    if (first.IsNull() || last.IsNull() || first.IsSame(last)) // a ring needs no corner
    {
      return;
    }
    for (const TopoDS_Vertex& end : { first, last })
    {
      const auto vertex = static_cast<Index>(data_.vertices.FindIndex(end) - 1);
      edgesAt_[vertex].push_back(edge);
      endsOf_[edge].push_back(vertex);
    }
  }

  /// Longer than two sides of quads, so that there is room for a node at each end.
  bool isOfLongEdge(Index vertex) const
  {
    return std::any_of(edgesAt_[vertex].begin(), edgesAt_[vertex].end(),
      [this](Index e)
      {
        double length = 0;
        const std::vector<Index>& line = surface_.edges[e].points;
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
        {
          length += (surface_.points[line[i + 1]] - surface_.points[line[i]]).norm();
        }
        return length > 2 * side_;
      });
  }

  /// A node goes onto a vertex, and others beside it to make room.
  struct Moves
  {
    Index node = kInvalidIndex;
    std::map<Index, Vector3> points; ///< by node; where they go
  };

  /// The nearest node of an edge at the vertex, alone where the quads round it stay good, else with those beside it.
  std::optional<Moves> movesTo(Index vertex) const
  {
    const Vector3& target = surface_.points[surface_.vertexPoints[vertex]];
    const Index node = nearestNode(vertex, target);
    if (node == kInvalidIndex || (places_[node].point - target).norm() > width(node))
    {
      return std::nullopt;
    }
    Moves moves{ node, { { node, target } } };
    if (keepsQuads(moves.points))
    {
      return moves;
    }
    moves.points = withRoom(node, target);
    return keepsQuads(moves.points) ? std::optional(moves) : std::nullopt;
  }

  Index nearestNode(Index vertex, const Vector3& target) const
  {
    Index best = kInvalidIndex;
    double least = std::numeric_limits<double>::infinity();
    for (const Index edge : edgesAt_[vertex])
    {
      for (const Index node : nodesOf_[edge])
      {
        const double distance = (places_[node].point - target).norm();
        const bool isNearer = places_[node].kind == CadPlaceKind::Edge && distance < least;
        best = isNearer ? node : best;
        least = isNearer ? distance : least;
      }
    }
    return best;
  }

  void apply(const Moves& moves)
  {
    for (const auto& [node, point] : moves.points)
    {
      places_[node].point = point;
      if (node != moves.node)
      {
        beside_.insert(node);
      }
    }
    beside_.erase(moves.node);
  }

  /// Whether no least sine falls by more than half.
  bool keepsQuads(const std::map<Index, Vector3>& points) const
  {
    double before = 1, after = 1;
    for (const auto& [node, point] : points)
    {
      for (const Index quad : quadsAt_[node])
      {
        std::array<Vector3, 4> corners = cornersOf(quad);
        before = std::min(before, leastSine(corners));
        for (std::size_t i = 0; i < 4; ++i)
        {
          const auto moved = points.find(quads_[quad][i]);
          corners[i] = moved == points.end() ? corners[i] : moved->second;
        }
        after = std::min(after, leastSine(corners));
      }
    }
    return after >= before / 2;
  }

  /// Nodes that share a side of a quad with it.
  std::vector<Index> besideOf(Index node) const
  {
    std::vector<Index> others;
    for (const Index quad : quadsAt_[node])
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index a = quads_[quad][i], b = quads_[quad][(i + 1) % 4];
        if (a == node || b == node)
        {
          others.push_back(a == node ? b : a);
        }
      }
    }
    sortUnique(others);
    return others;
  }

  /// Nodes along the edge go on the same way, the less the farther they are from it, and those of faces by the mean of
  /// what is round them.
  std::map<Index, Vector3> withRoom(Index node, const Vector3& target) const
  {
    const Vector3 step = target - places_[node].point;
    std::map<Index, Vector3> points{ { node, target } };
    addAlong(node, step, step.norm(), points);
    addAlong(node, -step, -step.norm(), points);
    std::map<Index, Vector3> moves; // of all in the rings
    for (const auto& [along, point] : points)
    {
      moves[along] = point - places_[along].point;
    }
    std::vector<Index> inner, ring{ node };
    for (std::size_t k = 0; k < kRings; ++k)
    {
      std::vector<Index> next;
      for (const Index at : ring)
      {
        for (const Index other : besideOf(at))
        {
          if (moves.emplace(other, Vector3::Zero()).second)
          {
            next.push_back(other);
          }
        }
      }
      std::copy_if(next.begin(), next.end(), std::back_inserter(inner),
        [this](Index i) { return places_[i].kind == CadPlaceKind::Face; });
      ring = std::move(next);
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep)
    {
      for (const Index i : inner)
      {
        Vector3 sum = Vector3::Zero();
        const std::vector<Index> others = besideOf(i);
        for (const Index other : others)
        {
          const auto found = moves.find(other);
          sum += found == moves.end() ? Vector3::Zero() : found->second;
        }
        moves[i] = sum / static_cast<double>(others.size());
      }
    }
    for (const Index i : inner)
    {
      const CadPlace& place = places_[i];
      const auto onTriangle = triangles().at(place.point + moves[i], place.normal);
      points[i] = onTriangle ? onTriangle->point : place.point;
    }
    return points;
  }

  /// From a node the way that `ahead` looks, up to the next node that stays: each goes by a part of `length` in the
  /// direction that leads on, and onto the polyline of its edge.
  void addAlong(
    Index node, const Vector3& ahead, double length, std::map<Index, Vector3>& points) const
  {
    std::vector<Index> chain{ node };
    Vector3 direction = ahead;
    while (chain.size() <= kRings + 1 && places_[chain.back()].kind == CadPlaceKind::Edge)
    {
      const Index next = nextAlong(chain.back(), direction);
      if (next == kInvalidIndex || contains(chain, next))
      {
        break;
      }
      direction = places_[next].point - places_[chain.back()].point;
      chain.push_back(next);
    }
    const double steps = static_cast<double>(chain.size()) - 1; // the last one stays
    for (std::size_t k = 1; k + 1 < chain.size(); ++k)
    {
      const CadPlace& place = places_[chain[k]];
      const Vector3 on = (places_[chain[k + 1]].point - places_[chain[k - 1]].point).normalized();
      const double part = length * (1 - static_cast<double>(k) / steps);
      points[chain[k]] = onEdge(place.id, place.point + part * on);
    }
  }

  /// The neighbour on the same edge, or at its end, or on the edge that goes on there, that lies straight ahead.
  Index nextAlong(Index node, const Vector3& ahead) const
  {
    Index best = kInvalidIndex;
    double most = 0;
    for (const Index other : besideOf(node))
    {
      const CadPlace& place = places_[other];
      const bool isOnLine =
        (place.kind == CadPlaceKind::Edge || place.kind == CadPlaceKind::Vertex) &&
        goesOn(places_[node].id, place);
      const double cosine =
        (place.point - places_[node].point).normalized().dot(ahead.normalized());
      if (isOnLine && cosine > most)
      {
        best = other;
        most = cosine;
      }
    }
    return best;
  }

  bool goesOn(Index edge, const CadPlace& place) const
  {
    if (place.kind == CadPlaceKind::Edge && place.id == edge)
    {
      return true;
    }
    for (const Index end : endsOf_[edge])
    {
      if (place.kind == CadPlaceKind::Vertex ? place.id == end : contains(edgesAt_[end], place.id))
      {
        return true;
      }
    }
    return false;
  }

  /// The nearest place on the polyline of the edge, and of those that it meets.
  Vector3 onEdge(Index edge, const Vector3& p) const
  {
    std::vector<Index> edges{ edge };
    for (const Index end : endsOf_[edge])
    {
      append(edges, edgesAt_[end]);
    }
    Vector3 nearest = p;
    double least = std::numeric_limits<double>::infinity();
    for (const Index e : edges)
    {
      const std::vector<Index>& line = surface_.edges[e].points;
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        const Vector3& a = surface_.points[line[i]];
        const Vector3 ab = surface_.points[line[i + 1]] - a;
        const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        const double distance = (a + t * ab - p).norm();
        nearest = distance < least ? Vector3(a + t * ab) : nearest;
        least = std::min(least, distance);
      }
    }
    return nearest;
  }

  const NearestTriangle& triangles() const
  {
    if (!triangles_)
    {
      triangles_ =
        std::make_unique<NearestTriangle>(TriangleList{ surface_.points, surface_.triangles });
    }
    return *triangles_;
  }

  std::array<Vector3, 4> cornersOf(Index quad) const
  {
    std::array<Vector3, 4> corners;
    std::transform(quads_[quad].begin(), quads_[quad].end(), corners.begin(),
      [this](Index node) { return places_[node].point; });
    return corners;
  }

  /// The longest edge of a quad at the node.
  double width(Index node) const
  {
    double longest = 0;
    for (const Index quad : quadsAt_[node])
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index a = quads_[quad][i], b = quads_[quad][(i + 1) % 4];
        if (a == node || b == node)
        {
          longest = std::max(longest, (places_[a].point - places_[b].point).norm());
        }
      }
    }
    return longest;
  }

  const CadShape::Data& data_;
  const CadSurface& surface_;
  const std::vector<std::array<Index, 4>>& quads_;
  std::vector<CadPlace>& places_;
  std::vector<std::vector<Index>> quadsAt_; ///< by node
  std::vector<std::vector<Index>> nodesOf_; ///< by edge
  std::vector<bool> isTaken_;               ///< by vertex
  std::vector<std::vector<Index>> edgesAt_; ///< by vertex; sharp and free ones that are no rings
  std::vector<std::vector<Index>> endsOf_;  ///< by edge; vertices, of these
  double side_ = 0;                         ///< mean length of the sides of quads
  std::set<Index> beside_;                  ///< nodes that made room
  mutable std::unique_ptr<NearestTriangle> triangles_;
};

} // namespace

TakenVertices takeVertices(const CadShape& shape, const CadSurface& surface,
  const std::vector<std::array<Index, 4>>& quads, std::vector<CadPlace>& places)
{
  return VertexTaker(*shape.data(), surface, quads, places).run();
}

void keepQuads(const std::vector<std::array<Index, 4>>& quads, const std::vector<Vector3>& before,
  std::vector<CadPlace>& places)
{
  bool isChanged = true;
  while (isChanged)
  {
    isChanged = false;
    for (const std::array<Index, 4>& quad : quads)
    {
      std::array<Vector3, 4> old, now;
      for (std::size_t i = 0; i < 4; ++i)
      {
        old[i] = before[quad[i]];
        now[i] = places[quad[i]].point;
      }
      if (old == now || leastSine(old) <= 0 || leastSine(now) > 0)
      {
        continue;
      }
      for (const Index node : quad)
      {
        isChanged = isChanged || places[node].kind != CadPlaceKind::None;
        places[node] = CadPlace();
        places[node].point = before[node];
      }
    }
  }
}

} // namespace quadrille
