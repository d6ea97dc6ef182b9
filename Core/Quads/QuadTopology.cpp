// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadTopology.h"

#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

namespace quadrille
{
namespace
{

using Quads = std::vector<std::array<Index, 4>>;

/// The corners of quads: corner, and half-edge, 4q + i.
struct QuadCorners
{
  const Quads& quads;

  std::size_t cells() const { return quads.size(); }
  Index firstOf(std::size_t cell) const { return static_cast<Index>(4 * cell); }
  Index point(Index h) const { return quads[h / 4][h % 4]; }
  Index next(Index h) const { return nextInQuad(h); }
  Index previous(Index h) const { return previousInQuad(h); }
};

/// The corners of quads and polygons in one list, quads first.
class CellCornerList
{
public:
  explicit CellCornerList(const QuadMesh& mesh)
  {
    for (const std::array<Index, 4>& quad : mesh.quads)
    {
      addCell(quad.begin(), quad.end());
    }
    for (std::size_t i = 0; i + 1 < mesh.polygonOffsets.size(); ++i)
    {
      addCell(mesh.polygonPoints.begin() + mesh.polygonOffsets[i],
        mesh.polygonPoints.begin() + mesh.polygonOffsets[i + 1]);
    }
    for (const Index p : point_)
    {
      refuseIf(p >= mesh.points.size(), "a cell refers to point ", p, " of ", mesh.points.size());
    }
  }

  std::size_t cells() const { return first_.size() - 1; }
  Index firstOf(std::size_t cell) const { return first_[cell]; }
  Index point(Index h) const { return point_[h]; }
  Index next(Index h) const { return next_[h]; }
  Index previous(Index h) const { return previous_[h]; }

private:
  template <typename Iterator>
  void addCell(Iterator begin, Iterator end)
  {
    const Index first = first_.back();
    const Index count = static_cast<Index>(end - begin);
    for (Index i = 0; i < count; ++i)
    {
      point_.push_back(begin[i]);
      next_.push_back(first + (i + 1) % count);
      previous_.push_back(first + (i + count - 1) % count);
    }
    first_.push_back(first + count);
  }

  std::vector<Index> point_, next_, previous_;
  std::vector<Index> first_{ 0 }; ///< #cells + 1
};

/// The half-edges that leave each point, as lists that all threads make at once; their order is that of the threads.
class LeavingHalfEdges
{
public:
  template <class Cells>
  LeavingHalfEdges(const Cells& cells, std::size_t pointCount, int threads)
    : first_(new std::atomic<Index>[pointCount]), next_(cells.firstOf(cells.cells()))
  {
    parallelForEach(pointCount, kMediumChunk, threads,
      [this](std::size_t p) { first_[p].store(kInvalidIndex, std::memory_order_relaxed); });
    const std::size_t wrong = firstRefused(next_.size(), kMediumChunk, threads,
      [&](std::size_t i)
      {
        const Index h = static_cast<Index>(i);
        const Index p = cells.point(h);
        if (p < pointCount)
        {
          next_[h] = first_[p].exchange(h, std::memory_order_relaxed);
        }
        return p < pointCount;
      });
    if (wrong < next_.size())
    {
      refuse("quad ", wrong / 4, " refers to point ", cells.point(static_cast<Index>(wrong)),
        " of ", pointCount);
    }
  }

  Index first(std::size_t p) const { return first_[p].load(std::memory_order_relaxed); }
  Index next(Index h) const { return next_[h]; }

private:
  std::unique_ptr<std::atomic<Index>[]> first_;
  std::vector<Index> next_;
};

/// A half-edge and the point at its other end.
using Spoke = std::pair<Index, Index>;

/// The half-edges that leave a point and those that arrive, by their other ends.
struct Star
{
  std::vector<Spoke> out;
  std::vector<Spoke> in;

  template <class Cells>
  void gather(const Cells& cells, const LeavingHalfEdges& corners, std::size_t p)
  {
    out.clear();
    in.clear();
    for (Index h = corners.first(p); h != kInvalidIndex; h = corners.next(h))
    {
      const Index before = cells.previous(h);
      out.emplace_back(cells.point(cells.next(h)), h);
      in.emplace_back(cells.point(before), before);
    }
    std::sort(out.begin(), out.end());
    std::sort(in.begin(), in.end());
  }
};

using SpokeRange = std::vector<Spoke>::const_iterator;

SpokeRange endOfRun(SpokeRange begin, SpokeRange end)
{
  SpokeRange last = begin;
  while (last != end && last->first == begin->first)
  {
    ++last;
  }
  return last;
}

/// The edges between p and one neighbour: `out` half-edges leave along them, `in` arrive.
void countEdge(Index p, Index neighbour, SpokeRange outBegin, SpokeRange outEnd, SpokeRange inBegin,
  SpokeRange inEnd, QuadTopology& topology, QuadCounts& counts)
{
  const std::ptrdiff_t out = outEnd - outBegin;
  const std::ptrdiff_t in = inEnd - inBegin;
  ++topology.valence[p];
  if (out == 0 || in == 0)
  {
    topology.onBoundary[p] = 1;
  }
  if (out == 0) // counted at the other end
  {
    return;
  }
  counts.edges += in == 0 || p < neighbour ? 1 : 0;
  counts.boundaryEdges += in == 0 && out == 1 ? 1 : 0;
  if (out > 1)
  {
    counts.nonManifoldEdges += static_cast<std::size_t>(out);
    counts.defectPoints.insert(counts.defectPoints.end(), static_cast<std::size_t>(out), p);
  }
  else if (in == 1)
  {
    topology.twin[outBegin->second] = inBegin->second;
  }
}

void visitStar(const Star& star, Index p, QuadTopology& topology, QuadCounts& counts)
{
  SpokeRange out = star.out.begin();
  SpokeRange in = star.in.begin();
  while (out != star.out.end() || in != star.in.end())
  {
    const bool leaves = out != star.out.end() && (in == star.in.end() || out->first <= in->first);
    const bool arrives = in != star.in.end() && (out == star.out.end() || in->first <= out->first);
    const SpokeRange outEnd = leaves ? endOfRun(out, star.out.end()) : out;
    const SpokeRange inEnd = arrives ? endOfRun(in, star.in.end()) : in;
    countEdge(p, leaves ? out->first : in->first, out, outEnd, in, inEnd, topology, counts);
    out = outEnd;
    in = inEnd;
  }
}

/// Size of the fan round the origin of h.
template <class Cells>
Index fanSize(const Cells& cells, const std::vector<Index>& twin, Index h)
{
  Index size = 1;
  Index g = twin[cells.previous(h)];
  for (; g != kInvalidIndex && g != h; g = twin[cells.previous(g)])
  {
    ++size;
  }
  if (g == h)
  {
    return size;
  }
  for (g = twin[h]; g != kInvalidIndex; g = twin[cells.next(g)])
  {
    ++size;
  }
  return size;
}

template <class Cells>
void checkFan(const Cells& cells, const LeavingHalfEdges& corners, Index p,
  const std::vector<Index>& twin, QuadCounts& counts)
{
  Index count = 0;
  for (Index h = corners.first(p); h != kInvalidIndex; h = corners.next(h))
  {
    ++count;
  }
  if (count == 0 || fanSize(cells, twin, corners.first(p)) != count)
  {
    ++(count == 0 ? counts.isolatedPoints : counts.nonManifoldVertices);
    counts.defectPoints.push_back(p);
  }
}

template <class Cells>
void checkCell(const Cells& cells, std::size_t cell, DisjointSets& sets, QuadCounts& counts)
{
  const Index first = cells.firstOf(cell);
  bool isDegenerate = false;
  for (Index h = first + 1; h < cells.firstOf(cell + 1); ++h)
  {
    for (Index g = first; g < h; ++g)
    {
      isDegenerate = isDegenerate || cells.point(g) == cells.point(h);
    }
    sets.join(cells.point(first), cells.point(h));
  }
  if (isDegenerate)
  {
    ++counts.degenerateQuads;
    counts.defectPoints.push_back(cells.point(first));
  }
}

/// Runs a check over chunks and adds what they count, in the order of the chunks.
template <typename Body>
void overChunks(std::size_t size, int threads, QuadTopology& topology, const Body& body)
{
  for (const QuadCounts& part : parallelParts<QuadCounts>(size, kMediumChunk, threads, body))
  {
    topology.add(part);
  }
}

template <class Next>
std::vector<std::vector<Index>> loopsOf(const std::vector<Index>& twin, const Next& next)
{
  std::vector<std::uint8_t> seen(twin.size(), 0);
  std::vector<std::vector<Index>> loops;
  for (Index h = 0; h < twin.size(); ++h)
  {
    if (twin[h] != kInvalidIndex || seen[h])
    {
      continue;
    }
    loops.emplace_back();
    for (Index g = h; !seen[g];)
    {
      seen[g] = 1;
      loops.back().push_back(g);
      g = next(g);
      while (twin[g] != kInvalidIndex)
      {
        g = next(twin[g]);
      }
    }
  }
  return loops;
}

template <class Cells>
QuadTopology analyze(const Cells& cells, std::size_t pointCount, int threads)
{
  QuadTopology topology;
  topology.valence.assign(pointCount, 0);
  topology.onBoundary.assign(pointCount, 0);
  topology.twin.assign(cells.firstOf(cells.cells()), kInvalidIndex);
  const LeavingHalfEdges corners(cells, pointCount, threads);
  overChunks(pointCount, threads, topology,
    [&](std::size_t begin, std::size_t end, QuadCounts& counts)
    {
      Star star;
      for (std::size_t p = begin; p < end; ++p)
      {
        star.gather(cells, corners, p);
        visitStar(star, static_cast<Index>(p), topology, counts);
      }
    });
  overChunks(pointCount, threads, topology,
    [&](std::size_t begin, std::size_t end, QuadCounts& counts)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        checkFan(cells, corners, static_cast<Index>(p), topology.twin, counts);
      }
    });
  DisjointSets sets(pointCount, threads);
  overChunks(cells.cells(), threads, topology,
    [&](std::size_t begin, std::size_t end, QuadCounts& counts)
    {
      for (std::size_t cell = begin; cell < end; ++cell)
      {
        checkCell(cells, cell, sets, counts);
      }
    });
  topology.components = sets.countSets() - topology.isolatedPoints;
  if (topology.manifold() && !topology.closed())
  {
    topology.boundaryLoops = loopsOf(topology.twin, [&](Index h) { return cells.next(h); }).size();
  }
  topology.eulerCharacteristic = static_cast<long long>(pointCount - topology.isolatedPoints) -
    static_cast<long long>(topology.edges) + static_cast<long long>(cells.cells());
  return topology;
}

} // namespace

void QuadCounts::add(const QuadCounts& other)
{
  edges += other.edges;
  boundaryEdges += other.boundaryEdges;
  nonManifoldEdges += other.nonManifoldEdges;
  nonManifoldVertices += other.nonManifoldVertices;
  degenerateQuads += other.degenerateQuads;
  isolatedPoints += other.isolatedPoints;
  append(defectPoints, other.defectPoints);
}

std::vector<std::vector<Index>> boundaryLoops(const QuadTopology& topology)
{
  return loopsOf(topology.twin, nextInQuad);
}

QuadTopology analyzeQuads(const Quads& quads, std::size_t pointCount, int threads)
{
  return analyze(QuadCorners{ quads }, pointCount, threads);
}

void setValences(QuadMesh& mesh)
{
  QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  mesh.valence = std::move(topology.valence);
  mesh.onBoundary = std::move(topology.onBoundary);
}

QuadTopology analyzeCells(const QuadMesh& mesh)
{
  return analyze(CellCornerList(mesh), mesh.points.size(), 1);
}

std::vector<std::uint8_t> linesOnEdges(const QuadMesh& mesh)
{
  const CellCornerList cells(mesh);
  const LeavingHalfEdges corners(cells, mesh.points.size(), 1);
  const auto isEdge = [&](Index a, Index b)
  {
    Index h = corners.first(a);
    while (h != kInvalidIndex && cells.point(cells.next(h)) != b)
    {
      h = corners.next(h);
    }
    return h != kInvalidIndex;
  };
  std::vector<std::uint8_t> found;
  for (const QuadLine& line : mesh.lines)
  {
    found.push_back(isEdge(line.a, line.b) || isEdge(line.b, line.a) ? 1 : 0);
  }
  return found;
}

std::string QuadTopology::text() const
{
  std::string text;
  appendCount(text, nonManifoldEdges, "non-manifold edges");
  appendCount(text, nonManifoldVertices, "non-manifold vertices");
  appendCount(text, degenerateQuads, "quads with a repeated vertex");
  appendCount(text, isolatedPoints, "isolated vertices");
  return text;
}

} // namespace quadrille
