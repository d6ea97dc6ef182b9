// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/GridTracing.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <atomic>

namespace quadrille
{
namespace
{

enum class Step
{
  Arrived,
  Crossed,
  Lost
};

template <bool kFolded>
Step step(const ExactMap& map, Walk& walk)
{
  const Index exit = exitEdge(map, walk);
  if (exit == kInvalidIndex)
  {
    return Step::Lost;
  }
  int sign = 1;
  if constexpr (kFolded)
  {
    sign = map.orientationOf(walk.face);
    if (sign == -walk.orientation)
    {
      std::swap(walk.origin, walk.target);
      walk.direction = (walk.direction + 2) & 3;
      walk.orientation = sign;
    }
  }
  if (sign != 0 && isBefore(map, walk, exit))
  {
    return Step::Arrived;
  }
  Transition t;
  if (!map.transition(exit, t))
  {
    return Step::Lost;
  }
  walk.target = t.apply(walk.target);
  if constexpr (kFolded)
  {
    walk.origin = t.apply(walk.origin);
  }
  walk.direction = (walk.direction + t.rotation) & 3;
  walk.face = Mesh::face(map.mesh.twin[exit]);
  return Step::Crossed;
}

/// Walks until the triangle that contains the corner at the end. False when the line ends before, at a boundary or
/// where images do not match, or after maximumSteps triangles. Adds the number of triangles to `steps`.
template <bool kFolded>
bool follow(const ExactMap& map, Walk& walk, std::size_t maximumSteps, std::size_t& steps)
{
  for (std::size_t i = 0; i < maximumSteps; ++i)
  {
    ++steps;
    const Step result = step<kFolded>(map, walk);
    if (result != Step::Crossed)
    {
      return result == Step::Arrived;
    }
  }
  return false;
}

/// Traces the ports of a range of grid vertices.
template <bool kFolded>
class RangeTracer
{
public:
  RangeTracer(const ExactMap& map, const GridVertices& grid, const TracingOptions& options,
    std::size_t begin, std::size_t end, CellCorners& cells)
    : map_(map), grid_(grid), options_(options), begin_(begin), end_(end), cells_(cells)
  {
  }

  /// Returns the number of triangles that the walks crossed.
  std::size_t traceVertex(Index q)
  {
    std::size_t steps = 0;
    Index port = grid_.vertices()[q].firstPort;
    grid_.forEachSector(q,
      [&](const Sector& sector)
      {
        for (int i = 0; i < sector.count; ++i, ++port)
        {
          cells_.vertex[port] = q;
          if constexpr (kFolded)
          {
            cells_.orientation[port] = static_cast<std::int8_t>(sector.orientation);
          }
          if (cells_.next[port] == kInvalidIndex)
          {
            trace(q, port, startOf(sector, sector.firstDirection + i), steps);
          }
        }
      });
    return steps;
  }

private:
  void trace(Index q, Index port, Walk walk, std::size_t& steps)
  {
    if (!follow<kFolded>(map_, walk, options_.maximumSteps, steps))
    {
      return;
    }
    const std::optional<Index> end = grid_.find(walk.face, walk.target);
    const std::optional<Index> next =
      end ? grid_.findPort(*end, walk.face, walk.target, walk.arrivalPort()) : std::nullopt;
    if (!next)
    {
      return;
    }
    cells_.next[port] = *next;
    if (options_.valid && begin_ <= *end && *end < end_)
    {
      setOtherSide(q, port, *end, *next);
    }
  }

  /// In a valid map the side of the cell beyond the isoline runs back between the ports beside these:
  ///
  ///       port  |        | next              . it comes from the one after next and leads to the one
  ///        q ---+--------+--- end            . before port, counterclockwise
  ///      before |        | after
  void setOtherSide(Index q, Index port, Index end, Index next)
  {
    const std::optional<Index> before = grid_.portBefore(q, port);
    const std::optional<Index> after = grid_.portAfter(end, next);
    if (before && after)
    {
      cells_.next[*after] = *before;
    }
  }

  const ExactMap& map_;
  const GridVertices& grid_;
  const TracingOptions& options_;
  std::size_t begin_;
  std::size_t end_;
  CellCorners& cells_;
};

template <bool kFolded>
std::size_t traceRange(const ExactMap& map, const GridVertices& grid, const TracingOptions& options,
  std::size_t begin, std::size_t end, std::size_t maximumSteps, CellCorners& cells)
{
  RangeTracer<kFolded> tracer(map, grid, options, begin, end, cells);
  std::size_t steps = 0;
  for (std::size_t q = begin; q < end && steps <= maximumSteps; ++q)
  {
    steps += tracer.traceVertex(static_cast<Index>(q));
  }
  return steps;
}

/// The grid vertices on a triangle without area that share a place are one vertex.
void mergeOnFlatFace(const ExactMap& map, const GridVertices& grid, Index f, CellCorners& cells)
{
  std::vector<std::pair<FixedVec2, Index>> found;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (const std::optional<Index> q = grid.findCorner(h))
    {
      found.emplace_back(map.at(h), *q);
    }
    grid.forEachOnEdge(h, [&](Index q, FixedVec2 point) { found.emplace_back(point, q); });
  }
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (found[i].first == found[j].first)
      {
        cells.merged.emplace_back(found[j].second, found[i].second);
      }
    }
  }
}

void collectMerges(const ExactMap& map, const GridVertices& grid, CellCorners& cells)
{
  for (Index port = 0; port < cells.next.size(); ++port)
  {
    const Index next = cells.next[port];
    if (next != kInvalidIndex && cells.isZero(port))
    {
      ++cells.zeroSides;
      if (cells.vertex[port] != cells.vertex[next])
      {
        cells.merged.emplace_back(cells.vertex[port], cells.vertex[next]);
      }
    }
  }
  for (Index f = 0; f < map.mesh.faceCount(); ++f)
  {
    if (map.orientationOf(f) == 0)
    {
      mergeOnFlatFace(map, grid, f, cells);
    }
  }
}

} // namespace

bool cellOf(const CellCorners& cells, Index port, bool isLowest, std::array<Index, 4>& ports)
{
  ports[0] = port;
  for (std::size_t i = 1; i < 4; ++i)
  {
    ports[i] = cells.next[ports[i - 1]];
    if (ports[i] == kInvalidIndex || (isLowest && ports[i] <= port))
    {
      return false;
    }
  }
  return cells.next[ports[3]] == port;
}

Walk startOf(const Sector& sector, int direction)
{
  // An inverted triangle is walked the other way round: away from the corner across its port's side.
  Walk walk;
  walk.face = sector.face;
  walk.orientation = sector.orientation;
  walk.direction = (sector.orientation > 0 ? direction : direction + 1) & 3;
  walk.origin = sector.point;
  walk.target = sector.point + axisVector(walk.direction);
  return walk;
}

CellCorners traceCells(const ExactMap& map, const GridVertices& grid, const TracingOptions& options)
{
  CellCorners cells;
  cells.next.assign(grid.portCount(), kInvalidIndex);
  cells.vertex.assign(grid.portCount(), kInvalidIndex);
  cells.orientation.assign(options.folded ? grid.portCount() : 0, 1);
  // Whether the sum passes the limit does not depend on the order of the threads.
  std::atomic<std::size_t> steps{ 0 };
  parallelFor(grid.vertices().size(), kHeavyChunk, options.threads,
    [&](std::size_t begin, std::size_t end)
    {
      const std::size_t done = std::min<std::size_t>(steps, options.maximumSteps);
      const std::size_t left = options.maximumSteps - done;
      steps += options.folded ? traceRange<true>(map, grid, options, begin, end, left, cells)
                              : traceRange<false>(map, grid, options, begin, end, left, cells);
    });
  cells.exhausted = steps > options.maximumSteps;
  if (options.folded && !cells.exhausted)
  {
    collectMerges(map, grid, cells);
  }
  return cells;
}

std::optional<CellCentre> findCentre(
  const ExactMap& map, const Sector& sector, int direction, bool folded, std::size_t maximumSteps)
{
  const auto half = [](int axis)
  {
    const FixedVec2 e = axisVector(axis);
    return FixedVec2{ e.u / 2, e.v / 2 };
  };
  std::size_t steps = 0;
  const auto reach = [&](Walk& walk)
  {
    return (folded ? follow<true>(map, walk, maximumSteps, steps)
                   : follow<false>(map, walk, maximumSteps, steps)) &&
      walk.orientation == sector.orientation;
  };
  Walk walk = startOf(sector, direction);
  walk.target = walk.origin + half(walk.direction);
  if (!reach(walk))
  {
    return std::nullopt;
  }
  walk.direction = walk.inside() & 3;
  walk.origin = walk.target;
  walk.target = walk.origin + half(walk.direction);
  if (!reach(walk))
  {
    return std::nullopt;
  }
  return CellCentre{ walk.face, walk.target };
}

} // namespace quadrille
