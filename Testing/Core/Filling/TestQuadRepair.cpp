// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRepair.h"

#include "QuadChecks.h"
#include "TestMeshes.h"

#include "Base/Lists.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

using namespace quadrille;

namespace
{

constexpr Index kColumns = 6, kRows = 5;

Index pointAt(Index i, Index j)
{
  return j * (kColumns + 1) + i;
}

Index quadAt(Index i, Index j)
{
  return j * kColumns + i;
}

/// One quad for each cell of gridPlane(kColumns, kRows), with its boundary as lines.
QuadMesh planeOfQuads(const Mesh& mesh)
{
  QuadMesh quads;
  const auto place = [&](const Vector3& p)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.position[mesh.origin[h]] == p)
      {
        std::array<double, 3> weights{};
        weights[h % 3] = 1;
        quads.sourceFace.push_back(Mesh::face(h));
        quads.sourceWeights.push_back(weights);
        return;
      }
    }
    ADD_FAILURE() << "no vertex there";
  };
  for (Index j = 0; j <= kRows; ++j)
  {
    for (Index i = 0; i <= kColumns; ++i)
    {
      quads.points.emplace_back(i, j, 0);
      place(quads.points.back());
    }
  }
  for (Index j = 0; j < kRows; ++j)
  {
    for (Index i = 0; i < kColumns; ++i)
    {
      quads.quads.push_back(
        { pointAt(i, j), pointAt(i + 1, j), pointAt(i + 1, j + 1), pointAt(i, j + 1) });
      quads.quadSourceFace.push_back(quads.sourceFace[pointAt(i, j)]);
      quads.quadSourceWeights.push_back({ 0.5, 0, 0.5 });
    }
  }
  const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] == kInvalidIndex)
    {
      quads.lines.push_back(
        { quads.quads[h / 4][h % 4], quads.quads[h / 4][(h + 1) % 4], kInvalidIndex, true });
    }
  }
  quads.valence = topology.valence;
  quads.onBoundary = topology.onBoundary;
  return quads;
}

/// The edge between the quads at (2, 0) and (3, 0) leads from (2, 0) to (4, 1) in place of (3, 0) to (3, 1): the point
/// (3, 0) on the boundary has a single quad then, with a flat corner.
QuadMesh withFlatCorner(const Mesh& mesh)
{
  QuadMesh quads = planeOfQuads(mesh);
  quads.quads[quadAt(2, 0)] = { pointAt(2, 0), pointAt(3, 0), pointAt(4, 0), pointAt(4, 1) };
  quads.quads[quadAt(3, 0)] = { pointAt(2, 0), pointAt(4, 1), pointAt(3, 1), pointAt(2, 1) };
  return quads;
}

double worstOf(const QuadMesh& quads)
{
  double worst = 1;
  for (const auto& quad : quads.quads)
  {
    worst = std::min(worst, scaledJacobian(cornersOf(quads.points, quad)));
  }
  return worst;
}

} // namespace

TEST(QuadRepair, ReplacesAQuadWithAFlatCorner)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh quads = withFlatCorner(mesh);
  ASSERT_LE(worstOf(quads), 0);
  repairQuads(mesh, quads, {});
  EXPECT_GT(worstOf(quads), 0.3);
  const test::IndependentCheck check(quads);
  EXPECT_TRUE(check.oriented && check.vertexManifold);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.boundaryEdges, 2U * (kColumns + kRows));
  EXPECT_EQ(quads.lines.size(), check.boundaryEdges);
  const std::vector<std::uint8_t> onEdges = linesOnEdges(quads);
  EXPECT_TRUE(std::all_of(onEdges.begin(), onEdges.end(), [](std::uint8_t on) { return on != 0; }));
  ASSERT_EQ(quads.valence.size(), quads.points.size());
  EXPECT_EQ(quads.valence, analyzeQuads(quads.quads, quads.points.size()).valence);
  ASSERT_EQ(quads.quadSourceWeights.size(), quads.quads.size());
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    // What has another place in the map than a unit square has none.
    const QuadMesh before = withFlatCorner(mesh);
    const bool isOld = contains(before.quads, quads.quads[q]);
    EXPECT_EQ(isOld, (quads.quadSourceWeights[q] != std::array<double, 3>{}));
  }
}

TEST(QuadRepair, LeavesGoodQuadsAndThoseAtFixedVerticesAlone)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh good = planeOfQuads(mesh);
  repairQuads(mesh, good, {});
  EXPECT_EQ(good.quads, planeOfQuads(mesh).quads);
  EXPECT_EQ(good.points, planeOfQuads(mesh).points);

  QuadMesh quads = withFlatCorner(mesh);
  std::vector<Index> fixed;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    fixed.push_back(v);
  }
  repairQuads(mesh, quads, { fixed, nullptr });
  EXPECT_EQ(quads.quads, withFlatCorner(mesh).quads);
}

/// What a connection or a cycle has become runs straight only while its points keep their quads.
TEST(QuadRepair, LeavesChainsAsTheyAre)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  const auto pointOf = [](const QuadMesh& quads, const Vector3& place)
  {
    const auto at = std::min_element(quads.points.begin(), quads.points.end(),
      [&](const Vector3& a, const Vector3& b) { return (a - place).norm() < (b - place).norm(); });
    return static_cast<Index>(at - quads.points.begin());
  };
  const std::vector<Vector3> course = { { 3, 1, 0 }, { 3, 2, 0 }, { 3, 3, 0 } };
  const auto chainIn = [&](const QuadMesh& quads)
  {
    std::vector<Index> chain;
    for (const Vector3& place : course)
    {
      chain.push_back(pointOf(quads, place));
    }
    return std::vector<std::vector<Index>>{ chain };
  };
  const QuadMesh before = withFlatCorner(mesh);
  const auto quadsAt = [&](const QuadMesh& quads, const Vector3& place)
  {
    const Index p = pointOf(quads, place);
    return std::count_if(quads.quads.begin(), quads.quads.end(),
      [&](const auto& quad) { return std::find(quad.begin(), quad.end(), p) != quad.end(); });
  };
  QuadMesh free = before;
  repairQuads(mesh, free, {});
  EXPECT_NE(quadsAt(free, course.front()), quadsAt(before, course.front()));
  QuadMesh kept = before;
  repairQuads(mesh, kept, { {}, chainIn });
  for (const Vector3& place : course)
  {
    EXPECT_EQ(quadsAt(kept, place), quadsAt(before, place));
  }
}

TEST(QuadRepair, DoesNotReachAcrossLines)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh quads = withFlatCorner(mesh);
  // A line above the row of the bad quad.
  for (Index i = 0; i < kColumns; ++i)
  {
    quads.lines.push_back({ pointAt(i, 1), pointAt(i + 1, 1), kInvalidIndex, false });
  }
  repairQuads(mesh, quads, {});
  EXPECT_GT(worstOf(quads), 0.1);
  const QuadMesh before = planeOfQuads(mesh);
  for (Index j = 1; j < kRows; ++j)
  {
    for (Index i = 0; i < kColumns; ++i)
    {
      EXPECT_TRUE(contains(quads.quads, before.quads[quadAt(i, j)]));
    }
  }
}
