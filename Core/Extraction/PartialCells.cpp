// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/PartialCells.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Extraction/FaceTrace.h"
#include "Extraction/PolygonSimplifier.h"
#include "Quads/QuadTopology.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace quadrille
{
namespace
{

class PolygonMaker
{
public:
  PolygonMaker(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
    std::vector<Index>& pointOf, QuadMesh& mesh)
    : map_(map), grid_(grid), cells_(cells), pointOf_(pointOf), mesh_(mesh), boundary_(map, grid),
      pointOfNode_(boundary_.nodes().size(), kInvalidIndex)
  {
    mesh_.polygonOffsets.assign(1, 0);
  }

  FreeBoundaryReport run()
  {
    addCutCells();
    addCellsWithVerticesOnSides();
    addLoops();
    separateChords();
    for (const Face& face : faces_)
    {
      addPolygon(face);
    }
    if (mesh_.polygonSourceFace.empty())
    {
      mesh_.polygonOffsets.clear();
    }
    sortLines();
    dropLinesOffEdges();
    return std::move(result_);
  }

private:
  struct Face
  {
    std::vector<Stop> stops;
    std::vector<Index> corners; ///< of the polygon, in stops
    Index face;                 ///< of the mesh
  };

  /// Each face that the boundary cuts has a piece of the boundary that leaves a node and is no
  /// isoline.
  void addCutCells()
  {
    std::vector<std::uint8_t> done(boundary_.nodes().size(), 0);
    for (Index n = 0; n < done.size(); ++n)
    {
      pollNowAndThen(n);
      if (done[n] || map_.isOnIsoline(boundary_.nodes()[n].h))
      {
        continue;
      }
      FaceTrace trace(map_, grid_, boundary_);
      const bool closed = trace.fromNode(n);
      for (const Index node : trace.startedAt)
      {
        done[node] = 1;
      }
      done[n] = 1;
      addFace(
        closed ? std::move(trace.stops) : std::vector<Stop>{}, Mesh::face(boundary_.nodes()[n].h));
    }
  }

  /// Whole cells with a vertex of the boundary on a side, which neighbours have as a corner.
  void addCellsWithVerticesOnSides()
  {
    std::set<std::array<Index, 4>> found;
    for (const BoundaryNode& node : boundary_.nodes())
    {
      if (node.atOrigin() && node.gridVertex == kInvalidIndex)
      {
        findCellsAt(node.h, found);
      }
    }
    std::set<PointSet> replaced;
    for (const std::array<Index, 4>& ports : found)
    {
      FaceTrace trace(map_, grid_, boundary_);
      Index face = kInvalidIndex;
      if (tracePort(ports[0], trace, face) && trace.stops.size() > 4)
      {
        replaced.insert(pointsOf(cells_, ports, pointOf_));
        addFace(std::move(trace.stops), face);
      }
    }
    removeQuads(replaced, mesh_);
  }

  void findCellsAt(Index out, std::set<std::array<Index, 4>>& found) const
  {
    FaceTrace trace(map_, grid_, boundary_);
    for (Index corner = out; corner != kInvalidIndex;
         corner = map_.mesh.rotateCounterclockwise(corner))
    {
      const FixedVec2 p = map_.at(corner);
      for (int i = 0; i < axesInCorner(map_, corner); ++i)
      {
        const int direction = (firstAxis(map_.edge(corner)) + i) & 3;
        Side side = trace.sideFrom({ Mesh::face(corner), {} }, p, direction);
        if (isInteger((direction & 1) == 0 ? p.v : p.u) && trace.followSide(side, false) &&
          side.arrived)
        {
          addCellAt(side, found);
        }
      }
    }
  }

  /// The cell that a side which has arrived has on its left, if it is whole.
  void addCellAt(const Side& side, std::set<std::array<Index, 4>>& found) const
  {
    const std::optional<Index> port =
      grid_.findPort(side.place.face, side.target, side.direction + 1);
    const auto ports = port ? wholeCell(cells_, *port) : std::nullopt;
    if (ports)
    {
      found.insert(*ports);
    }
  }

  bool tracePort(Index port, FaceTrace& trace, Index& face) const
  {
    bool closed = false;
    Index here = grid_.vertices()[cells_.vertex[port]].firstPort;
    grid_.forEachSector(cells_.vertex[port],
      [&](const Sector& sector)
      {
        for (int i = 0; i < sector.count; ++i, ++here)
        {
          if (here == port)
          {
            face = sector.face;
            closed = trace.fromPort(sector, sector.firstDirection + i);
          }
        }
      });
    return closed;
  }

  /// A loop round a part of the surface is the polygon of this part; one round a hole is left to
  /// the cell that it is in.
  void addLoops()
  {
    for (const BoundaryLoop& loop : loopsWithoutNodes(map_, boundary_))
    {
      std::vector<Transition> toFirst;
      std::vector<Stop> stops;
      Int128 area = 0;
      if (developLoop(map_, loop, toFirst))
      {
        for (std::size_t i = 0; i < loop.size(); ++i)
        {
          stops.push_back(
            { StopKind::Vertex, loop[i], toFirst[i].apply(map_.at(loop[i])), loop[i] });
        }
        for (std::size_t i = 1; i + 1 < stops.size(); ++i)
        {
          area += determinant(stops[0].uv, stops[i].uv, stops[i + 1].uv);
        }
      }
      if (area > 0)
      {
        addFace(std::move(stops), Mesh::face(loop[0]));
      }
      else
      {
        result_.loopsInCells.push_back(loop[0]);
      }
    }
  }

  // ---------------------------------------------------------------- one polygon

  /// A boundary loop that touches a side of the cell it is in from within comes as a detour.
  /// False where a stop comes twice for another reason.
  bool takeDetoursAway(std::vector<Stop>& stops)
  {
    for (std::size_t i = 0; i < stops.size(); ++i)
    {
      for (std::size_t k = i + 1; k < stops.size(); ++k)
      {
        if (!stops[i].isSame(stops[k]))
        {
          continue;
        }
        const auto isVertex = [](const Stop& stop) { return stop.kind == StopKind::Vertex; };
        const auto begin = stops.begin() + static_cast<std::ptrdiff_t>(i);
        const auto end = stops.begin() + static_cast<std::ptrdiff_t>(k);
        if (std::all_of(begin + 1, end, isVertex))
        {
          result_.loopsInCells.push_back(begin->via);
          begin->via = end->via;
          stops.erase(begin + 1, end + 1);
        }
        else if (std::all_of(stops.begin(), begin, isVertex) &&
          std::all_of(end + 1, stops.end(), isVertex))
        {
          result_.loopsInCells.push_back(end->via);
          stops = std::vector<Stop>(begin, end);
        }
        else
        {
          return false;
        }
        return takeDetoursAway(stops);
      }
    }
    return true;
  }

  bool isWanted(const Stop& stop) const
  {
    if (stop.kind != StopKind::Vertex)
    {
      return true;
    }
    for (Index g = stop.id; g != kInvalidIndex; g = map_.mesh.rotateCounterclockwise(g))
    {
      if (map_.mesh.isFeature(g))
      {
        return true;
      }
    }
    const Vector3 in = map_.mesh.edgeVector(boundary_.before(stop.id));
    const Vector3 out = map_.mesh.edgeVector(stop.id);
    return in.dot(out) < std::cos(kCurveCorner) * in.norm() * out.norm();
  }

  std::vector<std::uint8_t> wantedOf(const std::vector<Stop>& stops) const
  {
    std::vector<std::uint8_t> wanted;
    wanted.reserve(stops.size());
    for (const Stop& stop : stops)
    {
      wanted.push_back(isWanted(stop) ? 1 : 0);
    }
    return wanted;
  }

  void addFace(std::vector<Stop> stops, Index face)
  {
    std::vector<Index> corners;
    if (!stops.empty() && takeDetoursAway(stops))
    {
      corners = simplePolygon(stops, wantedOf(stops));
    }
    if (corners.empty())
    {
      ++result_.dropped;
      return;
    }
    faces_.push_back({ std::move(stops), std::move(corners), face });
  }

  /// Two faces on both sides of a hole may cut the same two nodes short, which would close it.
  void separateChords()
  {
    using End = std::pair<StopKind, Index>;
    std::map<std::pair<End, End>, std::pair<std::size_t, std::size_t>> chords;
    for (std::size_t f = 0; f < faces_.size(); ++f)
    {
      const Face& face = faces_[f];
      for (std::size_t i = 0; i < face.corners.size(); ++i)
      {
        const Stop& a = face.stops[face.corners[i]];
        const Stop& b = face.stops[face.corners[(i + 1) % face.corners.size()]];
        if (a.via == kInvalidIndex || !map_.mesh.isBoundary(a.via))
        {
          continue;
        }
        const End from{ a.kind, a.id }, to{ b.kind, b.id };
        const auto back = chords.find({ to, from });
        if (back != chords.end() && !bend(f, i))
        {
          bend(back->second.first, back->second.second);
        }
        chords.emplace(std::make_pair(from, to), std::make_pair(f, i));
      }
    }
    for (const auto& [f, gaps] : bends_)
    {
      Face& face = faces_[f];
      std::vector<std::pair<Index, Index>> between;
      for (const std::size_t i : gaps)
      {
        between.emplace_back(face.corners[i], face.corners[(i + 1) % face.corners.size()]);
      }
      countTry(Try::MoreCorners);
      face.corners = simplePolygon(face.stops, wantedOf(face.stops), between);
      countTryLed(Try::MoreCorners, face.corners.empty() ? 0 : 1);
    }
  }

  /// Asks for one more corner between corner i of a face and the next; false where there is none.
  bool bend(std::size_t f, std::size_t i)
  {
    const Face& face = faces_[f];
    const Index a = face.corners[i];
    const Index b = face.corners[(i + 1) % face.corners.size()];
    if ((a + 1) % face.stops.size() == b)
    {
      return false;
    }
    bends_[f].push_back(i);
    return true;
  }

  void addPolygon(const Face& face)
  {
    if (face.corners.empty())
    {
      ++result_.dropped;
      return;
    }
    std::vector<Index> points;
    for (const Index i : face.corners)
    {
      points.push_back(pointAt(face.stops[i]));
    }
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      addLine(points[i], points[(i + 1) % points.size()], face.stops[face.corners[i]].via);
    }
    append(mesh_.polygonPoints, points);
    mesh_.polygonOffsets.push_back(static_cast<Index>(mesh_.polygonPoints.size()));
    mesh_.polygonSourceFace.push_back(face.face);
  }

  Index addPoint(const SurfacePoint& place)
  {
    mesh_.points.push_back(positionOf(map_.mesh, place));
    mesh_.sourceFace.push_back(place.face);
    mesh_.sourceWeights.push_back(place.weights);
    return static_cast<Index>(mesh_.points.size() - 1);
  }

  Index pointAt(const Stop& stop)
  {
    if (stop.kind == StopKind::Vertex)
    {
      return addPoint(CurvePoint{ stop.id, 0 }.onSurface());
    }
    const bool whole = stop.kind == StopKind::Grid;
    Index& point = whole ? pointOf_[stop.id] : pointOfNode_[stop.id];
    if (point == kInvalidIndex)
    {
      point = whole
        ? addPoint(placeOf(map_, grid_.vertices()[stop.id]))
        : addPoint(CurvePoint{ boundary_.nodes()[stop.id].h, boundary_.nodes()[stop.id].place() }
                     .onSurface());
    }
    return point;
  }

  void addLine(Index a, Index b, Index via)
  {
    if (via == kInvalidIndex)
    {
      return;
    }
    const bool boundary = map_.mesh.isBoundary(via);
    mesh_.lines.push_back(
      { boundary ? a : std::min(a, b), boundary ? b : std::max(a, b), via, boundary });
  }

  /// Both sides of a feature, and the quads beside a polygon, may have told the same line.
  void sortLines()
  {
    sortUniqueBy(
      mesh_.lines, [](const QuadLine& l) { return std::make_tuple(l.a, l.b, l.boundary); });
  }

  /// A vertex on the side of a cell divides the line that ran along it.
  void dropLinesOffEdges()
  {
    const std::vector<std::uint8_t> onEdge = linesOnEdges(mesh_);
    const std::vector<Index> kept =
      idsWhere(onEdge.size(), [&](Index l) { return onEdge[l] != 0; });
    std::transform(
      kept.begin(), kept.end(), mesh_.lines.begin(), [this](Index l) { return mesh_.lines[l]; });
    mesh_.lines.resize(kept.size());
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  const CellCorners& cells_;
  std::vector<Index>& pointOf_;
  QuadMesh& mesh_;
  Boundary boundary_;
  std::vector<Index> pointOfNode_;
  std::vector<Face> faces_;
  std::map<std::size_t, std::vector<std::size_t>> bends_; ///< per face, see bend()
  FreeBoundaryReport result_;
};

} // namespace

FreeBoundaryReport addPartialCells(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, std::vector<Index>& pointOf, QuadMesh& mesh)
{
  return PolygonMaker(map, grid, cells, pointOf, mesh).run();
}

std::optional<std::array<Index, 4>> wholeCell(const CellCorners& cells, Index port)
{
  std::array<Index, 4> ports{};
  if (!cellOf(cells, port, false, ports))
  {
    return std::nullopt;
  }
  std::rotate(ports.begin(), std::min_element(ports.begin(), ports.end()), ports.end());
  return ports;
}

PointSet sortedPoints(PointSet points)
{
  std::sort(points.begin(), points.end());
  return points;
}

std::size_t removeQuads(const std::set<PointSet>& removed, QuadMesh& mesh)
{
  std::size_t kept = 0;
  for (std::size_t q = 0; q < mesh.quads.size() && !removed.empty(); ++q)
  {
    if (removed.count(sortedPoints(mesh.quads[q])) == 0)
    {
      mesh.quads[kept] = mesh.quads[q];
      mesh.quadSourceFace[kept] = mesh.quadSourceFace[q];
      mesh.quadSourceWeights[kept] = mesh.quadSourceWeights[q];
      ++kept;
    }
  }
  const std::size_t count = removed.empty() ? 0 : mesh.quads.size() - kept;
  mesh.quads.resize(mesh.quads.size() - count);
  mesh.quadSourceFace.resize(mesh.quads.size());
  mesh.quadSourceWeights.resize(mesh.quads.size());
  return count;
}

PointSet pointsOf(
  const CellCorners& cells, const std::array<Index, 4>& ports, const std::vector<Index>& pointOf)
{
  PointSet points{};
  for (std::size_t i = 0; i < 4; ++i)
  {
    points[i] = pointOf[cells.vertex[ports[i]]];
  }
  return sortedPoints(points);
}

} // namespace quadrille
