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

constexpr std::size_t kChunk = 1 << 10;
/// Valid maps of real surfaces need about three steps per triangle and port.
constexpr std::size_t kStepsPerElement = 20;

/// Is x left of the moved line?
bool isLeft(const Walk& walk, FixedVec2 x)
{
  return along(x - walk.target, walk.direction + 1) > 0;
}

/// The half-edge of walk.face through which the line leaves.
Index exitEdge(const ExactMap& map, const Walk& walk, bool positive)
{
  const Index h = 3 * walk.face;
  const std::array<bool, 3> left{ isLeft(walk, map.at(h)), isLeft(walk, map.at(h + 1)),
    isLeft(walk, map.at(h + 2)) };
  for (Index i = 0; i < 3; ++i)
  {
    const bool from = left[i];
    const bool to = left[(i + 1) % 3];
    if (positive ? !from && to : from != to && h + i != walk.entry)
    {
      return h + i;
    }
  }
  return kInvalidIndex;
}

/// Does the target, moved by e to the left and by e^2 back, lie before the exit edge h?
bool isBefore(const ExactMap& map, const Walk& walk, Index h)
{
  const int side = orientation(map.at(h), map.at(Mesh::next(h)), walk.target);
  // On the edge's line it depends on whether the edge leans forward; an edge across the line is
  // decided by the step back.
  return side > 0 || (side == 0 && along(map.edge(h), walk.direction) >= 0);
}

enum class Step
{
  Arrived,
  Crossed,
  Lost
};

Step step(const ExactMap& map, Walk& walk)
{
  const bool positive = map.orientationOf(walk.face) > 0;
  const Index exit = exitEdge(map, walk, positive);
  if (exit == kInvalidIndex)
  {
    return Step::Lost;
  }
  if (positive && isBefore(map, walk, exit))
  {
    return Step::Arrived;
  }
  Transition t;
  if (!map.transition(exit, t))
  {
    return Step::Lost;
  }
  walk.target = t.apply(walk.target);
  walk.direction = (walk.direction + t.rotation) & 3;
  walk.entry = map.mesh.twin[exit];
  walk.face = Mesh::face(walk.entry);
  return Step::Crossed;
}

/// Is the closed triangle's image over x? Any orientation.
bool covers(const ExactMap& map, Index f, FixedVec2 x)
{
  int lowest = 1;
  int highest = -1;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    const int side = orientation(map.at(h), map.at(Mesh::next(h)), x);
    lowest = std::min(lowest, side);
    highest = std::max(highest, side);
  }
  return lowest >= 0 || highest <= 0;
}

using Pairs = std::vector<std::pair<Index, Index>>;

/// A walk that also collects the grid vertices over the start of the side in triangles further on.
bool followAndCollect(const ExactMap& map, const GridVertices& grid, Walk& walk,
  std::size_t maximumSteps, Index start, Pairs& merged, std::size_t& steps)
{
  for (std::size_t i = 0; i < maximumSteps; ++i)
  {
    ++steps;
    const FixedVec2 origin = walk.target - axisVector(walk.direction);
    if (covers(map, walk.face, origin))
    {
      const std::optional<Index> copy = grid.find(walk.face, origin);
      if (copy && *copy != start)
      {
        merged.emplace_back(start, *copy);
      }
    }
    const Step result = step(map, walk);
    if (result != Step::Crossed)
    {
      return result == Step::Arrived;
    }
  }
  return false;
}

/// A line crosses a triangle of a valid map at most once per unit; folds can lengthen it, but a
/// line that needs more than this belongs to no mesh.
std::size_t stepLimit(const ExactMap& map, bool tolerant)
{
  const std::size_t whole = 3 * std::size_t{ map.mesh.faceCount() } + 16;
  return tolerant ? std::min<std::size_t>(whole, 100000) : whole;
}

/// Returns the number of triangles that a tolerant run visited.
std::size_t traceVertex(const ExactMap& map, const GridVertices& grid, Index q, bool tolerant,
  CellCorners& cells, Pairs& merged)
{
  const std::size_t limit = stepLimit(map, tolerant);
  std::size_t steps = 0;
  Index port = grid.vertices()[q].firstPort;
  grid.forEachSector(q,
    [&](const Sector& sector)
    {
      for (int i = 0; i < sector.count; ++i, ++port)
      {
        const int direction = (sector.firstDirection + i) & 3;
        Walk walk{ sector.face, sector.point + axisVector(direction), direction, kInvalidIndex };
        const bool arrived = tolerant ? followAndCollect(map, grid, walk, limit, q, merged, steps)
                                      : follow(map, walk, limit);
        cells.vertex[port] = q;
        if (arrived)
        {
          cells.next[port] =
            grid.findPort(walk.face, walk.target, walk.direction + 1).value_or(kInvalidIndex);
        }
      }
    });
  return steps;
}

/// Both ends of an edge whose image is a single integer point are one vertex.
void mergeZeroEdges(const ExactMap& map, const GridVertices& grid, Pairs& merged)
{
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    if (map.edge(h) == FixedVec2{} && isInteger(map.at(h)))
    {
      const std::optional<Index> a = grid.findCorner(h);
      const std::optional<Index> b = grid.findCorner(Mesh::next(h));
      if (a && b)
      {
        merged.emplace_back(*a, *b);
      }
    }
  }
}

} // namespace

bool follow(const ExactMap& map, Walk& walk, std::size_t maximumSteps)
{
  for (std::size_t i = 0; i < maximumSteps; ++i)
  {
    const Step result = step(map, walk);
    if (result != Step::Crossed)
    {
      return result == Step::Arrived;
    }
  }
  return false;
}

CellCorners traceCells(const ExactMap& map, const GridVertices& grid, bool tolerant, int threads)
{
  CellCorners cells;
  cells.next.assign(grid.portCount(), kInvalidIndex);
  cells.vertex.assign(grid.portCount(), kInvalidIndex);
  const std::size_t count = grid.vertices().size();
  // Each side of a cell crosses few triangles on average, whatever the sizes. Whether the sum
  // passes the limit does not depend on the order of the threads.
  const std::size_t budget =
    kStepsPerElement * (std::size_t{ map.mesh.faceCount() } + grid.portCount());
  std::atomic<std::size_t> steps{ 0 };
  std::vector<Pairs> merged((count + kChunk - 1) / kChunk);
  parallelFor(count, kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t q = begin; q < end && steps <= budget; ++q)
      {
        steps +=
          traceVertex(map, grid, static_cast<Index>(q), tolerant, cells, merged[begin / kChunk]);
      }
    });
  cells.exhausted = steps > budget;
  for (const Pairs& part : merged)
  {
    cells.merged.insert(cells.merged.end(), part.begin(), part.end());
  }
  if (tolerant)
  {
    mergeZeroEdges(map, grid, cells.merged);
  }
  return cells;
}

std::optional<CellCentre> findCentre(
  const ExactMap& map, const Sector& sector, int direction, std::size_t maximumSteps)
{
  const auto half = [](int axis)
  {
    const FixedVec2 e = axisVector(axis);
    return FixedVec2{ e.u / 2, e.v / 2 };
  };
  Walk walk{ sector.face, sector.point + half(direction), direction & 3, kInvalidIndex };
  if (!follow(map, walk, maximumSteps))
  {
    return std::nullopt;
  }
  walk.direction = (walk.direction + 1) & 3;
  walk.target = walk.target + half(walk.direction);
  walk.entry = kInvalidIndex;
  if (!follow(map, walk, maximumSteps))
  {
    return std::nullopt;
  }
  return CellCentre{ walk.face, walk.target };
}

} // namespace quadrille
