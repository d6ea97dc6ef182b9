// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/FreeBoundary.h"

#include "Base/Lists.h"
#include "Extraction/CurveLines.h"
#include "Extraction/FaceTrace.h"
#include "Extraction/PartialCells.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <set>

namespace quadrille
{
namespace
{

/// Finds the cell that a boundary loop lies in: straight on from its outermost vertex.
class LoopLocator
{
public:
  LoopLocator(const ExactMap& map, const GridVertices& grid, const CellCorners& cells)
    : map_(map), grid_(grid), cells_(cells), boundary_(map, grid),
      loops_(loopsWithoutNodes(map, boundary_)), loopOf_(map.mesh.vertexCount(), kInvalidIndex)
  {
    for (Index l = 0; l < loops_.size(); ++l)
    {
      for (const Index h : loops_[l])
      {
        loopOf_[map.mesh.origin[h]] = l;
      }
    }
  }

  /// One half-edge of each loop.
  std::vector<Index> loops() const
  {
    std::vector<Index> result;
    for (const BoundaryLoop& loop : loops_)
    {
      result.push_back(loop[0]);
    }
    return result;
  }

  std::set<std::array<Index, 4>> cells() const
  {
    std::set<std::array<Index, 4>> found;
    for (Index l = 0; l < loops_.size(); ++l)
    {
      if (const auto ports = cellOf(l))
      {
        found.insert(*ports);
      }
    }
    return found;
  }

private:
  std::optional<std::array<Index, 4>> cellOf(Index loop) const
  {
    int direction = 0;
    Index start = loops_[loop][0];
    for (std::size_t tries = 0; tries <= loops_.size(); ++tries)
    {
      Side side;
      FaceTrace trace(map_, grid_, boundary_);
      if (!leaveLoop(trace, start, direction, side))
      {
        return std::nullopt;
      }
      if (side.arrived)
      {
        return cellAtSide(trace, side);
      }
      if (loopOf_[map_.mesh.origin[side.hit]] == kInvalidIndex)
      {
        return std::nullopt; // the cell is cut
      }
      start = side.hit; // another loop in the same cell
      direction = side.direction;
    }
    return std::nullopt;
  }

  /// Walks from the loop's vertex that is farthest along the direction (chart of start), and of
  /// several the leftmost, so that the line meets the loop no more.
  bool leaveLoop(FaceTrace& trace, Index start, int direction, Side& side) const
  {
    BoundaryLoop loop = loops_[loopOf_[map_.mesh.origin[start]]];
    std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), start), loop.end());
    std::vector<Transition> toFirst;
    if (!developLoop(map_, loop, toFirst))
    {
      return false;
    }
    const auto key = [&](std::size_t i)
    {
      const FixedVec2 p = toFirst[i].apply(map_.at(loop[i]));
      return std::make_pair(along(p, direction), along(p, direction + 1));
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i < loop.size(); ++i)
    {
      best = key(i) > key(best) ? i : best;
    }
    int local = (direction - toFirst[best].rotation) & 3;
    for (Index corner = loop[best];;)
    {
      const int axis = (local - firstAxis(map_.edge(corner))) & 3;
      if (axis < axesInCorner(map_, corner))
      {
        side = trace.sideFrom({ Mesh::face(corner), {} }, map_.at(corner), local);
        return trace.followSide(side, false);
      }
      const Index crossed = Mesh::previous(corner);
      Transition t;
      if (map_.mesh.isBoundary(crossed) || !map_.transition(crossed, t))
      {
        return false;
      }
      local = (local + t.rotation) & 3;
      corner = map_.mesh.rotateCounterclockwise(corner);
    }
  }

  /// From the isoline that was reached on to the next corner of the cell.
  std::optional<std::array<Index, 4>> cellAtSide(FaceTrace& trace, const Side& reached) const
  {
    Side side = trace.sideFrom({ reached.place.face, {} }, reached.target, reached.direction + 1);
    if (!trace.followSide(side, false) || !side.arrived)
    {
      return std::nullopt;
    }
    const std::optional<Index> port =
      grid_.findPort(side.place.face, side.target, side.direction + 1);
    return port ? wholeCell(cells_, *port) : std::nullopt;
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  const CellCorners& cells_;
  Boundary boundary_;
  std::vector<BoundaryLoop> loops_;
  std::vector<Index> loopOf_; ///< per vertex
};

// ------------------------------------------------------------------ fans

/// Per line the lowest half-edge of the quads along it, twice, and 1 more where that runs backwards.
std::vector<Index> edgesOfLines(const QuadMesh& mesh)
{
  if (mesh.lines.empty())
  {
    return {};
  }
  const Grouped<> leaving = halfEdgesAtPoints(mesh.quads, mesh.points.size());
  std::vector<Index> edges;
  for (const QuadLine& line : mesh.lines)
  {
    const auto lowest = [&](Index a, Index b)
    {
      const Index* h = std::find_if(
        leaving.begin(a), leaving.end(a), [&](Index g) { return mesh.target(g) == b; });
      return h == leaving.end(a) ? kInvalidIndex : 2 * *h;
    };
    const Index forwards = lowest(line.a, line.b), backwards = lowest(line.b, line.a);
    edges.push_back(forwards < backwards || backwards == kInvalidIndex ? forwards : backwards + 1);
  }
  return edges;
}

/// The lines with the present names of their ends; those that are no edge any more are left out.
void renameLines(const std::vector<Index>& edges, QuadMesh& mesh)
{
  std::vector<QuadLine> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
  {
    const Index h = edges[l] / 2;
    if (edges[l] != kInvalidIndex)
    {
      lines.push_back(mesh.lines[l]);
      const bool isBackwards = edges[l] % 2 != 0;
      (isBackwards ? lines.back().b : lines.back().a) = mesh.origin(h);
      (isBackwards ? lines.back().a : lines.back().b) = mesh.target(h);
    }
  }
  mesh.lines.swap(lines);
}

/// Appends a copy of a point.
Index copyPoint(Index p, QuadMesh& mesh)
{
  const Vector3 position = mesh.points[p];
  const std::array<double, 3> weights = mesh.sourceWeights[p];
  mesh.points.push_back(position);
  mesh.sourceWeights.push_back(weights);
  mesh.sourceFace.push_back(Index{ mesh.sourceFace[p] });
  return static_cast<Index>(mesh.points.size() - 1);
}

/// Takes points away that no quad has.
void compact(QuadMesh& mesh)
{
  std::vector<std::uint8_t> isUsed(mesh.points.size(), 0);
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (const Index p : quad)
    {
      isUsed[p] = 1;
    }
  }
  const std::vector<Index> id = keepPoints(mesh, isUsed);
  for (std::array<Index, 4>& quad : mesh.quads)
  {
    for (Index& p : quad)
    {
      p = id[p];
    }
  }
}

/// Takes the quads away inside of which a boundary loop lies that no isoline meets.
void dropQuadsAroundLoops(const LoopLocator& locator, const CellCorners& cells,
  const std::vector<Index>& pointOf, QuadMesh& mesh)
{
  std::set<PointSet> removed;
  for (const std::array<Index, 4>& ports : locator.cells())
  {
    removed.insert(pointsOf(cells, ports, pointOf));
  }
  removeQuads(removed, mesh);
}

/// Gives each fan of quads at a point where several meet a copy of the point, and takes points away
/// that no quad has. Returns the number of copies.
std::size_t separateFans(QuadMesh& mesh)
{
  const QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  const Index count = static_cast<Index>(4 * mesh.quads.size());
  const std::vector<Index> edges = edgesOfLines(mesh);
  std::vector<std::uint8_t> seen(count, 0), taken(mesh.points.size(), 0);
  std::size_t copies = 0;
  for (Index start = 0; start < count; ++start)
  {
    if (seen[start])
    {
      continue;
    }
    const Index p = mesh.quads[start / 4][start % 4];
    // All corners of the fan, first clockwise to its end.
    Index first = start;
    for (Index g = topology.twin[start]; g != kInvalidIndex; g = topology.twin[first])
    {
      first = nextInQuad(g);
      if (first == start)
      {
        break;
      }
    }
    const Index name = taken[p] ? copyPoint(p, mesh) : p;
    copies += taken[p];
    taken[p] = 1;
    Index h = first;
    do
    {
      seen[h] = 1;
      mesh.quads[h / 4][h % 4] = name;
      h = topology.twin[previousInQuad(h)];
    } while (h != kInvalidIndex && h != first);
  }
  compact(mesh);
  renameLines(edges, mesh);
  return copies;
}

/// Takes lines away that begin along a feature which ends before the next grid vertex.
void dropHalfLines(
  const ExactMap& map, const GridVertices& grid, const std::vector<Index>& pointOf, QuadMesh& mesh)
{
  const auto isFeature = [](const QuadLine& line) { return !line.boundary; };
  if (std::none_of(mesh.lines.begin(), mesh.lines.end(), isFeature))
  {
    return;
  }
  std::set<std::pair<Index, Index>> whole;
  for (const CurveLine& line : findCurveLines(map, grid))
  {
    const Index a = pointOf[line.a];
    const Index b = pointOf[line.b];
    whole.emplace(std::min(a, b), std::max(a, b));
  }
  eraseIf(mesh.lines,
    [&](const QuadLine& line)
    { return isFeature(line) && whole.count(std::minmax(line.a, line.b)) == 0; });
}

} // namespace

FreeBoundaryReport treatFreeBoundary(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, BoundaryMode mode, std::vector<Index>& pointOf,
  ExtractionResult& result)
{
  FreeBoundaryReport report;
  dropHalfLines(map, grid, pointOf, result.mesh);
  if (mode == BoundaryMode::Polygons)
  {
    report = addPartialCells(map, grid, cells, pointOf, result.mesh);
  }
  else if (mode == BoundaryMode::Trimmed)
  {
    const LoopLocator locator(map, grid, cells);
    report.loopsInCells = locator.loops();
    dropQuadsAroundLoops(locator, cells, pointOf, result.mesh);
    result.separatedFans = separateFans(result.mesh);
  }
  result.loopsInCells = report.loopsInCells.size();
  return report;
}

} // namespace quadrille
