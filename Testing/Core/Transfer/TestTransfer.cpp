// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/ExpectedTurns.h"
#include "Transfer/Transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

TransferResult transfer(
  const Mesh& fine, const Hierarchy& h, const std::vector<FixedVec2>& coarseUv, int threads = 1)
{
  TransferOptions options;
  options.threads = threads;
  return transferMap(fine, h.coarse, h.log, coarseUv, options);
}

} // namespace

TEST(Transfer, AffineMapOfAPlaneComesBack)
{
  // On a flat surface the polar maps of the stars are exact, so the weights restore every removed vertex.
  for (const Mesh& mesh : { gridPlane(40, 30), plateWithHole(12), plateL(20) })
  {
    const auto map = [](const Vector3& p)
    { return Vector2(0.75 * p.x() - 0.25 * p.y() + 3, 0.25 * p.x() + 0.5 * p.y() - 1); };
    const Hierarchy h = decimate(mesh, 10, 30);
    ASSERT_LT(h.coarse.mesh.vertexCount(), mesh.vertexCount() / 5);
    const TransferResult result = transfer(mesh, h, mapByPosition(h.coarse.mesh, map));
    const std::vector<FixedVec2> expected = mapByPosition(mesh, map);
    std::int64_t worst = 0;
    for (Index c = 0; c < mesh.halfEdgeCount(); ++c)
    {
      const FixedVec2 d = result.uv[c] - expected[c];
      worst = std::max({ worst, std::abs(d.u), std::abs(d.v) });
    }
    // Each generation of removed vertices adds at most a unit for its rounding and one for the weights
    // (32 bits of at most 30 quads); a vertex has at most a few tens of generations above it.
    EXPECT_LE(worst, 100);
    EXPECT_EQ(result.notPositive, 0U);
    EXPECT_EQ(seamResiduals(mesh, result.uv), 0U);
  }
}

TEST(Transfer, TorusKeepsItsTranslations)
{
  const Mesh mesh = torus(90, 45);
  const Hierarchy h = decimate(mesh, 0.3, 120);
  const std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  ASSERT_EQ(notPositive(coarseUv), 0U);
  const TransferResult result = transfer(mesh, h, coarseUv);
  EXPECT_EQ(seamResiduals(mesh, result.uv), 0U);
  EXPECT_EQ(result.notPositive, 0U);
  EXPECT_EQ(result.notPositive, notPositive(result.uv));
}

TEST(Transfer, CubeKeepsRotationsAndItsFlatSides)
{
  const Mesh mesh = markFeatures(unitCube(18), kFeatureAngle);
  const Hierarchy h = decimate(mesh, 0.4, 80);
  const double scale = 9;
  const std::vector<FixedVec2> coarseUv = cubeMap(h.coarse.mesh, scale);
  ASSERT_EQ(seamResiduals(h.coarse.mesh, coarseUv), 0U);
  const TransferResult result = transfer(mesh, h, coarseUv);
  EXPECT_EQ(seamResiduals(mesh, result.uv), 0U);
  EXPECT_EQ(result.notPositive, 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(mesh, result.uv), 0U) << "exactly on isolines";
  for (Index c = 0; c < mesh.halfEdgeCount(); ++c)
  {
    // Every side is flat, so its isometric map comes back; 1e-5 quads are 170 units of the grid, see above.
    const Vector2 edge = toDouble(result.uv[Mesh::next(c)] - result.uv[c]);
    EXPECT_NEAR(edge.norm(), scale * mesh.edgeVector(c).norm(), 1e-5);
  }
}

TEST(Transfer, TurnsOnTheSurfaceAreThoseOfTheCoarseMap)
{
  const Mesh cube = markFeatures(unitCube(18), kFeatureAngle);
  const Hierarchy ofCube = decimate(cube, 0.4, 80);
  const std::vector<FixedVec2> cubeUv = cubeMap(ofCube.coarse.mesh, 9);
  EXPECT_EQ(expectedTurns(cube, ofCube.coarse, turnsOf(ofCube.coarse.mesh, cubeUv)),
    turnsOf(cube, transfer(cube, ofCube, cubeUv).uv));

  const Mesh plane =
    gridPlane(40, 30); // has regular boundary vertices, and four corners with one turn
  const Hierarchy ofPlane = decimate(plane, 10, 30);
  const std::vector<FixedVec2> planeUv =
    mapByPosition(ofPlane.coarse.mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  const std::vector<int> turns =
    expectedTurns(plane, ofPlane.coarse, turnsOf(ofPlane.coarse.mesh, planeUv));
  EXPECT_EQ(turns, turnsOf(plane, transfer(plane, ofPlane, planeUv).uv));
  EXPECT_EQ(std::count(turns.begin(), turns.end(), 1), 4);
}

TEST(Transfer, FeaturesInsideAPlaneStayOnTheirIsolines)
{
  // A curved plate with a straight feature across it; the map is not affine, so vertices are interpolated in
  // earnest, but along the feature one coordinate is constant.
  Mesh mesh = gridPlane(40, 40);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool onLine =
      mesh.position[mesh.origin[h]].y() == 20 && mesh.position[mesh.target(h)].y() == 20;
    mesh.flags.edit()[h] |= onLine ? kFeatureEdge : 0;
  }
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() = 3 * std::sin(0.2 * p.x()) * std::cos(0.15 * p.y());
  }
  const Hierarchy h = decimate(mesh, 8, 60);
  const auto map = [](const Vector3& p)
  { return Vector2(0.4 * p.x() + 0.3 * std::sin(0.15 * p.x()), 0.35 * p.y()); };
  const TransferResult result = transfer(mesh, h, mapByPosition(h.coarse.mesh, map));
  EXPECT_EQ(seamResiduals(mesh, result.uv), 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(mesh, result.uv), 0U);
  EXPECT_EQ(result.notPositive, 0U);
}

TEST(Transfer, MovesVerticesIntoTheKernelWhereTheMapIsRough)
{
  // A valid coarse map that is far from smooth: every vertex is pushed as far as its triangles allow.
  const Mesh mesh = torus(90, 45);
  const Hierarchy h = decimate(mesh, 0.3, 150);
  const Mesh& coarse = h.coarse.mesh;
  std::mt19937 random(5);
  std::vector<FixedVec2> offset(coarse.vertexCount());
  const auto map = [&]()
  { return torusMap(coarse, 1, 40 * kOne, 16 * kOne, [&](Index v) { return offset[v]; }); };
  for (int round = 0; round < 2; ++round)
  {
    for (Index v = 0; v < coarse.vertexCount(); ++v)
    {
      const FixedVec2 before = offset[v];
      const auto push = [&]()
      { return static_cast<std::int64_t>(random() % (3 * kOne)) - 3 * kOne / 2; };
      offset[v] = before + FixedVec2{ push(), push() };
      offset[v] = notPositive(map()) == 0 ? offset[v] : before;
    }
  }
  const std::vector<FixedVec2> coarseUv = map();
  ASSERT_EQ(notPositive(coarseUv), 0U);
  const TransferResult result = transfer(mesh, h, coarseUv);
  EXPECT_GT(result.invertedStars, 0U) << "else this test tests nothing";
  EXPECT_EQ(result.invertedStars, result.movedToKernel + result.withoutKernel);
  EXPECT_EQ(result.notPositive, 0U);
  EXPECT_EQ(notPositive(result.uv), 0U);
  EXPECT_EQ(seamResiduals(mesh, result.uv), 0U);
}

TEST(Transfer, GivesTheSameBytesForAnyNumberOfThreads)
{
  const Mesh mesh = torus(300, 150);
  const Hierarchy h = decimate(mesh, 0.15, 300);
  ASSERT_GT(h.log.blocks.size(), h.log.rounds.size() + 2);
  const std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  const TransferResult one = transfer(mesh, h, coarseUv, 1);
  for (const int threads : { 2, 4, 8 })
  {
    EXPECT_EQ(transfer(mesh, h, coarseUv, threads).uv, one.uv);
  }
}

TEST(Transfer, TheLogFromItsBytesGivesTheSameMap)
{
  const Mesh mesh = torus(60, 30);
  Hierarchy h = decimate(mesh, 0.3, 120);
  const std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  const TransferResult before = transfer(mesh, h, coarseUv);
  h.log = DecimationLog::deserialize(h.log.serialize(), 1);
  EXPECT_EQ(transfer(mesh, h, coarseUv).uv, before.uv);
}

TEST(Transfer, TheLogOfARedecimationReplaysFromItsBytes)
{
  const Mesh mesh = gridPlane(40, 30);
  const auto map = [](const Vector3& p)
  { return Vector2(0.75 * p.x() - 0.25 * p.y() + 3, 0.25 * p.x() + 0.5 * p.y() - 1); };
  HierarchyOptions options;
  options.targetEdgeLength = 6;
  options.coarseVertices = 30;
  Redecimation levels(mesh, 1, options);
  levels.update(options);
  options.keepVertices = { levels.hierarchy().intermediate.fineVertex[40] };
  Hierarchy h = levels.update(options);
  h.log = DecimationLog::deserialize(h.log.serialize(), 1);
  const TransferResult result = transfer(mesh, h, mapByPosition(h.coarse.mesh, map));
  const std::vector<FixedVec2> expected = mapByPosition(mesh, map);
  for (Index c = 0; c < mesh.halfEdgeCount(); ++c)
  {
    // As in affineMapOfAPlaneComesBack.
    EXPECT_LE(std::abs(result.uv[c].u - expected[c].u), 100);
    EXPECT_LE(std::abs(result.uv[c].v - expected[c].v), 100);
  }
}

TEST(Transfer, AMapThatIsNotValidIsCountedNotFatal)
{
  const Mesh mesh = gridPlane(20, 20);
  const Hierarchy h = decimate(mesh, 6, 30);
  const std::vector<FixedVec2> flat(h.coarse.mesh.halfEdgeCount());
  EXPECT_EQ(transfer(mesh, h, flat).notPositive, mesh.faceCount());
}

TEST(Transfer, RefusesWhatDoesNotFit)
{
  const Mesh mesh = gridPlane(20, 20);
  const Hierarchy h = decimate(mesh, 6, 30);
  const auto map = [](const Vector3& p) { return Vector2(p.x(), p.y()); };
  std::vector<FixedVec2> uv = mapByPosition(h.coarse.mesh, map);
  EXPECT_THROW(transfer(gridPlane(20, 21), h, uv), InvalidInput);
  uv.pop_back();
  EXPECT_THROW(transfer(mesh, h, uv), InvalidInput);
}
