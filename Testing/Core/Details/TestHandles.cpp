// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/Handles.h"

#include "Base/Error.h"
#include "Details/LoopSearch.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace quadrille
{
namespace
{

TEST(Handles, NoneOnASphereOrAPlate)
{
  for (const Mesh& mesh : { test::sphere(3), test::plateWithHole(4), test::openCylinder(12, 8) })
  {
    const HandleReport report = findHandles(mesh, 1e9);
    EXPECT_EQ(report.handles, 0u);
    EXPECT_TRUE(report.loops.empty());
    EXPECT_FALSE(report.shortest.has_value());
    EXPECT_TRUE(report.complete);
  }
}

TEST(Handles, GenusIsThatOfTheEulerCharacteristic)
{
  EXPECT_EQ(findHandles(test::torus(20, 10), 1e-3).handles, 1u);
  EXPECT_EQ(findHandles(test::doubleTorus(3), 1e-3).handles, 2u);
  EXPECT_EQ(
    findHandles(
      test::disjointUnion(test::torus(20, 10), test::doubleTorus(3), Vector3(9, 0, 0)), 1e-3)
      .handles,
    3u);
  // 25 holes have classes that fit into a label, 36 have not.
  for (const int n : { 5, 6 })
  {
    const Mesh sieve = test::voxelSurface(
      { 2 * n + 1, 2 * n + 1, 1 }, 1, [](int x, int y, int) { return x % 2 == 0 || y % 2 == 0; });
    const HandleReport report = findHandles(sieve, 4.01);
    EXPECT_EQ(report.handles, static_cast<std::size_t>(n * n));
    // Round each hole 4 sides of voxels; between two holes, or a hole and the rim, 4 as well.
    EXPECT_EQ(report.loops.size(), static_cast<std::size_t>(n * n));
    ASSERT_TRUE(report.shortest.has_value());
    EXPECT_DOUBLE_EQ(report.shortest->length, 4);
  }
}

TEST(Handles, BoundaryLoopsCountAsClosed)
{
  // A torus with a hole: cut along a loop round the hole it would fall apart.
  Mesh mesh = test::torus(40, 20, 1, 0.3);
  std::vector<test::Triangle> triangles;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (f != 7 && f != 401)
    {
      triangles.push_back({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
    }
  }
  mesh = test::makeMesh(mesh.position, triangles);
  const HandleReport report = findHandles(mesh, 3);
  EXPECT_EQ(report.handles, 1u);
  ASSERT_EQ(report.loops.size(), 1u);
  EXPECT_NEAR(report.loops[0].length, 2 * test::kPi * 0.3, 0.04 * 2 * test::kPi * 0.3);
}

/// Its lines of constant u are meridians, those of constant v wind three times round the tube.
Mesh twistedTorus(double radius, double tube)
{
  return test::parametricGrid(60, 24, true,
    [=](double u, double v)
    {
      const double a = 2 * test::kPi * u, b = 2 * test::kPi * (v + 3 * u);
      const double r = radius + tube * std::cos(b);
      return Vector3(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
    });
}

TEST(Handles, ShorterLoopOfAThinTorusIsItsMeridian)
{
  for (const Mesh& mesh : { test::torus(60, 24, 1, 0.2), twistedTorus(1, 0.2) })
  {
    const double meridian = 2 * test::kPi * 0.2;
    const HandleReport report = findHandles(mesh, 1.1 * meridian);
    ASSERT_EQ(report.loops.size(), 1u);
    // Polygons of 24 sides are 0.3 % short, paths up to 4 % long.
    EXPECT_NEAR(report.loops[0].length, meridian, 0.04 * meridian);
    EXPECT_TRUE(findHandles(mesh, 0.9 * meridian).loops.empty());
  }
}

TEST(Handles, ShorterLoopOfAFatTorusGoesThroughTheHole)
{
  const Mesh mesh = test::torus(60, 60, 1, 0.8);
  const double equator = 2 * test::kPi * 0.2;
  const HandleReport report = findHandles(mesh, 1.1 * equator);
  ASSERT_EQ(report.loops.size(), 1u);
  EXPECT_NEAR(report.loops[0].length, equator, 0.04 * equator);
  for (const Index v : report.loops[0].vertices)
  {
    EXPECT_LT(mesh.position[v].head<2>().norm(), 0.25);
  }
}

TEST(Handles, BothLoopsOfOneHandleShortCountsOnce)
{
  const HandleReport report = findHandles(test::torus(30, 20, 1, 0.45), 100);
  EXPECT_EQ(report.handles, 1u);
  EXPECT_EQ(report.loops.size(), 1u);
  EXPECT_EQ(findHandles(test::doubleTorus(3), 100).loops.size(), 2u);
}

TEST(Handles, TheShortestIsKnownAboveTheLimitToo)
{
  const HandleReport report = findHandles(test::torus(60, 24, 1, 0.2), 0.01);
  EXPECT_TRUE(report.loops.empty());
  ASSERT_TRUE(report.shortest.has_value());
  EXPECT_NEAR(report.shortest->length, 2 * test::kPi * 0.2, 0.04 * 2 * test::kPi * 0.2);
}

TEST(Handles, TinyHandleOnASphereIsFoundAtItsPlace)
{
  const Vector3 place = Vector3(1, 2, 3).normalized();
  const test::SphereWithHandle model = test::sphereWithHandle(4, place);
  ASSERT_EQ(validate(model.mesh), "");
  const HandleReport report = findHandles(model.mesh, 3 * model.mouthLength);
  EXPECT_EQ(report.handles, 1u);
  ASSERT_EQ(report.loops.size(), 1u);
  EXPECT_LE(report.loops[0].length, 1.0001 * model.mouthLength);
  for (const Index v : report.loops[0].vertices)
  {
    EXPECT_LT((model.mesh.position[v] - place).norm(), 0.3);
  }
}

TEST(Handles, SameLoopsAgain)
{
  const Mesh mesh = test::doubleTorus(4);
  const HandleReport a = findHandles(mesh, 100), b = findHandles(mesh, 100);
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i)
  {
    EXPECT_EQ(a.loops[i].vertices, b.loops[i].vertices);
    EXPECT_EQ(a.loops[i].length, b.loops[i].length);
  }
}

TEST(Handles, LimitMustBePositive)
{
  EXPECT_THROW(findHandles(test::torus(20, 10), 0), InvalidInput);
  EXPECT_THROW(
    findHandles(test::torus(20, 10), std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}

TEST(LoopSearch, LoopsAreClosedSimpleAndAsLongAsTheirEdges)
{
  const Mesh mesh = test::doubleTorus(4);
  LoopSearch search(mesh, LoopSearch::kInnerEdges);
  LoopSearch::LoopsByLabel loops;
  for (const Index root : search.roots())
  {
    search.search(root, 5, loops);
  }
  ASSERT_GE(loops.size(), 4u);
  for (const auto& [label, loop] : loops)
  {
    ASSERT_EQ(loop.arcs.size(), loop.vertices.size());
    double length = 0;
    for (std::size_t i = 0; i < loop.arcs.size(); ++i)
    {
      const Index h = loop.arcs[i].halfEdge;
      const Index a = loop.vertices[i], b = loop.vertices[(i + 1) % loop.vertices.size()];
      EXPECT_FALSE(loop.arcs[i].across);
      EXPECT_TRUE((mesh.origin[h] == a && mesh.target(h) == b) ||
        (mesh.origin[h] == b && mesh.target(h) == a));
      length += mesh.edgeVector(h).norm();
    }
    EXPECT_NEAR(loop.length, length, 1e-12);
    std::vector<Index> sorted = loop.vertices;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
    // With few handles the label is the class itself; a loop without corners crosses itself nowhere.
    ASSERT_EQ(search.classOf(loop).size(), 1u);
    EXPECT_EQ(search.classOf(loop)[0], label);
    EXPECT_EQ(__builtin_parityll(search.crossings(search.classOf(loop))[0] & label), 0);
  }
}

TEST(LoopSearch, MeridianAndEquatorCrossOnce)
{
  const Mesh mesh = test::torus(40, 20, 1, 0.45);
  LoopSearch search(mesh, LoopSearch::kStraightened);
  LoopSearch::LoopsByLabel loops;
  for (const Index root : search.roots())
  {
    search.search(root, 100, loops);
  }
  ASSERT_EQ(loops.size(), 3u); // meridian, equator, and the diagonal between
  for (const auto& [a, loop] : loops)
  {
    for (const auto& [b, other] : loops)
    {
      EXPECT_EQ(__builtin_parityll(search.crossings(search.classOf(loop))[0] & b), a != b);
    }
  }
}

TEST(Boundary, LoopsAndTheShortest)
{
  const BoundaryReport plate = measureBoundary(test::plateWithHole(4), 20);
  EXPECT_EQ(plate.loops, 2u);
  EXPECT_EQ(plate.shortLoops, 1u);
  EXPECT_DOUBLE_EQ(plate.shortest, 16); // 4 sides of 4 cells
  EXPECT_LT((plate.place - Vector3(6, 6, 0)).norm(), 3);
  const BoundaryReport sphere = measureBoundary(test::sphere(2), 20);
  EXPECT_EQ(sphere.loops, 0u);
  EXPECT_EQ(sphere.shortest, 0);
}

} // namespace
} // namespace quadrille
