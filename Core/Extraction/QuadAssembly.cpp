// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/QuadAssembly.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Extraction/CurveLines.h"
#include "Extraction/FoldedCells.h"
#include "Extraction/GridVertices.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <tuple>

namespace quadrille
{
namespace
{

// ------------------------------------------------------------------ cells

struct Cell
{
  std::array<Index, 4> corners;    ///< grid vertices
  Index face;                      ///< under its centre
  std::array<double, 3> weights{}; ///< of the centre in that face; all zero where it is not known
};

struct Parts
{
  std::vector<Cell> cells;
  std::vector<CurveLine> lines;
};

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
  /// found: the cells of a folded map, else null.
  Collector(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
    const FoldedCells* found)
    : map_(map), grid_(grid), cells_(cells), found_(found),
      stepLimit_(3 * std::size_t{ map.mesh.faceCount() } + 16)
  {
    if (found)
    {
      cellOf_.assign(cells.next.size(), kInvalidIndex);
      for (Index i = 0; i < found->port.size(); ++i)
      {
        cellOf_[found->port[i]] = i;
      }
    }
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
  /// The corners of the cell that is to be collected at this port, its lowest.
  bool cornersOf(Index port, std::array<Index, 4>& corners) const
  {
    if (found_)
    {
      const Index cell = cellOf_[port];
      corners = cell != kInvalidIndex ? found_->corners[cell] : corners;
      return cell != kInvalidIndex;
    }
    std::array<Index, 4> ports;
    if (!cellOf(cells_, port, true, ports))
    {
      return false;
    }
    for (std::size_t i = 0; i < 4; ++i)
    {
      corners[i] = cells_.vertex[ports[i]];
    }
    return true;
  }

  void collectCell(Index port, const Sector& sector, int direction, std::vector<Cell>& list) const
  {
    Cell cell;
    if (!cornersOf(port, cell.corners))
    {
      return;
    }
    const std::optional<CellCentre> centre =
      findCentre(map_, sector, direction, found_ != nullptr, stepLimit_);
    cell.face = centre ? centre->face : sector.face;
    if (centre)
    {
      cell.weights = weightsInFace(map_, centre->face, centre->uv);
    }
    list.push_back(cell);
  }

  /// Both sides of a feature see each line, in opposite directions: the one that ascends is kept.
  void collectLine(
    Index port, const Sector& sector, int direction, std::vector<CurveLine>& list) const
  {
    const Index next = cells_.next[port];
    if (found_ || next == kInvalidIndex || !runsAlong(map_, sector, direction) ||
      !map_.mesh.isConstrained(sector.halfEdge))
    {
      return;
    }
    const Index a = cells_.vertex[port];
    const Index b = cells_.vertex[next];
    const bool boundary = map_.mesh.isBoundary(sector.halfEdge);
    if (boundary || a < b)
    {
      list.push_back({ a, b, sector.halfEdge, boundary });
    }
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  const CellCorners& cells_;
  const FoldedCells* found_;
  std::size_t stepLimit_;
  std::vector<Index> cellOf_; ///< per port of a folded map: its number in found_
};

/// In the order of the grid vertices.
std::vector<Parts> collect(const Collector& collector, std::size_t vertexCount, int threads)
{
  return parallelParts<Parts>(vertexCount, kHeavyChunk, threads,
    [&](std::size_t begin, std::size_t end, Parts& part)
    {
      for (std::size_t q = begin; q < end; ++q)
      {
        collector.visitVertex(static_cast<Index>(q), part);
      }
    });
}

std::size_t countCells(const std::vector<Parts>& parts)
{
  std::size_t count = 0;
  for (const Parts& part : parts)
  {
    count += part.cells.size();
  }
  return count;
}

/// Calls body(part, first cell of the part among all), by all threads.
template <typename Body>
void forEachPart(const std::vector<Parts>& parts, int threads, const Body& body)
{
  std::vector<std::size_t> first(1, 0);
  for (const Parts& part : parts)
  {
    first.push_back(first.back() + part.cells.size());
  }
  parallelForEach(parts.size(), 1, threads, [&](std::size_t i) { body(parts[i], first[i]); });
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

// ------------------------------------------------------------------ points

/// The grid vertices that cells use, ascending.
std::vector<Index> usedVertices(
  const std::vector<Parts>& parts, std::size_t vertexCount, int threads)
{
  std::vector<std::atomic<std::uint8_t>> isUsed(vertexCount); // zero
  forEachPart(parts, threads,
    [&](const Parts& part, std::size_t)
    {
      for (const Cell& cell : part.cells)
      {
        for (const Index q : cell.corners)
        {
          isUsed[q].store(1, std::memory_order_relaxed);
        }
      }
    });
  return idsWhere(
    vertexCount, [&](Index q) { return isUsed[q].load(std::memory_order_relaxed) != 0; });
}

/// Places the grid vertices that cells use. Returns point ids per grid vertex.
std::vector<Index> makePoints(const ExactMap& map, const GridVertices& grid,
  const std::vector<Parts>& parts, int threads, QuadMesh& mesh)
{
  const std::vector<Index> used = usedVertices(parts, grid.vertices().size(), threads);
  std::vector<Index> pointOf(grid.vertices().size(), kInvalidIndex);
  mesh.points.resize(used.size());
  mesh.sourceFace.resize(used.size());
  mesh.sourceWeights.resize(used.size());
  parallelForEach(used.size(), kHeavyChunk, threads,
    [&](std::size_t i)
    {
      pointOf[used[i]] = static_cast<Index>(i);
      const SurfacePoint place = placeOf(map, grid.vertices()[used[i]]);
      mesh.sourceFace[i] = place.face;
      mesh.sourceWeights[i] = place.weights;
      mesh.points[i] = positionOf(map.mesh, place);
    });
  return pointOf;
}

void makeQuads(
  const std::vector<Parts>& parts, const std::vector<Index>& pointOf, int threads, QuadMesh& mesh)
{
  const std::size_t count = countCells(parts);
  mesh.quads.resize(count);
  mesh.quadSourceFace.resize(count);
  mesh.quadSourceWeights.resize(count);
  forEachPart(parts, threads,
    [&](const Parts& part, std::size_t id)
    {
      for (const Cell& cell : part.cells)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          mesh.quads[id][i] = pointOf[cell.corners[i]];
        }
        mesh.quadSourceFace[id] = cell.face;
        mesh.quadSourceWeights[id] = cell.weights;
        ++id;
      }
    });
}

// ------------------------------------------------------------------ lines

/// The lines of a folded map between the vertices that stand for the copies. A line that a curve walks there
/// and back again is not part of it.
std::vector<CurveLine> mergedLines(
  const std::vector<CurveLine>& curves, const std::vector<Index>& root)
{
  std::vector<CurveLine> lines;
  for (CurveLine line : curves)
  {
    line.a = root[line.a];
    line.b = root[line.b];
    if (line.a != line.b)
    {
      lines.push_back(line);
    }
  }
  const auto key = [](const CurveLine& l)
  { return std::make_tuple(std::min(l.a, l.b), std::max(l.a, l.b), l.halfEdge); };
  std::sort(lines.begin(), lines.end(),
    [&](const CurveLine& l, const CurveLine& m) { return key(l) < key(m); });
  std::vector<CurveLine> odd;
  for (std::size_t i = 0, end = 0; i < lines.size(); i = end)
  {
    while (end < lines.size() &&
      std::minmax(lines[end].a, lines[end].b) == std::minmax(lines[i].a, lines[i].b))
    {
      ++end;
    }
    if ((end - i) % 2 != 0)
    {
      odd.push_back(lines[i]);
    }
  }
  return odd;
}

void makeLines(
  const std::vector<CurveLine>& lines, const std::vector<Index>& pointOf, QuadMesh& mesh)
{
  for (const CurveLine& line : lines)
  {
    const Index a = pointOf[line.a];
    const Index b = pointOf[line.b];
    if (a != kInvalidIndex && b != kInvalidIndex)
    {
      mesh.lines.push_back({ a, b, line.halfEdge, line.boundary });
    }
  }
}

} // namespace

std::vector<Index> assembleQuads(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, const AssemblyOptions& options, ExtractionResult& result)
{
  std::vector<CurveLine> curves;
  std::optional<FoldedCells> found;
  if (options.folded)
  {
    curves = findCurveLines(map, grid);
    found = findFoldedCells(map, grid, cells, curves);
    result.zeroSides = cells.zeroSides;
    result.mergedVertices = found->mergedVertices;
    result.zippedSides = found->zippedSides;
    result.cancelledQuads = found->cancelled;
    result.droppedFaces = found->dropped;
  }
  const Collector collector(map, grid, cells, found ? &*found : nullptr);
  const std::vector<Parts> parts = collect(collector, grid.vertices().size(), options.threads);

  result.openPorts =
    static_cast<std::size_t>(std::count(cells.next.begin(), cells.next.end(), kInvalidIndex));
  if (!found && 4 * countCells(parts) != cells.next.size())
  {
    result.droppedFaces = countOtherCycles(cells.next);
  }

  QuadMesh& mesh = result.mesh;
  std::vector<Index> pointOf = makePoints(map, grid, parts, options.threads, mesh);
  makeQuads(parts, pointOf, options.threads, mesh);
  if (found)
  {
    makeLines(mergedLines(curves, found->root), pointOf, mesh);
  }
  for (const Parts& part : parts)
  {
    makeLines(part.lines, pointOf, mesh);
  }
  for (Index q = 0; found && q < pointOf.size(); ++q)
  {
    pointOf[q] = pointOf[found->root[q]];
  }
  return pointOf;
}

} // namespace quadrille
