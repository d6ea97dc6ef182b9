// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/QuadAssembly.h"

#include "Base/Parallel.h"
#include "Extraction/SurfaceWalk.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace quadrille
{
namespace
{

constexpr std::size_t kChunk = 1 << 12;

// ------------------------------------------------------------------ merged vertices

/// Is the vertex on a feature or on the boundary?
bool isConstrainedSite(const Mesh& mesh, const GridVertex& vertex)
{
  if (vertex.kind != Site::Vertex)
  {
    return vertex.kind == Site::Edge && mesh.isConstrained(vertex.site);
  }
  Index h = vertex.site;
  do
  {
    if (mesh.isConstrained(h))
    {
      return true;
    }
    h = mesh.rotateCounterclockwise(h);
  } while (h != vertex.site && h != kInvalidIndex);
  return false;
}

/// The member of a class whose place the merged vertex takes: features first, then mesh vertices.
int rankOfSite(const Mesh& mesh, const GridVertex& vertex)
{
  return (isConstrainedSite(mesh, vertex) ? 4 : 0) + static_cast<int>(vertex.kind);
}

/// Per grid vertex the one that stands for its class.
std::vector<Index> mergeClasses(
  const Mesh& mesh, const GridVertices& grid, const std::vector<std::pair<Index, Index>>& pairs)
{
  std::vector<Index> root(grid.vertices().size());
  std::iota(root.begin(), root.end(), Index{ 0 });
  const auto find = [&root](Index q)
  {
    while (root[q] != q)
    {
      q = root[q] = root[root[q]];
    }
    return q;
  };
  const auto better = [&](Index a, Index b)
  {
    const int rankA = rankOfSite(mesh, grid.vertices()[a]);
    const int rankB = rankOfSite(mesh, grid.vertices()[b]);
    return rankA != rankB ? rankA > rankB : a < b;
  };
  for (const auto& [a, b] : pairs)
  {
    const Index rootA = find(a);
    const Index rootB = find(b);
    if (rootA != rootB)
    {
      const bool keepA = better(rootA, rootB);
      root[keepA ? rootB : rootA] = keepA ? rootA : rootB;
    }
  }
  for (Index q = 0; q < root.size(); ++q)
  {
    root[q] = find(q);
  }
  return root;
}

/// Barycentric coordinates of a place in the chart of a face.
std::array<double, 3> weightsInFace(const ExactMap& map, Index face, FixedVec2 uv)
{
  const Index h = 3 * face;
  const FixedVec2 a = map.at(h);
  const FixedVec2 b = map.at(h + 1);
  const FixedVec2 c = map.at(h + 2);
  const double whole = static_cast<double>(determinant(a, b, c));
  const double wa = static_cast<double>(determinant(uv, b, c)) / whole;
  const double wb = static_cast<double>(determinant(a, uv, c)) / whole;
  const double wc = static_cast<double>(determinant(a, b, uv)) / whole;
  return { wa, wb, wc };
}

// ------------------------------------------------------------------ cells

struct Cell
{
  std::array<Index, 4> corners;    ///< grid vertices
  Index face;                      ///< under its centre
  std::array<double, 3> weights{}; ///< of the centre in that face; all zero where it is not known
};

struct Line
{
  Index a, b; ///< grid vertices
  Index halfEdge;
  bool boundary;
};

struct Parts
{
  std::vector<Cell> cells;
  std::vector<Line> lines;
};

/// The four ports of the cell of this port when it closes and the port is its lowest.
bool closedCell(const CellCorners& cells, Index port, std::array<Index, 4>& ports)
{
  ports[0] = port;
  for (std::size_t i = 1; i < 4; ++i)
  {
    ports[i] = cells.next[ports[i - 1]];
    if (ports[i] == kInvalidIndex || ports[i] <= port)
    {
      return false;
    }
  }
  return cells.next[ports[3]] == port;
}

/// Does the port run along the right side of its sector?
bool runsAlong(const ExactMap& map, const Sector& sector, int direction)
{
  if (sector.halfEdge == kInvalidIndex)
  {
    return false;
  }
  const FixedVec2 e = map.edge(sector.halfEdge);
  return along(e, direction + 1) == 0 && along(e, direction) > 0;
}

class Collector
{
public:
  Collector(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
    const std::vector<Index>& root)
    : map_(map), grid_(grid), cells_(cells), root_(root),
      stepLimit_(3 * std::size_t{ map.mesh.faceCount() } + 16)
  {
  }

  void visitVertex(Index q, Parts& parts) const
  {
    Index port = grid_.vertices()[q].firstPort;
    grid_.forEachSector(q,
      [&](const Sector& sector)
      {
        for (int i = 0; i < sector.count; ++i, ++port)
        {
          const int direction = (sector.firstDirection + i) & 3;
          collectCell(port, sector, direction, parts.cells);
          collectLine(port, sector, direction, parts.lines);
        }
      });
  }

private:
  Index vertexOf(Index port) const { return root_[cells_.vertex[port]]; }

  void collectCell(Index port, const Sector& sector, int direction, std::vector<Cell>& list) const
  {
    std::array<Index, 4> ports;
    if (!closedCell(cells_, port, ports))
    {
      return;
    }
    Cell cell;
    for (std::size_t i = 0; i < 4; ++i)
    {
      cell.corners[i] = vertexOf(ports[i]);
    }
    const std::optional<CellCentre> centre = findCentre(map_, sector, direction, stepLimit_);
    cell.face = centre ? centre->face : sector.face;
    if (centre)
    {
      cell.weights = weightsInFace(map_, centre->face, centre->uv);
    }
    list.push_back(cell);
  }

  void collectLine(Index port, const Sector& sector, int direction, std::vector<Line>& list) const
  {
    const Index next = cells_.next[port];
    if (next == kInvalidIndex || !runsAlong(map_, sector, direction) ||
      !map_.mesh.isConstrained(sector.halfEdge))
    {
      return;
    }
    list.push_back(
      { vertexOf(port), vertexOf(next), sector.halfEdge, map_.mesh.isBoundary(sector.halfEdge) });
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  const CellCorners& cells_;
  const std::vector<Index>& root_;
  std::size_t stepLimit_;
};

Parts collect(const Collector& collector, std::size_t vertexCount, int threads)
{
  std::vector<Parts> parts((vertexCount + kChunk - 1) / kChunk);
  parallelFor(vertexCount, kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t q = begin; q < end; ++q)
      {
        collector.visitVertex(static_cast<Index>(q), parts[begin / kChunk]);
      }
    });
  Parts whole;
  for (const Parts& part : parts)
  {
    whole.cells.insert(whole.cells.end(), part.cells.begin(), part.cells.end());
    whole.lines.insert(whole.lines.end(), part.lines.begin(), part.lines.end());
  }
  return whole;
}

/// Cycles of the corner relation that are no quads.
std::size_t countOtherCycles(const std::vector<Index>& next)
{
  std::vector<Index> seenFrom(next.size(), kInvalidIndex);
  std::size_t others = 0;
  for (Index start = 0; start < next.size(); ++start)
  {
    Index p = start;
    while (p != kInvalidIndex && seenFrom[p] == kInvalidIndex)
    {
      seenFrom[p] = start;
      p = next[p];
    }
    if (p != kInvalidIndex && seenFrom[p] == start)
    {
      int length = 1;
      for (Index q = next[p]; q != p && length < 5; q = next[q])
      {
        ++length;
      }
      others += length != 4 ? 1 : 0;
    }
  }
  return others;
}

/// Drops cells that collapsed when vertices were joined, and all but the first over the same
/// vertices.
std::size_t dropCollapsedAndDouble(std::vector<Cell>& cells)
{
  struct Key
  {
    std::array<Index, 4> corners;
    std::size_t cell;
  };
  std::vector<Key> keys;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    std::array<Index, 4> corners = cells[i].corners;
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) == corners.end())
    {
      keys.push_back({ corners, i });
    }
  }
  std::sort(keys.begin(), keys.end(),
    [](const Key& a, const Key& b)
    { return std::tie(a.corners, a.cell) < std::tie(b.corners, b.cell); });
  keys.erase(std::unique(keys.begin(), keys.end(),
               [](const Key& a, const Key& b) { return a.corners == b.corners; }),
    keys.end());
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.cell < b.cell; });

  std::vector<Cell> kept;
  for (const Key& key : keys)
  {
    kept.push_back(cells[key.cell]);
  }
  const std::size_t dropped = cells.size() - kept.size();
  cells.swap(kept);
  return dropped;
}

// ------------------------------------------------------------------ points

std::array<double, 3> weightsOnEdge(const ExactMap& map, const GridVertex& vertex)
{
  const FixedVec2 e = map.edge(vertex.site);
  const FixedVec2 d = vertex.uv - map.at(vertex.site);
  const bool byU = std::abs(e.u) >= std::abs(e.v);
  const double t = byU ? static_cast<double>(d.u) / static_cast<double>(e.u)
                       : static_cast<double>(d.v) / static_cast<double>(e.v);
  std::array<double, 3> weights{};
  weights[vertex.site % 3] = 1 - t;
  weights[Mesh::next(vertex.site) % 3] = t;
  return weights;
}

/// Numbers the grid vertices that cells use, and places them. Returns point ids per grid vertex.
std::vector<Index> makePoints(const ExactMap& map, const GridVertices& grid,
  const std::vector<Cell>& cells, int threads, QuadMesh& mesh)
{
  std::vector<Index> pointOf(grid.vertices().size(), kInvalidIndex);
  for (const Cell& cell : cells)
  {
    for (const Index q : cell.corners)
    {
      pointOf[q] = 0;
    }
  }
  std::vector<Index> used;
  for (Index q = 0; q < pointOf.size(); ++q)
  {
    if (pointOf[q] != kInvalidIndex)
    {
      pointOf[q] = static_cast<Index>(used.size());
      used.push_back(q);
    }
  }
  mesh.points.resize(used.size());
  mesh.sourceFace.resize(used.size());
  mesh.sourceWeights.resize(used.size());
  parallelFor(used.size(), kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const SurfacePoint place = placeOf(map, grid.vertices()[used[i]]);
        mesh.sourceFace[i] = place.face;
        mesh.sourceWeights[i] = place.weights;
        mesh.points[i] = positionOf(map.mesh, place);
      }
    });
  return pointOf;
}

// ------------------------------------------------------------------ lines

/// Both sides of a feature see each line, in opposite directions: the one that ascends is kept.
void makeLines(
  const std::vector<Line>& lines, const std::vector<Index>& pointOf, bool tolerant, QuadMesh& mesh)
{
  for (const Line& line : lines)
  {
    const Index a = pointOf[line.a];
    const Index b = pointOf[line.b];
    if (a == kInvalidIndex || b == kInvalidIndex || (tolerant && a == b))
    {
      continue;
    }
    if (line.boundary || a < b)
    {
      mesh.lines.push_back({ a, b, line.halfEdge, line.boundary });
    }
    else if (tolerant) // a fold may have swallowed the other side
    {
      mesh.lines.push_back({ b, a, line.halfEdge, line.boundary });
    }
  }
  if (tolerant)
  {
    const auto key = [](const QuadLine& l) { return std::tie(l.a, l.b); };
    std::stable_sort(mesh.lines.begin(), mesh.lines.end(),
      [&](const QuadLine& l, const QuadLine& m) { return key(l) < key(m); });
    mesh.lines.erase(std::unique(mesh.lines.begin(), mesh.lines.end(),
                       [&](const QuadLine& l, const QuadLine& m) { return key(l) == key(m); }),
      mesh.lines.end());
  }
}

} // namespace

SurfacePoint placeOf(const ExactMap& map, const GridVertex& vertex)
{
  std::array<double, 3> weights{};
  if (vertex.kind == Site::Face)
  {
    weights = weightsInFace(map, vertex.site, vertex.uv);
  }
  else if (vertex.kind == Site::Edge)
  {
    weights = weightsOnEdge(map, vertex);
  }
  else
  {
    weights[vertex.site % 3] = 1;
  }
  return { vertex.face(), weights };
}

std::vector<Index> assembleQuads(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
  const AssemblyOptions& options, ExtractionResult& result)
{
  const std::vector<Index> root = mergeClasses(map.mesh, grid, cells.merged);
  for (Index q = 0; q < root.size(); ++q)
  {
    result.mergedVertices += root[q] != q ? 1 : 0;
  }
  Parts parts = collect(Collector(map, grid, cells, root), grid.vertices().size(), options.threads);

  result.openPorts =
    static_cast<std::size_t>(std::count(cells.next.begin(), cells.next.end(), kInvalidIndex));
  if (4 * parts.cells.size() != cells.next.size())
  {
    result.droppedFaces = countOtherCycles(cells.next);
  }
  if (options.tolerant)
  {
    result.droppedFaces += dropCollapsedAndDouble(parts.cells);
  }

  QuadMesh& mesh = result.mesh;
  std::vector<Index> pointOf = makePoints(map, grid, parts.cells, options.threads, mesh);
  for (const Cell& cell : parts.cells)
  {
    mesh.quads.push_back({ pointOf[cell.corners[0]], pointOf[cell.corners[1]],
      pointOf[cell.corners[2]], pointOf[cell.corners[3]] });
    mesh.quadSourceFace.push_back(cell.face);
    mesh.quadSourceWeights.push_back(cell.weights);
  }
  makeLines(parts.lines, pointOf, options.tolerant, mesh);
  for (Index q = 0; q < root.size(); ++q)
  {
    pointOf[q] = pointOf[root[q]];
  }
  return pointOf;
}

} // namespace quadrille
