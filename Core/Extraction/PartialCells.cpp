// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/PartialCells.h"

#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Extraction/CellTopology.h"
#include "Extraction/FaceTrace.h"
#include "Extraction/QuadAssembly.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace quadrille
{
namespace
{

/// Where polygons cut the boundary short they stay within this, in quads.
constexpr double kPolygonTolerance = 0.1;
/// Cosine of the angle by which a boundary bends at a corner that polygons keep.
constexpr double kCornerCosine = 0.8660254037844387; // 30 degrees

/// Do the segments ab and cd cross, each inside of the other?
bool cross(FixedVec2 a, FixedVec2 b, FixedVec2 c, FixedVec2 d)
{
  const int c1 = orientation(a, b, c), d1 = orientation(a, b, d);
  const int a1 = orientation(c, d, a), b1 = orientation(c, d, b);
  return c1 * d1 < 0 && a1 * b1 < 0;
}

/// Which stops of a face become corners of its polygon.
class Simplifier
{
public:
  Simplifier(const std::vector<Stop>& stops, const std::vector<std::uint8_t>& wanted)
    : stops_(stops), kept_(wanted)
  {
    // A face lies in one cell, so that differences have few bits.
    for (const Stop& stop : stops)
    {
      const FixedVec2 d = stop.uv - stops.front().uv;
      constexpr std::int64_t kFine = std::int64_t{ 1 } << kFineBits;
      place_.push_back({ d.u * kFine + stop.fine.u, d.v * kFine + stop.fine.v });
    }
  }

  /// Keeps one more stop between a kept one and the next; false where there is none.
  bool keepBetween(Index a, Index b)
  {
    const Index between = farthest(a, b);
    if (between != kInvalidIndex)
    {
      kept_[between] = 1;
    }
    return between != kInvalidIndex;
  }

  /// Ascending; empty where no choice gives a simple polygon.
  std::vector<Index> run()
  {
    keepWhereFlat();
    keepWhereFar();
    for (bool isFirst = true;; isFirst = false)
    {
      std::vector<Index> corners = keptStops();
      if (isSimple(corners))
      {
        countTryLed(Try::MoreCorners, isFirst ? 0 : 1);
        return corners;
      }
      if (!refine(corners))
      {
        return {};
      }
      countTry(Try::MoreCorners);
    }
  }

private:
  std::vector<Index> keptStops() const
  {
    std::vector<Index> corners;
    for (Index i = 0; i < stops_.size(); ++i)
    {
      if (kept_[i])
      {
        corners.push_back(i);
      }
    }
    return corners;
  }

  Index after(Index i) const { return i + 1 == stops_.size() ? 0 : i + 1; }

  /// The stop strictly between a and b that is farthest from their line; none where there is none.
  Index farthest(Index a, Index b) const
  {
    Index best = kInvalidIndex;
    Int128 most = -1;
    for (Index i = after(a); i != b; i = after(i))
    {
      const FixedVec2 d = place_[i] - place_[a];
      Int128 distance = Int128{ d.u } * d.u + Int128{ d.v } * d.v;
      if (place_[a] != place_[b])
      {
        distance = determinant(place_[a], place_[b], place_[i]);
        distance = distance < 0 ? -distance : distance;
      }
      if (distance > most)
      {
        most = distance;
        best = i;
      }
    }
    return best;
  }

  /// A boundary that comes back to the isoline that it left must not be cut short to a part of it.
  void keepWhereFlat()
  {
    const std::vector<Index> corners = keptStops();
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % corners.size()];
      const bool flat = corners.size() == 1 || onOneIsoline(stops_[a], stops_[b]);
      if (flat)
      {
        keepBetween(a, b);
      }
    }
  }

  /// Follows the boundary to within kPolygonTolerance [Douglas and Peucker 1973].
  void keepWhereFar()
  {
    std::vector<Index> corners = keptStops();
    if (corners.empty())
    {
      return;
    }
    std::vector<std::pair<Index, Index>> gaps;
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      gaps.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    }
    while (!gaps.empty())
    {
      const auto [a, b] = gaps.back();
      gaps.pop_back();
      const Index between = farthest(a, b);
      if (between != kInvalidIndex && distance(between, a, b) > kPolygonTolerance)
      {
        kept_[between] = 1;
        gaps.emplace_back(a, between);
        gaps.emplace_back(between, b);
      }
    }
  }

  /// Of a stop from the line through two others, or from both where they are one; in quads.
  double distance(Index i, Index a, Index b) const
  {
    const auto vector = [this](Index from, Index to) -> Vector2
    { return toDouble(place_[to] - place_[from]) / static_cast<double>(1LL << kFineBits); };
    const Vector2 line = vector(a, b), way = vector(a, i);
    const double length = line.norm();
    return length > 0 ? std::abs(line.x() * way.y() - line.y() * way.x()) / length : way.norm();
  }

  static bool onOneIsoline(const Stop& a, const Stop& b)
  {
    return (a.uv.u == b.uv.u && isInteger(a.uv.u) && a.fine.u == 0 && b.fine.u == 0) ||
      (a.uv.v == b.uv.v && isInteger(a.uv.v) && a.fine.v == 0 && b.fine.v == 0);
  }

  bool isSimple(const std::vector<Index>& corners) const
  {
    const std::size_t n = corners.size();
    if (n < 3)
    {
      return false;
    }
    Int128 area = 0;
    for (std::size_t i = 0; i + 2 < n; ++i)
    {
      area += determinant(uv(corners, 0), uv(corners, i + 1), uv(corners, i + 2));
    }
    if (area <= 0)
    {
      return false;
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      for (std::size_t k = i + 2; k < n; ++k)
      {
        if ((k + 1) % n != i &&
          cross(uv(corners, i), uv(corners, i + 1), uv(corners, k), uv(corners, k + 1)))
        {
          return false;
        }
      }
    }
    return true;
  }

  FixedVec2 uv(const std::vector<Index>& corners, std::size_t i) const
  {
    return place_[corners[i % corners.size()]];
  }

  /// Keeps one more stop between any two; false when there is none.
  bool refine(const std::vector<Index>& corners)
  {
    bool any = false;
    if (corners.empty())
    {
      kept_[lowest()] = 1;
      return true;
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      any = keepBetween(corners[k], corners[(k + 1) % corners.size()]) || any;
    }
    return any;
  }

  Index lowest() const
  {
    Index best = 0;
    for (Index i = 1; i < stops_.size(); ++i)
    {
      const auto key = [this](Index s) { return std::make_pair(place_[s].u, place_[s].v); };
      best = key(i) < key(best) ? i : best;
    }
    return best;
  }

  const std::vector<Stop>& stops_;
  std::vector<std::uint8_t> kept_;
  std::vector<FixedVec2> place_; ///< against the first stop, in the fine unit
};

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
      if (done[n] || isAligned(map_, boundary_.nodes()[n].h))
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
    return in.dot(out) < kCornerCosine * in.norm() * out.norm();
  }

  Simplifier simplifierOf(const std::vector<Stop>& stops) const
  {
    std::vector<std::uint8_t> wanted;
    wanted.reserve(stops.size());
    for (const Stop& stop : stops)
    {
      wanted.push_back(isWanted(stop) ? 1 : 0);
    }
    return { stops, wanted };
  }

  void addFace(std::vector<Stop> stops, Index face)
  {
    std::vector<Index> corners;
    if (!stops.empty() && takeDetoursAway(stops))
    {
      corners = simplifierOf(stops).run();
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
      Simplifier simplifier = simplifierOf(face.stops);
      for (const std::size_t i : gaps)
      {
        simplifier.keepBetween(face.corners[i], face.corners[(i + 1) % face.corners.size()]);
      }
      countTry(Try::MoreCorners);
      face.corners = simplifier.run();
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
    mesh_.polygonPoints.insert(mesh_.polygonPoints.end(), points.begin(), points.end());
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
    const auto key = [](const QuadLine& l) { return std::make_tuple(l.a, l.b, l.boundary); };
    std::stable_sort(mesh_.lines.begin(), mesh_.lines.end(),
      [&](const QuadLine& l, const QuadLine& m) { return key(l) < key(m); });
    mesh_.lines.erase(std::unique(mesh_.lines.begin(), mesh_.lines.end(),
                        [&](const QuadLine& l, const QuadLine& m) { return key(l) == key(m); }),
      mesh_.lines.end());
  }

  /// A vertex on the side of a cell divides the line that ran along it.
  void dropLinesOffEdges()
  {
    const std::vector<std::uint8_t> onEdge = linesOnEdges(mesh_);
    std::vector<QuadLine> lines;
    for (std::size_t l = 0; l < onEdge.size(); ++l)
    {
      if (onEdge[l])
      {
        lines.push_back(mesh_.lines[l]);
      }
    }
    mesh_.lines.swap(lines);
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
  std::array<Index, 4> ports{ port };
  for (std::size_t i = 1; i < 4; ++i)
  {
    ports[i] = cells.next[ports[i - 1]];
    if (ports[i] == kInvalidIndex)
    {
      return std::nullopt;
    }
  }
  if (cells.next[ports[3]] != port)
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
