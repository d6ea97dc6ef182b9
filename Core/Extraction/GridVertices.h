// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The integer points of a map and the grid directions that leave them (q-vertices and q-ports of
/// [Ebke et al. 2013]).
///
/// A port is a direction of the grid at an integer point together with the side to its left, that
/// is, one corner of one cell. It belongs to each triangle, of either orientation, whose image contains
/// the point moved by e along the direction and by e^2 to its left, for all small e. These corners are
/// those of a square inside the cell, smaller and turned by infinitesimal amounts, whose sides meet no
/// vertex and no corner of which lies on an edge: that makes every choice unique. The outline of this
/// square has a preimage of closed curves on the surface, whatever folds the map has (see GridTracing.h).
#pragma once

#include "Extraction/ExactMap.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <optional>

namespace quadrille
{

/// Where on the mesh an integer point lies. The order is that of the record in GridVertices.
enum class Site : std::uint8_t
{
  Face,  ///< strictly inside face site
  Edge,  ///< strictly inside the edge of half-edge site, the lower id of the two
  Vertex ///< on the vertex of corner site, the canonical corner of its fan
};

struct GridVertex
{
  FixedVec2 uv; ///< in the chart of face()
  Index site = kInvalidIndex;
  Index firstPort = 0;
  Site kind = Site::Face;

  Index face() const { return kind == Site::Face ? site : Mesh::face(site); }
  /// Sorts within a face: inside, edges, corners.
  int slot() const
  {
    return kind == Site::Face ? 0 : static_cast<int>(kind) * 3 - 2 + static_cast<int>(site % 3);
  }
};

/// A wedge of one triangle at an integer point and the ports that lie in it.
struct Sector
{
  Index face = kInvalidIndex;
  Index halfEdge =
    kInvalidIndex; ///< on the surface the right side of the wedge; invalid strictly inside a face
  FixedVec2 point; ///< the integer point in the chart of face
  int firstDirection = 0; ///< in that chart; the others follow counterclockwise there
  int count = 0;          ///< number of ports
  int orientation = 1;    ///< of the triangle's image
};

class GridVertices
{
public:
  /// Finds all integer points; ids follow the faces. Linear in faces plus points; parallel.
  GridVertices(const ExactMap& map, int threads);

  const std::vector<GridVertex>& vertices() const { return vertices_; }
  Index portCount() const { return portCount_; }

  /// Calls visit(sector) counterclockwise on the surface for all sectors of vertex q that have ports; the ports of
  /// the vertex are numbered from firstPort on in this order.
  template <typename Visitor>
  void forEachSector(Index q, const Visitor& visit) const
  {
    visitSectors(vertices_[q], visit);
  }

  /// The integer point at `point` of the closed triangle f, if there is one. In a triangle without area
  /// several can lie there; then it is the first of corners and edges.
  std::optional<Index> find(Index f, FixedVec2 point) const;

  /// The integer point on the vertex of corner h, if there is one.
  std::optional<Index> findCorner(Index h) const;

  /// The port of `direction` at `point` of triangle f, both in f's chart.
  std::optional<Index> findPort(Index f, FixedVec2 point, int direction) const
  {
    const std::optional<Index> q = find(f, point);
    return q ? findPort(*q, f, point, direction) : std::nullopt;
  }
  /// The same where find() has said that vertex q is there.
  std::optional<Index> findPort(Index q, Index f, FixedVec2 point, int direction) const;

  /// The next port of vertex q counterclockwise on the surface; none at the end of a boundary vertex.
  std::optional<Index> portAfter(Index q, Index port) const;
  std::optional<Index> portBefore(Index q, Index port) const;

  /// Calls visit(grid vertex, its place in h's chart) for those strictly inside the edge of h.
  template <typename Visitor>
  void forEachOnEdge(Index h, const Visitor& visit) const
  {
    const Index g = map_.mesh.twin[h];
    const Index owner = std::min(h, g);
    Transition t;
    if (owner != h && !map_.transition(g, t))
    {
      return;
    }
    const Index f = Mesh::face(owner);
    for (Index q = faceFirst_[f]; q < faceFirst_[f + 1]; ++q)
    {
      if (vertices_[q].kind == Site::Edge && vertices_[q].site == owner)
      {
        visit(q, t.apply(vertices_[q].uv));
      }
    }
  }

private:
  /// Of a chunk of faces.
  struct Part
  {
    std::vector<GridVertex> vertices;
    Index ports = 0;
  };

  Index endOfPorts(Index q) const
  {
    return q + 1 < vertices_.size() ? vertices_[q + 1].firstPort : portCount_;
  }
  bool isOnBoundary(Index q) const
  {
    return vertices_[q].kind != Site::Face && map_.mesh.isBoundary(vertices_[q].site);
  }
  Sector faceSector(const GridVertex& vertex) const;
  Sector edgeSector(Index h, FixedVec2 point) const;
  Sector cornerSector(Index h) const;
  void numberPorts(Part& part, Index q) const;
  std::optional<Index> findRecord(Site kind, Index site, FixedVec2 uv) const;
  std::optional<Index> findOnEdge(Index h, FixedVec2 point) const;
  Index rankOfSector(Index q, Index halfEdge) const;

  template <typename Visitor>
  void visitSectors(const GridVertex& vertex, const Visitor& visit) const
  {
    if (vertex.kind == Site::Face)
    {
      visitFace(vertex, visit);
    }
    else if (vertex.kind == Site::Edge)
    {
      visitEdge(vertex, visit);
    }
    else
    {
      visitFan(vertex, visit);
    }
  }

  template <typename Visitor>
  void visitFace(const GridVertex& vertex, const Visitor& visit) const
  {
    const Sector sector = faceSector(vertex);
    if (sector.count > 0)
    {
      visit(sector);
    }
  }

  template <typename Visitor>
  void visitEdge(const GridVertex& vertex, const Visitor& visit) const
  {
    const Sector mine = edgeSector(vertex.site, vertex.uv);
    if (mine.count > 0)
    {
      visit(mine);
    }
    Transition t;
    if (map_.transition(vertex.site, t))
    {
      const Sector other = edgeSector(map_.mesh.twin[vertex.site], t.apply(vertex.uv));
      if (other.count > 0)
      {
        visit(other);
      }
    }
  }

  template <typename Visitor>
  void visitFan(const GridVertex& vertex, const Visitor& visit) const
  {
    forEachFrom(map_.mesh, vertex.site,
      [&](Index h)
      {
        const Sector sector = cornerSector(h);
        if (sector.count > 0)
        {
          visit(sector);
        }
      });
  }

  ExactMap map_;
  std::vector<GridVertex> vertices_;
  std::vector<Index> faceFirst_; ///< #F + 1 offsets into vertices_
  Index portCount_ = 0;
};

/// Barycentric coordinates of a point in the chart of a face with area.
std::array<double, 3> weightsInFace(const ExactMap& map, Index face, FixedVec2 uv);

/// The place of a grid vertex; weights are exactly 0 and 1 on edges and vertices where they must be.
SurfacePoint placeOf(const ExactMap& map, const GridVertex& vertex);

} // namespace quadrille
