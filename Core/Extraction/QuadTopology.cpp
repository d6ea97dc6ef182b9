// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/QuadTopology.h"

#include "Base/Error.h"

#include <algorithm>
#include <numeric>

namespace quadrille
{
namespace
{

using Quads = std::vector<std::array<Index, 4>>;

Index nextInQuad(Index h)
{
  return h % 4 == 3 ? h - 3 : h + 1;
}
Index previousInQuad(Index h)
{
  return h % 4 == 0 ? h + 3 : h - 1;
}
Index originOf(const Quads& quads, Index h)
{
  return quads[h / 4][h % 4];
}
Index targetOf(const Quads& quads, Index h)
{
  return originOf(quads, nextInQuad(h));
}

/// Half-edges grouped by the point they leave.
struct Buckets
{
  std::vector<Index> first;
  std::vector<Index> halfEdges;

  Buckets(const Quads& quads, std::size_t pointCount)
    : first(pointCount + 1, 0), halfEdges(4 * quads.size())
  {
    const Index count = static_cast<Index>(halfEdges.size());
    for (Index h = 0; h < count; ++h)
    {
      const Index p = originOf(quads, h);
      if (p >= pointCount)
      {
        throw InvalidInput("quad " + std::to_string(h / 4) + " refers to point " +
          std::to_string(p) + " of " + std::to_string(pointCount));
      }
      ++first[p + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> fill(first.begin(), first.end() - 1);
    for (Index h = 0; h < count; ++h)
    {
      halfEdges[fill[originOf(quads, h)]++] = h;
    }
  }
};

void note(QuadTopology& topology, Index point)
{
  topology.offendingPoints.push_back(point);
}

/// Number of half-edges from a to b; the last one comes back in h.
int countHalfEdges(const Quads& quads, const Buckets& buckets, Index a, Index b, Index& h)
{
  int count = 0;
  for (Index i = buckets.first[a]; i < buckets.first[a + 1]; ++i)
  {
    if (targetOf(quads, buckets.halfEdges[i]) == b)
    {
      h = buckets.halfEdges[i];
      ++count;
    }
  }
  return count;
}

/// Counts the edge of the `same` half-edges a -> b and the `opposite` ones b -> a.
void countEdge(Index a, Index b, int opposite, int same, QuadTopology& topology)
{
  ++topology.valence[a];
  if (opposite > 0)
  {
    topology.edges += a < b ? 1 : 0;
    return;
  }
  ++topology.edges;
  ++topology.valence[b]; // no half-edge leaves b along this edge
  topology.boundaryEdges += same == 1 ? 1 : 0;
  topology.onBoundary[a] = topology.onBoundary[b] = 1;
}

void pairTwins(const Quads& quads, const Buckets& buckets, QuadTopology& topology)
{
  const Index count = static_cast<Index>(4 * quads.size());
  topology.twin.assign(count, kInvalidIndex);
  for (Index h = 0; h < count; ++h)
  {
    const Index a = originOf(quads, h);
    const Index b = targetOf(quads, h);
    Index other = h;
    Index mine = h;
    const int opposite = countHalfEdges(quads, buckets, b, a, other);
    const int same = countHalfEdges(quads, buckets, a, b, mine);
    if (same > 1)
    {
      ++topology.nonManifoldEdges;
      note(topology, a);
    }
    else if (opposite == 1)
    {
      topology.twin[h] = other;
    }
    if (mine == h)
    {
      countEdge(a, b, opposite, same, topology);
    }
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

void checkFans(const Buckets& buckets, QuadTopology& topology)
{
  const Index points = static_cast<Index>(buckets.first.size() - 1);
  for (Index p = 0; p < points; ++p)
  {
    const Index corners = buckets.first[p + 1] - buckets.first[p];
    if (corners == 0)
    {
      ++topology.isolatedPoints;
      note(topology, p);
    }
    else if (fanSize(topology, buckets.halfEdges[buckets.first[p]]) != corners)
    {
      ++topology.nonManifoldVertices;
      note(topology, p);
    }
  }
}

void countDegenerate(const Quads& quads, QuadTopology& topology)
{
  for (const std::array<Index, 4>& q : quads)
  {
    if (q[0] == q[1] || q[0] == q[2] || q[0] == q[3] || q[1] == q[2] || q[1] == q[3] ||
      q[2] == q[3])
    {
      ++topology.degenerateQuads;
      note(topology, q[0]);
    }
  }
}

void countComponents(const Quads& quads, std::size_t pointCount, QuadTopology& topology)
{
  std::vector<Index> root(pointCount);
  std::iota(root.begin(), root.end(), Index{ 0 });
  const auto find = [&root](Index p)
  {
    while (root[p] != p)
    {
      p = root[p] = root[root[p]];
    }
    return p;
  };
  for (const std::array<Index, 4>& q : quads)
  {
    for (int i = 1; i < 4; ++i)
    {
      const Index a = find(q[0]);
      const Index b = find(q[static_cast<std::size_t>(i)]);
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  for (Index p = 0; p < pointCount; ++p)
  {
    topology.components += root[p] == p ? 1 : 0;
  }
  topology.components -= topology.isolatedPoints;
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

QuadTopology analyzeQuads(const Quads& quads, std::size_t pointCount)
{
  QuadTopology topology;
  topology.valence.assign(pointCount, 0);
  topology.onBoundary.assign(pointCount, 0);
  const Buckets buckets(quads, pointCount);
  pairTwins(quads, buckets, topology);
  checkFans(buckets, topology);
  countDegenerate(quads, topology);
  countComponents(quads, pointCount, topology);
  if (topology.manifold())
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
