// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/DisjointSets.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/Charts.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Puts every face into a chart of its own.
void scatter(std::vector<FixedVec2>& uv)
{
  std::mt19937 random(5);
  for (std::size_t f = 0; f < uv.size(); f += 3)
  {
    const int turns = static_cast<int>(random() % 4);
    const FixedVec2 shift{ kOne * (static_cast<int>(random() % 100) - 50), kOne * 7 };
    for (std::size_t i = f; i < f + 3; ++i)
    {
      uv[i] = rotate(uv[i], turns) + shift;
    }
  }
}

std::vector<std::int64_t> determinants(const std::vector<FixedVec2>& uv)
{
  std::vector<std::int64_t> result;
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    result.push_back(static_cast<std::int64_t>(determinant(uv[h], uv[h + 1], uv[h + 2])));
  }
  return result;
}

/// Parts without a seam between them, and edges that are seams.
ChartCounts countCharts(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  ChartCounts counts;
  DisjointSets parts(mesh.faceCount(), 1);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    if (g != kInvalidIndex && uv[h] == uv[Mesh::next(g)] && uv[Mesh::next(h)] == uv[g])
    {
      parts.join(Mesh::face(h), Mesh::face(g));
    }
    else
    {
      counts.seamEdges += g != kInvalidIndex && h < g ? 1U : 0U;
    }
  }
  counts.charts = parts.countSets();
  return counts;
}

/// Vertices where exactly one seam edge ends.
std::set<Index> seamEnds(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<int> degree(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    if (g != kInvalidIndex && (uv[h] != uv[Mesh::next(g)] || uv[Mesh::next(h)] != uv[g]))
    {
      ++degree[mesh.origin[h]]; // once by h, once by its twin at the other end
    }
  }
  std::set<Index> ends;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (degree[v] == 1)
    {
      ends.insert(v);
    }
  }
  return ends;
}

TEST(Charts, APlaneBecomesOneChartWithoutSeams)
{
  const Mesh mesh = gridPlane(12, 9);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  const std::vector<std::int64_t> before = determinants(uv);
  EXPECT_EQ(countCharts(mesh, uv).charts, 1U);
  scatter(uv);
  EXPECT_GT(countCharts(mesh, uv).charts, mesh.faceCount() / 2);
  EXPECT_GT(countCharts(mesh, uv).seamEdges, mesh.faceCount() / 2);
  const ChartCounts merged = mergeCharts(mesh, uv);
  EXPECT_EQ(merged.charts, 1U);
  EXPECT_EQ(merged.seamEdges, 0U);
  EXPECT_EQ(countCharts(mesh, uv).charts, 1U);
  EXPECT_EQ(determinants(uv), before);
}

TEST(Charts, SeamsOfACubeEndAtItsCornersOnly)
{
  const Mesh mesh = unitCube(6);
  std::vector<FixedVec2> uv = cubeMap(mesh, 6);
  const std::vector<std::int64_t> before = determinants(uv);
  scatter(uv);
  const ChartCounts merged = mergeCharts(mesh, uv);
  EXPECT_EQ(merged.charts, 1U);
  EXPECT_EQ(countCharts(mesh, uv).charts, 1U);
  EXPECT_EQ(countCharts(mesh, uv).seamEdges, merged.seamEdges);
  EXPECT_GE(merged.seamEdges, 7U * 6U) << "eight corners are joined by seven paths at least";
  EXPECT_LT(merged.seamEdges, mesh.halfEdgeCount() / 6);
  EXPECT_EQ(seamResiduals(mesh, uv), 0U);
  EXPECT_EQ(determinants(uv), before);
  const std::set<Index> ends = seamEnds(mesh, uv);
  EXPECT_FALSE(ends.empty());
  for (const Index v : ends)
  {
    const Vector3 p = (mesh.position[v].array() - 0.5).abs();
    EXPECT_TRUE(p.isApproxToConstant(0.5)) << mesh.position[v].transpose();
  }
}

TEST(Charts, TheSeamsOfATorusHaveNoEnds)
{
  const Mesh mesh = torus(40, 20);
  std::vector<FixedVec2> uv =
    torusMap(mesh, 1, 40 * kOne, 20 * kOne, [](Index) { return FixedVec2{}; });
  scatter(uv);
  const ChartCounts merged = mergeCharts(mesh, uv);
  EXPECT_EQ(merged.charts, 1U);
  EXPECT_GE(merged.seamEdges, 2U * 20U);
  EXPECT_TRUE(seamEnds(mesh, uv).empty());
  EXPECT_EQ(seamResiduals(mesh, uv), 0U);
}

TEST(Charts, EdgesWithoutATransitionAreNotCrossed)
{
  const Mesh mesh = gridPlane(6, 6);
  const Index inside = 2 * (3 * 6 + 3);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  for (Index i = 0; i < 3; ++i)
  {
    uv[3 * inside + i].u *= 3;
    uv[3 * inside + i].v *= 5;
  }
  EXPECT_EQ(mergeCharts(mesh, uv).charts, 2U);
}

} // namespace
