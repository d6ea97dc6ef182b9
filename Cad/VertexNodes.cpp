// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/VertexNodes.h"

#include "Cad/ShapeData.h"

#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <limits>

namespace quadrille
{

namespace
{

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
      edgesAt_(surface.vertexPoints.size())
  {
    for (Index q = 0; q < quads.size(); ++q)
    {
      for (const Index node : quads[q])
      {
        quadsAt_[node].push_back(q);
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

  std::size_t run()
  {
    std::size_t moved = 0;
    for (Index vertex = 0; vertex < edgesAt_.size(); ++vertex)
    {
      const bool isFree = !isTaken_[vertex] && !edgesAt_[vertex].empty() &&
        surface_.vertexPoints[vertex] != kInvalidIndex;
      moved += isFree && take(vertex) ? 1 : 0;
    }
    return moved;
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
      edgesAt_[static_cast<std::size_t>(data_.vertices.FindIndex(end)) - 1].push_back(edge);
    }
  }

  bool take(Index vertex)
  {
    const Vector3& target = surface_.points[surface_.vertexPoints[vertex]];
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
    if (best == kInvalidIndex || least > width(best))
    {
      return false;
    }
    const CadPlace before = places_[best];
    const double sineBefore = leastSineAt(best);
    places_[best].kind = CadPlaceKind::Vertex;
    places_[best].id = vertex;
    places_[best].point = target;
    if (leastSineAt(best) < sineBefore / 2)
    {
      places_[best] = before;
      return false;
    }
    isTaken_[vertex] = true;
    return true;
  }

  std::array<Vector3, 4> cornersOf(Index quad) const
  {
    std::array<Vector3, 4> corners;
    std::transform(quads_[quad].begin(), quads_[quad].end(), corners.begin(),
      [this](Index node) { return places_[node].point; });
    return corners;
  }

  double leastSineAt(Index node) const
  {
    double least = 1;
    for (const Index quad : quadsAt_[node])
    {
      least = std::min(least, leastSine(cornersOf(quad)));
    }
    return least;
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
};

} // namespace

std::size_t takeVertices(const CadShape& shape, const CadSurface& surface,
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
