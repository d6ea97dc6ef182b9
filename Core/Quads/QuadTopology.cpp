// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadTopology.h"

#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Quads/QuadHalfEdges.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

namespace quadrille
{
namespace
{

constexpr std::size_t kQuadTopologyChunk = std::size_t{ 1 } << 11;

using Quads = std::vector<std::array<Index, 4>>;

Index originOf(const Quads& quads, Index h)
{
  return quads[h / 4][h % 4];
}
Index targetOf(const Quads& quads, Index h)
{
  return originOf(quads, nextInQuad(h));
}

/// The half-edges that leave each point, as lists that all threads make at once; their order is that of the threads.
class LeavingHalfEdges
{
public:
  LeavingHalfEdges(const Quads& quads, std::size_t pointCount, int threads)
    : first_(new std::atomic<Index>[pointCount]), next_(4 * quads.size())
  {
    parallelForEach(pointCount, kQuadTopologyChunk, threads,
      [this](std::size_t p) { first_[p].store(kInvalidIndex, std::memory_order_relaxed); });
    std::vector<Index> wrong(
      (quads.size() + kQuadTopologyChunk - 1) / kQuadTopologyChunk, kInvalidIndex);
    parallelFor(quads.size(), kQuadTopologyChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (Index h = static_cast<Index>(4 * begin); h < 4 * end; ++h)
        {
          const Index p = originOf(quads, h);
          if (p >= pointCount)
          {
            wrong[begin / kQuadTopologyChunk] = h;
            return;
          }
          next_[h] = first_[p].exchange(h, std::memory_order_relaxed);
        }
      });
    for (const Index h : wrong)
    {
      if (h != kInvalidIndex)
      {
        throw InvalidInput("quad " + std::to_string(h / 4) + " refers to point " +
          std::to_string(originOf(quads, h)) + " of " + std::to_string(pointCount));
      }
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

  void gather(const Quads& quads, const LeavingHalfEdges& corners, std::size_t p)
  {
    out.clear();
    in.clear();
    for (Index h = corners.first(p); h != kInvalidIndex; h = corners.next(h))
    {
      const Index before = previousInQuad(h);
      out.emplace_back(targetOf(quads, h), h);
      in.emplace_back(originOf(quads, before), before);
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

/// Counts of one chunk of points or quads.
struct Counts
{
  std::size_t edges = 0;
  std::size_t boundaryEdges = 0;
  std::size_t nonManifoldEdges = 0;
  std::size_t nonManifoldVertices = 0;
  std::size_t degenerateQuads = 0;
  std::size_t isolatedPoints = 0;
  std::vector<Index> offendingPoints;
};

/// The edges between p and one neighbour: `out` half-edges leave along them, `in` arrive.
void countEdge(Index p, Index neighbour, SpokeRange outBegin, SpokeRange outEnd, SpokeRange inBegin,
  SpokeRange inEnd, QuadTopology& topology, Counts& counts)
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
    counts.offendingPoints.insert(counts.offendingPoints.end(), static_cast<std::size_t>(out), p);
  }
  else if (in == 1)
  {
    topology.twin[outBegin->second] = inBegin->second;
  }
}

void visitStar(const Star& star, Index p, QuadTopology& topology, Counts& counts)
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

/// Size of the fan round the origin of h, and whether it ends at a boundary.
Index fanSize(const QuadTopology& topology, Index h)
{
  Index size = 1;
  Index g = topology.twin[previousInQuad(h)];
  for (; g != kInvalidIndex && g != h; g = topology.twin[previousInQuad(g)])
  {
    ++size;
  }
  if (g == h)
  {
    return size;
  }
  for (g = topology.twin[h]; g != kInvalidIndex; g = topology.twin[nextInQuad(g)])
  {
    ++size;
  }
  return size;
}

void checkFan(
  const LeavingHalfEdges& corners, Index p, const QuadTopology& topology, Counts& counts)
{
  Index count = 0;
  for (Index h = corners.first(p); h != kInvalidIndex; h = corners.next(h))
  {
    ++count;
  }
  if (count == 0)
  {
    ++counts.isolatedPoints;
    counts.offendingPoints.push_back(p);
  }
  else if (fanSize(topology, corners.first(p)) != count)
  {
    ++counts.nonManifoldVertices;
    counts.offendingPoints.push_back(p);
  }
}

void checkQuad(const std::array<Index, 4>& q, DisjointSets& sets, Counts& counts)
{
  if (q[0] == q[1] || q[0] == q[2] || q[0] == q[3] || q[1] == q[2] || q[1] == q[3] || q[2] == q[3])
  {
    ++counts.degenerateQuads;
    counts.offendingPoints.push_back(q[0]);
  }
  for (std::size_t i = 1; i < 4; ++i)
  {
    sets.join(q[0], q[i]);
  }
}

/// Runs a check over chunks and adds what they count, in the order of the chunks.
template <typename Body>
void overChunks(std::size_t size, int threads, QuadTopology& topology, const Body& body)
{
  std::vector<Counts> parts((size + kQuadTopologyChunk - 1) / kQuadTopologyChunk);
  parallelFor(size, kQuadTopologyChunk, threads,
    [&](std::size_t begin, std::size_t end) {
      body(static_cast<Index>(begin), static_cast<Index>(end), parts[begin / kQuadTopologyChunk]);
    });
  for (const Counts& part : parts)
  {
    topology.edges += part.edges;
    topology.boundaryEdges += part.boundaryEdges;
    topology.nonManifoldEdges += part.nonManifoldEdges;
    topology.nonManifoldVertices += part.nonManifoldVertices;
    topology.degenerateQuads += part.degenerateQuads;
    topology.isolatedPoints += part.isolatedPoints;
    topology.offendingPoints.insert(
      topology.offendingPoints.end(), part.offendingPoints.begin(), part.offendingPoints.end());
  }
}

} // namespace

std::vector<std::vector<Index>> boundaryLoops(const QuadTopology& topology)
{
  const Index count = static_cast<Index>(topology.twin.size());
  std::vector<std::uint8_t> seen(count, 0);
  std::vector<std::vector<Index>> loops;
  for (Index h = 0; h < count; ++h)
  {
    if (topology.twin[h] != kInvalidIndex || seen[h])
    {
      continue;
    }
    loops.emplace_back();
    for (Index g = h; !seen[g];)
    {
      seen[g] = 1;
      loops.back().push_back(g);
      g = nextInQuad(g);
      while (topology.twin[g] != kInvalidIndex)
      {
        g = nextInQuad(topology.twin[g]);
      }
    }
  }
  return loops;
}

QuadTopology analyzeQuads(const Quads& quads, std::size_t pointCount, int threads)
{
  QuadTopology topology;
  topology.valence.assign(pointCount, 0);
  topology.onBoundary.assign(pointCount, 0);
  topology.twin.assign(4 * quads.size(), kInvalidIndex);
  const LeavingHalfEdges corners(quads, pointCount, threads);
  overChunks(pointCount, threads, topology,
    [&](Index begin, Index end, Counts& counts)
    {
      Star star;
      for (Index p = begin; p < end; ++p)
      {
        star.gather(quads, corners, p);
        visitStar(star, p, topology, counts);
      }
    });
  overChunks(pointCount, threads, topology,
    [&](Index begin, Index end, Counts& counts)
    {
      for (Index p = begin; p < end; ++p)
      {
        checkFan(corners, p, topology, counts);
      }
    });
  DisjointSets sets(pointCount, threads);
  overChunks(quads.size(), threads, topology,
    [&](Index begin, Index end, Counts& counts)
    {
      for (Index q = begin; q < end; ++q)
      {
        checkQuad(quads[q], sets, counts);
      }
    });
  topology.components = sets.countSets() - topology.isolatedPoints;
  if (topology.manifold() && !topology.closed())
  {
    topology.boundaryLoops = boundaryLoops(topology).size();
  }
  topology.eulerCharacteristic = static_cast<long long>(pointCount - topology.isolatedPoints) -
    static_cast<long long>(topology.edges) + static_cast<long long>(quads.size());
  return topology;
}

std::string QuadTopology::text() const
{
  std::string result;
  const auto add = [&result](std::size_t count, const char* what)
  {
    if (count > 0)
    {
      result += (result.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    }
  };
  add(nonManifoldEdges, "non-manifold edges");
  add(nonManifoldVertices, "non-manifold vertices");
  add(degenerateQuads, "quads with a repeated vertex");
  add(isolatedPoints, "isolated vertices");
  return result;
}

} // namespace quadrille
