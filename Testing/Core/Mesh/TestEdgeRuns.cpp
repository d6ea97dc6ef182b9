// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/EdgeRuns.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Lower vertex, higher vertex, half-edge.
using Line = std::tuple<Index, Index, Index>;

std::vector<Line> linesOf(const std::vector<Index>& origin, Index vertices, int threads)
{
  std::vector<Line> lines;
  EdgeRuns(origin, vertices, threads)
    .forEach(
      [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
      {
        for (const EdgeRuns::Entry* entry = begin; entry != end; ++entry)
        {
          const Index h = entry->halfEdge;
          lines.emplace_back(
            std::min(origin[h], origin[Mesh::next(h)]), entry->other, entry->halfEdge);
          EXPECT_EQ(entry->other, begin->other);
        }
      });
  return lines;
}

std::vector<Line> sortedLines(const std::vector<Index>& origin)
{
  std::vector<Line> lines;
  for (Index h = 0; h < origin.size(); ++h)
  {
    const Index a = origin[h];
    const Index b = origin[Mesh::next(h)];
    lines.emplace_back(std::min(a, b), std::max(a, b), h);
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

} // namespace

TEST(EdgeRuns, ComeInTheOrderOfLowerVertexHigherVertexHalfEdge)
{
  // Random triangles on few vertices: buckets of all sizes up to hundreds, edges with many faces.
  std::mt19937 random(7);
  for (const Index vertices : { 4U, 12U, 60U, 2000U })
  {
    std::vector<Index> origin;
    while (origin.size() < 6000)
    {
      const Index a = static_cast<Index>(random()) % vertices;
      const Index b = static_cast<Index>(random()) % vertices;
      const Index c = static_cast<Index>(random()) % vertices;
      if (a != b && b != c && c != a)
      {
        origin.insert(origin.end(), { a, b, c });
      }
    }
    for (const int threads : { 1, 4 })
    {
      EXPECT_EQ(linesOf(origin, vertices, threads), sortedLines(origin));
    }
  }
  const Mesh mesh = torus(30, 15);
  EXPECT_EQ(linesOf(mesh.origin, mesh.vertexCount(), 2), sortedLines(mesh.origin));
}

TEST(EdgeRuns, RefusesWhatIsNoTriangleList)
{
  EXPECT_THROW(EdgeRuns({ 0, 1, 2, 0 }, 3, 1), InvalidInput);
  EXPECT_THROW(EdgeRuns({ 0, 1, 3 }, 3, 1), InvalidInput);
  EXPECT_THROW(EdgeRuns({ 0, 1, 1 }, 3, 1), InvalidInput);
  EXPECT_THROW(EdgeRuns({ 2, 1, 2 }, 3, 1), InvalidInput);
}
