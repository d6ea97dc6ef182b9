// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sizing.h"
#include "Prepare/Refine.h"

#include "Details/Handles.h"
#include "Features/FeatureFilter.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

double slope(const Mesh& mesh, double edgeLength)
{
  double most = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const double change = sizeAt(mesh, mesh.target(h)) - sizeAt(mesh, mesh.origin[h]);
    most = std::max(most, change * edgeLength / mesh.edgeVector(h).norm());
  }
  return most;
}

TEST(Sizing, GrowthIsLimitedFromTheSmallestOn)
{
  const auto step = [](const Vector3& p) { return p.x() > 20 ? 1.0 : 0.25; };
  Mesh mesh = withSizes(gridPlane(40, 8), step);
  const SizingReport report = limitSizeGrowth(mesh, 2.0);
  EXPECT_LE(slope(mesh, 2.0), kSizeGrowth * (1 + 1e-5)); // sizes are floats
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    // Straight along the grid the limit is met exactly: 1/8 a unit, as 2 units are an edge length.
    const double x = mesh.position[v].x();
    EXPECT_NEAR(sizeAt(mesh, v), x <= 20 ? 0.25 : std::min(1.0, 0.25 + 0.125 * (x - 20)), 1e-6);
  }
  EXPECT_EQ(report.changed, 9U * 5U); // columns 21 to 25; at 26 the size 1 is reached
  EXPECT_NEAR(report.most, 1 / 0.375, 1e-6);
  EXPECT_EQ(mesh.position[report.vertex].x(), 21);
  EXPECT_TRUE(test::contains(sizingNotice(mesh, report), "45 of 369 vertices"));
}

TEST(Sizing, GentleSizesStayAsTheyAre)
{
  Mesh mesh =
    withSizes(gridPlane(20, 20), [](const Vector3& p) { return 1 + 0.01 * (p.x() + p.y()); });
  const std::vector<float> before = mesh.sizing;
  const SizingReport report = limitSizeGrowth(mesh, 1.0);
  EXPECT_EQ(mesh.sizing, before);
  EXPECT_EQ(report.changed, 0U);
  EXPECT_TRUE(sizingNotice(mesh, report).empty());
  EXPECT_THROW(limitSizeGrowth(mesh, 0), InvalidInput);
}

TEST(Sizing, AreaOverSizesIsTheIntegral)
{
  // Of 1 / (1 + x)^2 over [0, 7] x [0, 1]: 1 - 1 / 8, also where two triangles have all of it.
  const auto size = [](const Vector3& p) { return 1 + p.x(); };
  EXPECT_NEAR(sizedArea(withSizes(gridPlane(7, 1), size)), 7.0 / 8, 2e-3);
  Mesh two = makeMesh({ { 0, 0, 0 }, { 7, 0, 0 }, { 7, 1, 0 }, { 0, 1, 0 } },
    { Triangle{ 0, 1, 2 }, Triangle{ 0, 2, 3 } });
  EXPECT_NEAR(sizedArea(withSizes(two, size)), 7.0 / 8, 2e-3);
  EXPECT_NEAR(sizedArea(gridPlane(7, 1)), 7, 1e-12);
}

TEST(Sizing, TrianglesHaveTheLengthsOfTheirEdgesOverSizes)
{
  const Mesh mesh =
    withSizes(gridPlane(3, 3), [](const Vector3& p) { return 1 + 0.2 * p.x() + 0.1 * p.y(); });
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const SizedTriangle triangle = sizedTriangle(mesh, f);
    EXPECT_NEAR(triangle.width, sizedLength(mesh, 3 * f), 1e-12);
    EXPECT_NEAR(
      (triangle.apex - Vector2(triangle.width, 0)).norm(), sizedLength(mesh, 3 * f + 1), 1e-12);
    EXPECT_NEAR(triangle.apex.norm(), sizedLength(mesh, 3 * f + 2), 1e-12);
    EXPECT_GT(triangle.apex.y(), 0);
  }
}

TEST(Sizing, TriangleStaysOneWhereSizesDifferTooMuch)
{
  // Edges 1, 1, sqrt 2 with sizes 100, 1, 1 would be 0.1, 1, 0.14 long.
  Mesh mesh = makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { Triangle{ 0, 1, 2 } });
  mesh.sizing = { 100, 1, 1 };
  const SizedTriangle triangle = sizedTriangle(mesh, 0);
  const double mean = std::cbrt(100.0);
  EXPECT_NEAR(triangle.width, 1 / mean, 1e-12);
  EXPECT_NEAR((triangle.apex - Vector2(0, 1 / mean)).norm(), 0, 1e-12);
}

TEST(Sizing, ComesFromThePointsAndFollowsTheOrder)
{
  const auto size = [](const Vector3& p) { return 1 + 0.01 * p.x() + 0.001 * p.y(); };
  const Mesh mesh = gridPlane(12, 9);
  SurfaceInput input = toInput(mesh);
  input.points.push_back(Vector3(50, 50, 50)); // on no face: dropped
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back(static_cast<float>(size(p)));
  }
  PreparedSurface surface = prepare(input);
  ASSERT_EQ(surface.mesh.sizing.size(), surface.mesh.position.size());
  // Refinement adds vertices at middles, where a linear size is the mean, and puts all into a new order.
  refineSurface(surface, 0.4, {});
  ASSERT_EQ(surface.mesh.sizing.size(), surface.mesh.position.size());
  EXPECT_GT(surface.mesh.vertexCount(), 4 * mesh.vertexCount());
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    EXPECT_NEAR(surface.mesh.sizing[v], size(surface.mesh.position[v]), 1e-6);
  }
}

TEST(Sizing, OfJoinedPointsTheSmallestCounts)
{
  SurfaceInput input = toSoup(gridPlane(2, 2));
  for (std::size_t i = 0; i < input.points.size(); ++i)
  {
    input.sizing.push_back(i == 3 ? 0.25F : 1.0F);
  }
  const Vector3 place = input.points[3];
  const PreparedSurface surface = prepare(input);
  EXPECT_GT(surface.repair.mergedPoints, 0U);
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    EXPECT_EQ(surface.mesh.sizing[v], surface.mesh.position[v] == place ? 0.25F : 1.0F);
  }
}

TEST(Sizing, SplitsEdgesByTheSizeThere)
{
  const auto step = [](const Vector3& p) { return p.x() > 5 ? 1.0 : 0.25; };
  SurfaceInput input = toInput(gridPlane(10, 4));
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back(static_cast<float>(step(p)));
  }
  PreparedSurface surface = prepare(input);
  refineSurface(surface, 1.5, {});
  const Mesh& mesh = surface.mesh;
  double longestFine = 0, longestCoarse = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_LE(sizedLength(mesh, h), 1.5 * (1 + 1e-9));
    const Vector3 middle = (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2;
    double& longest = middle.x() < 4 ? longestFine : longestCoarse;
    longest = std::max(longest, mesh.edgeVector(h).norm());
  }
  EXPECT_LE(longestFine, 0.375);
  EXPECT_GE(longestCoarse, 1);
}

TEST(Sizing, HandlesAreMeasuredInSizes)
{
  // Round the tube it is 2 pi 0.2 = 1.26; with half the size that is as long as 2.5 where sizes are 1.
  const Mesh thin = torus(60, 16, 1, 0.2);
  const double plain = findHandles(thin, 2).loops.front().length;
  const HandleReport halved = findHandles(withSizes(thin, [](const Vector3&) { return 0.5; }), 2);
  EXPECT_TRUE(halved.loops.empty());
  ASSERT_TRUE(halved.shortest.has_value());
  EXPECT_NEAR(halved.shortest->length, 2 * plain, 1e-9);
  const Mesh cylinder = openCylinder(40, 10);
  const double loop = measureBoundary(cylinder, 1).shortest;
  EXPECT_NEAR(measureBoundary(withSizes(cylinder, [](const Vector3&) { return 0.5; }), 1).shortest,
    2 * loop, 1e-9);
}

TEST(Sizing, FeaturesAreMeasuredInSizes)
{
  // A chain of two edges that ends inside: 2 long, too short for s = 4, long enough with a quarter of the size.
  SurfaceInput input = toInput(gridPlane(12, 12));
  PreparedSurface surface = prepare(input);
  const auto mark = [](Mesh& mesh)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& a = mesh.position[mesh.origin[h]];
      const Vector3& b = mesh.position[mesh.target(h)];
      if (a.y() == 6 && b.y() == 6 && std::min(a.x(), b.x()) >= 5 && std::max(a.x(), b.x()) <= 7)
      {
        mesh.flags.edit()[h] |= kFeatureEdge;
      }
    }
  };
  mark(surface.mesh);
  Mesh sized = withSizes(surface.mesh, [](const Vector3&) { return 0.125; });
  EXPECT_GT(removeUnresolvedFeatures(surface.mesh, 4).removedEdges, 0U);
  EXPECT_EQ(removeUnresolvedFeatures(sized, 4).removedEdges, 0U);
}

TEST(Sizing, WrongSizesAreRefusedByName)
{
  const auto message = [](float size)
  {
    SurfaceInput input = toInput(gridPlane(2, 2));
    input.sizing.assign(input.points.size(), 1.0F);
    input.sizing[4] = size;
    return messageOf([&] { prepare(input); });
  };
  for (const float size : { 0.0F, -1.0F, std::numeric_limits<float>::infinity(),
         std::numeric_limits<float>::quiet_NaN() })
  {
    EXPECT_TRUE(test::contains(message(size), "the size of point 4 is")) << message(size);
  }
  SurfaceInput input = toInput(gridPlane(2, 2));
  input.sizing = { 1, 1 };
  EXPECT_TRUE(test::contains(messageOf([&] { prepare(input); }), "2 values for 9 points"));
}

} // namespace
} // namespace quadrille
