// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/FeatureCurves.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// A maximal chain of constrained edges through vertices of degree 2.
struct Chain
{
  std::vector<Index> vertices; ///< a closed one does not repeat its first vertex
  bool closed = false;
};

/// graph: the constrained edges at each vertex.
Chain followChain(
  const Mesh& mesh, const Grouped<>& graph, Index start, Index edge, std::vector<char>& seen)
{
  Chain chain;
  chain.vertices = { start };
  Index v = mesh.otherEnd(edge, start);
  while (v != start && graph.size(v) == 2)
  {
    seen[v] = 1;
    chain.vertices.push_back(v);
    edge = graph.otherThan(v, edge);
    v = mesh.otherEnd(edge, v);
  }
  chain.closed = v == start && graph.size(start) == 2;
  if (!chain.closed)
  {
    chain.vertices.push_back(v);
  }
  return chain;
}

std::vector<Chain> collectChains(const Mesh& mesh, const Grouped<>& graph)
{
  std::vector<Chain> chains;
  std::vector<char> seen(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (graph.size(v) == 0 || graph.size(v) == 2)
    {
      continue;
    }
    for (Index i = 0; i < graph.size(v); ++i)
    {
      const Index edge = graph.begin(v)[i], next = mesh.otherEnd(edge, v);
      // A chain is found from both of its ends; the inner vertices, or the order of the ends, tell it was.
      const bool direct = graph.size(next) != 2;
      if (direct ? v < next : !seen[next])
      {
        chains.push_back(followChain(mesh, graph, v, edge, seen));
      }
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (graph.size(v) == 2 && !seen[v])
    {
      seen[v] = 1;
      chains.push_back(followChain(mesh, graph, v, *graph.begin(v), seen));
    }
  }
  return chains;
}

/// A chain's vertex by signed position, wrapping round in a closed chain.
class ChainWalk
{
public:
  ChainWalk(const Mesh& mesh, const Chain& chain) : mesh_(mesh), chain_(chain) {}
  bool has(long i) const
  {
    return chain_.closed || (i >= 0 && i < static_cast<long>(chain_.vertices.size()));
  }
  const Vector3& at(long i) const { return mesh_.position[chain_.vertices[wrap(i)]]; }
  std::size_t wrap(long i) const
  {
    const long n = static_cast<long>(chain_.vertices.size());
    return static_cast<std::size_t>(((i % n) + n) % n);
  }
  /// The first position in direction `step` whose distance along the chain from i reaches `length`.
  long walk(long i, long step, double length) const
  {
    double walked = 0;
    long j = i;
    const long limit = static_cast<long>(chain_.vertices.size()) / 2;
    for (long count = 0; walked < length && count < limit && has(j + step); ++count)
    {
      walked += (at(j + step) - at(j)).norm();
      j += step;
    }
    return j;
  }

private:
  const Mesh& mesh_;
  const Chain& chain_;
};

/// By how much the curve bends at each vertex of the chain where it may be a corner, else zero.
std::vector<double> cornerBends(const Mesh& mesh, const Chain& chain, double scale)
{
  const ChainWalk walk(mesh, chain);
  std::vector<double> bend(chain.vertices.size(), 0.0);
  for (long i = 0; i < static_cast<long>(bend.size()); ++i)
  {
    if (!walk.has(i - 1) || !walk.has(i + 1))
    {
      continue;
    }
    const Vector3& p = walk.at(i);
    if (angleBetween(p - walk.at(i - 1), walk.at(i + 1) - p) > kCornerAngle)
    {
      const double distance = scale * sizeAt(mesh, chain.vertices[static_cast<std::size_t>(i)]);
      const Vector3& before = walk.at(walk.walk(i, -1, distance));
      const Vector3& after = walk.at(walk.walk(i, 1, distance));
      bend[static_cast<std::size_t>(i)] = angleBetween(p - before, after - p);
    }
  }
  return bend;
}

bool bendsMost(
  const ChainWalk& walk, const std::vector<double>& bend, std::size_t corner, double range)
{
  const long i = static_cast<long>(corner);
  for (const long step : { -1L, 1L })
  {
    const long end = walk.walk(i, step, range);
    for (long j = i; j != end; j += step)
    {
      const std::size_t other = walk.wrap(j + step);
      // Of equals the first one stays.
      if (bend[other] > bend[corner] || (bend[other] == bend[corner] && other < corner))
      {
        return false;
      }
    }
  }
  return true;
}

/// Whether a vertex is nearer than `range` to a vertex where the chain ends: that one stays for both.
bool isNearEnd(const ChainWalk& walk, std::size_t vertex, double range)
{
  const long i = static_cast<long>(vertex);
  for (const long step : { -1L, 1L })
  {
    double walked = 0;
    long j = i;
    for (; walked < range && walk.has(j + step); j += step)
    {
      walked += (walk.at(j + step) - walk.at(j)).norm();
    }
    if (walked < range)
    {
      return true;
    }
  }
  return false;
}

void protectCorners(const Mesh& mesh, const Chain& chain, double scale, FeatureCurves& curves)
{
  const ChainWalk walk(mesh, chain);
  const std::vector<double> bend = cornerBends(mesh, chain, scale);
  for (std::size_t i = 0; i < bend.size(); ++i)
  {
    const double range = 0.5 * scale * sizeAt(mesh, chain.vertices[i]);
    if (bend[i] > kCornerAngle && !isNearEnd(walk, i, range) && bendsMost(walk, bend, i, range))
    {
      curves.kind[chain.vertices[i]] = VertexKind::Protected;
    }
  }
}

/// Cuts the chain at its protected vertices into curves.
void splitIntoCurves(const Chain& chain, FeatureCurves& curves)
{
  const std::size_t n = chain.vertices.size();
  const auto isProtected = [&](std::size_t i)
  { return curves.kind[chain.vertices[i % n]] == VertexKind::Protected; };
  std::size_t begin = 0;
  while (begin < n && !isProtected(begin))
  {
    ++begin;
  }
  if (begin == n)
  {
    for (const Index v : chain.vertices)
    {
      curves.curve[v] = static_cast<Index>(curves.ends.size());
    }
    curves.ends.push_back({ kInvalidIndex, kInvalidIndex });
    return;
  }
  const std::size_t end = chain.closed ? begin + n : n - 1;
  for (std::size_t i = begin; i < end;)
  {
    const Index id = static_cast<Index>(curves.ends.size());
    std::size_t j = i + 1;
    for (; !isProtected(j); ++j)
    {
      curves.curve[chain.vertices[j % n]] = id;
    }
    curves.ends.push_back({ chain.vertices[i % n], chain.vertices[j % n] });
    i = j;
  }
}

bool hasConstrainedEdge(const Mesh& mesh)
{
  bool found = false;
  for (Index h = 0; h < mesh.halfEdgeCount() && !found; ++h)
  {
    pollNowAndThen(h);
    found = mesh.isConstrained(h);
  }
  return found;
}

} // namespace

bool FeatureCurves::onSameCurve(Index a, Index b) const
{
  if (kind[a] == VertexKind::Free || kind[b] == VertexKind::Free)
  {
    return false;
  }
  if (curve[a] == kInvalidIndex && curve[b] == kInvalidIndex)
  {
    // Two corners: the ends are sorted by their lower vertex for this search.
    const std::array<Index, 2> key{ std::min(a, b), std::max(a, b) };
    return std::binary_search(endPairs.begin(), endPairs.end(), key);
  }
  if (curve[a] == kInvalidIndex)
  {
    std::swap(a, b);
  }
  const std::array<Index, 2>& end = ends[curve[a]];
  return curve[a] == curve[b] || end[0] == b || end[1] == b;
}

FeatureCurves traceFeatureCurves(const Mesh& mesh, double scale)
{
  FeatureCurves curves;
  curves.kind.resize(mesh.vertexCount(), VertexKind::Free);
  curves.curve.resize(mesh.vertexCount(), kInvalidIndex);
  if (!hasConstrainedEdge(mesh))
  {
    return curves;
  }
  const Grouped<> graph = edgesAtVertices(mesh, constrainedEdges(mesh));
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (graph.size(v) > 0)
    {
      curves.kind[v] = graph.size(v) == 2 ? VertexKind::Curve : VertexKind::Protected;
    }
  }
  for (const Chain& chain : collectChains(mesh, graph))
  {
    protectCorners(mesh, chain, scale, curves);
    splitIntoCurves(chain, curves);
  }
  for (const std::array<Index, 2>& end : curves.ends)
  {
    if (end[0] != kInvalidIndex)
    {
      curves.endPairs.push_back({ std::min(end[0], end[1]), std::max(end[0], end[1]) });
    }
  }
  std::sort(curves.endPairs.begin(), curves.endPairs.end());
  return curves;
}

} // namespace quadrille
