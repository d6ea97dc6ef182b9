// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInputs.h"

namespace quadrille
{

namespace
{

using namespace test;

double planarArea(const std::vector<Vector3>& points)
{
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Vector3& p = points[i];
    const Vector3& q = points[(i + 1) % points.size()];
    sum += (p.x() * q.y() - p.y() * q.x()) / 2;
  }
  return sum;
}

PreparedSurface prepareOne(const std::vector<Vector3>& points, std::uint8_t features = 0)
{
  std::vector<Index> corners;
  for (Index i = 0; i < points.size(); ++i)
  {
    corners.push_back(i);
  }
  SurfaceInput input = makeInput(points, { corners });
  input.featureEdges = { features };
  PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  return surface;
}

/// A comb with n teeth: half of its corners are reflex.
std::vector<Vector3> comb(int n)
{
  std::vector<Vector3> points{ { 0, -1, 0 }, { 2.0 * n, -1, 0 } };
  for (int i = n; i > 0; --i)
  {
    points.emplace_back(2 * i - 0.5, 5, 0);
    points.emplace_back(2 * i - 1.0, 0, 0);
    if (i > 1)
    {
      points.emplace_back(2 * i - 2.0, 0.1, 0);
    }
  }
  return points;
}

} // namespace

TEST(Triangulate, AreaAndOrientationOfConvexAndOtherPolygons)
{
  std::vector<Vector3> arrow{ { 0, 0, 0 }, { 2, -2, 0 }, { 1, 0, 0 }, { 2, 2, 0 } };
  std::vector<Vector3> circle, star;
  for (int i = 0; i < 40; ++i)
  {
    const double angle = 2 * kPi * i / 40;
    const double r = i % 2 == 0 ? 1 : 0.2;
    circle.emplace_back(std::cos(angle), std::sin(angle), 0);
    star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  for (const std::vector<Vector3>& polygon : { arrow, circle, star, comb(30) })
  {
    const PreparedSurface surface = prepareOne(polygon);
    EXPECT_EQ(surface.mesh.faceCount(), polygon.size() - 2);
    EXPECT_EQ(surface.repair.triangulatedPolygons, 1u);
    // Covering without overlap: unsigned triangle areas add up to the polygon's signed one.
    EXPECT_NEAR(surface.area, planarArea(polygon), 1e-12 * surface.area);
    for (Index f = 0; f < surface.mesh.faceCount(); ++f)
    {
      EXPECT_GT(faceNormal(surface.mesh, f).z(), 0.5);
    }
  }
}

TEST(Triangulate, AnyPlaneWorks)
{
  std::vector<Vector3> polygon = comb(5);
  const Eigen::AngleAxisd turn(1.1, Vector3(1, 2, 3).normalized());
  for (Vector3& p : polygon)
  {
    p = turn * p + Vector3(100, -50, 20);
  }
  // Coordinates near 100 are rounded to 1e-14; areas of size 10 by about as much.
  EXPECT_NEAR(prepareOne(polygon).area, planarArea(comb(5)), 1e-10);
}

TEST(Triangulate, CollinearCornersMakeNoDegenerateFaces)
{
  const PreparedSurface surface = prepareOne({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 },
    { 3, 1, 0 }, { 2, 1, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
  EXPECT_EQ(surface.repair.degenerateFaces, 0u);
  EXPECT_EQ(surface.mesh.faceCount(), 6u);
  EXPECT_NEAR(surface.area, 3, 1e-14);
}

TEST(Triangulate, RepeatedCornersAreDropped)
{
  const SurfaceInput input = makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
    { { 0, 0, 1, 2, 2, 3, 0 }, { 1, 1, 2 }, { 3, 3, 3, 3 } });
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.mesh.faceCount(), 2u);
  EXPECT_EQ(surface.repair.degenerateFaces, 2u);
}

TEST(Triangulate, AHoleJoinedByASlitIsLeftOut)
{
  // Outer square, slit to the inner square, around it the other way, and back.
  const SurfaceInput input = makeInput({ { 0, 0, 0 }, { 3, 0, 0 }, { 3, 3, 0 }, { 0, 3, 0 },
                                         { 1, 1, 0 }, { 1, 2, 0 }, { 2, 2, 0 }, { 2, 1, 0 } },
    { { 0, 1, 2, 3, 0, 4, 5, 6, 7, 4 } });
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_NEAR(surface.area, 8, 1e-14);
  EXPECT_EQ(summarizeTopology(surface.mesh).boundaryLoops, 2u);
}

TEST(Triangulate, FeatureBitsBelongToPolygonEdgesOnly)
{
  SurfaceInput input =
    makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 2, 1, 0 } },
      { { 0, 1, 2, 3 }, { 1, 4, 5, 2 } });
  input.featureEdges = { 2, 0 }; // from corner 1 to corner 2 of the first: the shared edge
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  ASSERT_EQ(featureHalfEdges(surface.mesh), 2u);
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    if (surface.mesh.isFeature(h))
    {
      EXPECT_EQ(surface.mesh.position[surface.mesh.origin[h]].x(), 1);
      EXPECT_EQ(surface.mesh.position[surface.mesh.target(h)].x(), 1);
    }
  }
}

TEST(Triangulate, QuadMeshGivesTheSurface)
{
  // Sides of a cube as quads: twelve faces, closed.
  const SurfaceInput input = makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 },
                                         { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, { 1, 1, 1 } },
    { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
      { 1, 3, 7, 5 } });
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.mesh.faceCount(), 12u);
  EXPECT_EQ(surface.repair.text(), "6 polygons triangulated");
  EXPECT_NEAR(signedVolume(surface.mesh), 1, 1e-14);
}

} // namespace quadrille
