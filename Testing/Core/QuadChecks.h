// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the tests of the extraction ask of every quad mesh, by other means than the library's.
#pragma once

#include "GridMaps.h"

#include "Extraction/Extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace quadrille::test
{

/// Topology of a quad mesh by maps and sets, on purpose by other means than the library's.
struct IndependentCheck
{
  std::size_t edges = 0;
  std::size_t boundaryEdges = 0;
  std::size_t boundaryLoops = 0;
  std::size_t components = 0;
  bool oriented = true;
  bool vertexManifold = true;

  IndependentCheck(const QuadMesh& mesh)
  {
    std::map<std::pair<Index, Index>, int> directed;
    std::map<Index, std::set<Index>> neighbours;
    std::map<Index, std::map<Index, Index>> links; // around a vertex: previous -> next
    for (const auto& q : mesh.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index a = q[i], b = q[(i + 1) % 4], z = q[(i + 3) % 4];
        ++directed[{ a, b }];
        neighbours[a].insert(b);
        neighbours[b].insert(a);
        vertexManifold = vertexManifold && links[a].emplace(b, z).second;
      }
    }
    std::map<Index, Index> border;
    for (const auto& [edge, count] : directed)
    {
      oriented = oriented && count == 1;
      if (directed.count({ edge.second, edge.first }) == 0)
      {
        ++boundaryEdges;
        vertexManifold = vertexManifold && border.emplace(edge).second;
      }
    }
    for (const auto& [v, around] : neighbours)
    {
      edges += around.size();
      vertexManifold = vertexManifold && isOneFan(links[v], around.size());
    }
    edges /= 2;
    countComponents(neighbours);
    countLoops(border);
  }

private:
  static bool isOneFan(const std::map<Index, Index>& link, std::size_t neighbours)
  {
    // Start at a neighbour without predecessor if there is one (boundary), else anywhere.
    std::set<Index> targets;
    for (const auto& [from, to] : link)
    {
      targets.insert(to);
    }
    Index start = link.begin()->first;
    for (const auto& [from, to] : link)
    {
      start = targets.count(from) == 0 ? from : start;
    }
    std::set<Index> seen;
    for (Index p = start; seen.insert(p).second && link.count(p) != 0;)
    {
      p = link.at(p);
    }
    return seen.size() == neighbours;
  }

  void countComponents(const std::map<Index, std::set<Index>>& neighbours)
  {
    std::set<Index> seen;
    for (const auto& [start, unused] : neighbours)
    {
      if (!seen.insert(start).second)
      {
        continue;
      }
      ++components;
      std::vector<Index> stack{ start };
      while (!stack.empty())
      {
        const Index p = stack.back();
        stack.pop_back();
        for (const Index q : neighbours.at(p))
        {
          if (seen.insert(q).second)
          {
            stack.push_back(q);
          }
        }
      }
    }
  }

  void countLoops(std::map<Index, Index> border)
  {
    while (!border.empty())
    {
      ++boundaryLoops;
      Index p = border.begin()->first;
      for (auto found = border.find(p); found != border.end(); found = border.find(p))
      {
        p = found->second;
        border.erase(found);
      }
    }
  }
};

inline ExtractionResult extract(
  const GridMapCase& c, int threads = 1, ExtractionPath path = ExtractionPath::Automatic)
{
  ExtractionOptions options;
  options.threads = threads;
  options.path = path;
  options.smoothingSteps = 0;
  return extractQuads(c.mesh, c.uv, options);
}

inline void expectTopologyOfInput(const Mesh& mesh, const QuadMesh& quads)
{
  const IndependentCheck check(quads);
  const TopologySummary wanted = summarizeTopology(mesh);
  EXPECT_TRUE(check.oriented);
  EXPECT_TRUE(check.vertexManifold);
  EXPECT_EQ(check.components, wanted.components);
  EXPECT_EQ(check.boundaryLoops, wanted.boundaryLoops);
  EXPECT_EQ(static_cast<long long>(quads.points.size()) - static_cast<long long>(check.edges) +
      static_cast<long long>(quads.quads.size()),
    wanted.eulerCharacteristic);
}

/// Sources lie in their faces and give the positions; valences count edges; lines are quad edges.
inline void expectConsistentAttributes(const Mesh& mesh, const QuadMesh& quads)
{
  ASSERT_EQ(quads.sourceFace.size(), quads.points.size());
  ASSERT_EQ(quads.sourceWeights.size(), quads.points.size());
  ASSERT_EQ(quads.valence.size(), quads.points.size());
  ASSERT_EQ(quads.onBoundary.size(), quads.points.size());
  ASSERT_EQ(quads.quadSourceFace.size(), quads.quads.size());
  ASSERT_EQ(quads.quadSourceWeights.size(), quads.quads.size());
  for (const std::array<double, 3>& weights : quads.quadSourceWeights)
  {
    const double sum = weights[0] + weights[1] + weights[2];
    EXPECT_NEAR(sum, sum == 0 ? 0 : 1, 1e-12); // 0: a quad that fills a hole
    EXPECT_GE(std::min({ weights[0], weights[1], weights[2] }), 0);
  }
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    Vector3 p = Vector3::Zero();
    double sum = 0;
    for (Index k = 0; k < 3; ++k)
    {
      EXPECT_GE(quads.sourceWeights[i][k], 0);
      sum += quads.sourceWeights[i][k];
      p += quads.sourceWeights[i][k] * mesh.position[mesh.origin[3 * quads.sourceFace[i] + k]];
    }
    EXPECT_NEAR(sum, 1, 1e-12); // three rounded quotients of doubles
    EXPECT_NEAR((p - quads.points[i]).norm(), 0, 1e-12);
  }
  std::set<std::pair<Index, Index>> edges;
  std::vector<std::set<Index>> neighbours(quads.points.size());
  for (const auto& q : quads.quads)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      edges.emplace(q[k], q[(k + 1) % 4]);
      neighbours[q[k]].insert(q[(k + 1) % 4]);
      neighbours[q[(k + 1) % 4]].insert(q[k]);
    }
  }
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    EXPECT_EQ(static_cast<std::size_t>(quads.valence[i]), neighbours[i].size());
  }
  for (const QuadLine& line : quads.lines)
  {
    EXPECT_EQ(edges.count({ line.a, line.b }), 1u);
    EXPECT_EQ(edges.count({ line.b, line.a }), line.boundary ? 0u : 1u);
    EXPECT_TRUE(mesh.isConstrained(line.halfEdge));
    EXPECT_EQ(mesh.isBoundary(line.halfEdge), line.boundary);
    EXPECT_TRUE(!line.boundary || (quads.onBoundary[line.a] && quads.onBoundary[line.b]));
  }
}

inline bool isPositive(const GridMapCase& c)
{
  for (std::size_t h = 0; h < c.uv.size(); h += 3)
  {
    if (orientation(c.uv[h], c.uv[h + 1], c.uv[h + 2]) <= 0)
    {
      return false;
    }
  }
  return true;
}

/// A quad mesh as a set: points by their places on the input, quads from their lowest corner on, lines.
struct QuadSet
{
  using Place = std::pair<Index, std::array<double, 3>>;
  std::set<std::array<Place, 4>> quads;
  std::set<std::tuple<Place, Place, bool>> lines;

  explicit QuadSet(const QuadMesh& mesh)
  {
    const auto place = [&](Index p) { return Place{ mesh.sourceFace[p], mesh.sourceWeights[p] }; };
    for (const auto& q : mesh.quads)
    {
      std::array<Place, 4> corners{ place(q[0]), place(q[1]), place(q[2]), place(q[3]) };
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      quads.insert(corners);
    }
    for (const QuadLine& line : mesh.lines)
    {
      const auto ends = line.boundary ? std::pair{ place(line.a), place(line.b) }
                                      : std::minmax({ place(line.a), place(line.b) });
      lines.emplace(ends.first, ends.second, line.boundary);
    }
  }
  friend bool operator==(const QuadSet& a, const QuadSet& b)
  {
    return a.quads == b.quads && a.lines == b.lines;
  }
};

/// A positive map gives the same mesh on both ways through the extraction.
inline void expectSameOnBothPaths(const GridMapCase& c)
{
  const ExtractionResult fast = extract(c, 1, ExtractionPath::Fast);
  const ExtractionResult folded = extract(c, 1, ExtractionPath::Folded);
  EXPECT_EQ(folded.status.message, fast.status.message);
  EXPECT_EQ(folded.mesh.points.size(), fast.mesh.points.size());
  EXPECT_EQ(folded.mesh.quads.size(), fast.mesh.quads.size());
  EXPECT_EQ(folded.mesh.lines.size(), fast.mesh.lines.size());
  EXPECT_TRUE(QuadSet(folded.mesh) == QuadSet(fast.mesh));
  EXPECT_EQ(
    folded.mergedVertices + folded.zeroSides + folded.zippedSides + folded.cancelledQuads, 0u);
}

} // namespace quadrille::test
