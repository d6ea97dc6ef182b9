// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadProjection.h"
#include "Quads/QuadShape.h"
#include "TestMeshes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

using Corners4 = std::vector<std::array<Index, 4>>;

struct QuadGrid
{
  std::vector<Vector3> points;
  Corners4 quads;
};

/// n by n squares over [0, 1]^2 at height z; facing up, or down.
QuadGrid gridAt(int n, double z, bool down = false)
{
  QuadGrid grid;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      grid.points.emplace_back(double(i) / n, double(j) / n, z);
    }
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const Index a = static_cast<Index>(j * (n + 1) + i), b = a + static_cast<Index>(n) + 1;
      grid.quads.push_back(down ? std::array<Index, 4>{ a, b, b + 1, a + 1 }
                                : std::array<Index, 4>{ a, a + 1, b + 1, b });
    }
  }
  return grid;
}

QuadGrid together(QuadGrid a, const QuadGrid& b)
{
  const Index shift = static_cast<Index>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const std::array<Index, 4>& q : b.quads)
  {
    a.quads.push_back({ q[0] + shift, q[1] + shift, q[2] + shift, q[3] + shift });
  }
  return a;
}

/// Two triangles at z = 0 over [0, width] x [0, 1]; the second one turned round, as in a soup.
TriangleList plateOf(double width)
{
  return { { { 0, 0, 0 }, { width, 0, 0 }, { width, 1, 0 }, { 0, 1, 0 } },
    { { 0, 1, 2 }, { 0, 3, 2 } } };
}

TEST(QuadProjection, PutsPointsOntoTheSurface)
{
  QuadGrid grid = gridAt(4, 0.05);
  const QuadProjectionReport report =
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(1)), { 0.1, 1, 1 });
  EXPECT_EQ(report.moved, grid.points.size());
  EXPECT_EQ(grid.points, gridAt(4, 0).points); // every coordinate is a sum of powers of two
}

TEST(QuadProjection, LeavesWhatIsFar)
{
  QuadGrid grid = gridAt(4, 0.05);
  const QuadGrid before = grid;
  const QuadProjectionReport report =
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(0.5)), { 0.1, 1, 1 });
  EXPECT_EQ(report.moved, 15u); // three of five columns
  EXPECT_EQ(report.far, 10u);
  for (std::size_t i = 0; i < grid.points.size(); ++i)
  {
    EXPECT_EQ(grid.points[i].z(), before.points[i].x() > 0.5 ? 0.05 : 0);
  }
}

TEST(QuadProjection, LeavesWhatHasAnotherDirection)
{
  QuadGrid grid = gridAt(4, 0.05);
  for (Vector3& p : grid.points)
  {
    p = Vector3(0.05, p.x(), p.y() + 0.01); // upright on the plate
  }
  const QuadProjectionReport report =
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(1)), { 0.1, 1, 1 });
  EXPECT_EQ(report.turned, 5u); // the lowest row
  EXPECT_EQ(report.far, 20u);
}

TEST(QuadProjection, LeavesBothSidesOfASheet)
{
  QuadGrid grid = together(gridAt(4, 0.05), gridAt(4, -0.05, true));
  const std::vector<Vector3> before = grid.points;
  const QuadProjectionReport report =
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(1)), { 0.1, 1, 1 });
  EXPECT_EQ(report.twoSided, grid.points.size());
  EXPECT_EQ(grid.points, before);
}

TEST(QuadProjection, TurnsNoQuadOver)
{
  // Onto a strip that is narrower than a quad, all points of three columns would fall upon its border.
  QuadGrid grid = gridAt(4, 0.05);
  const QuadProjectionReport report =
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(0.1)), { 2, 1, 1 });
  EXPECT_EQ(report.moved + report.kept, grid.points.size());
  EXPECT_GT(report.kept, 0u);
  EXPECT_TRUE(invertedQuads(grid.points, grid.quads).empty());
}

TEST(QuadProjection, IsTheSameForAnyNumberOfThreads)
{
  QuadGrid one = gridAt(32, 0.05), many = one;
  const NearestTriangle plate(plateOf(0.7));
  projectQuads(one.points, one.quads, plate, { 0.3, 1, 1 });
  projectQuads(many.points, many.quads, plate, { 0.3, 1, 4 });
  EXPECT_EQ(one.points, many.points);
}

TEST(NearestTriangle, SegmentsAreFoundByTheirWay)
{
  TriangleList list;
  list.points = { Vector3(0, 0, 0), Vector3(1, 0, 0) };
  list.corners = { { 0, 1, 0 }, { 1, 0, 1 } };
  const NearestTriangle segments(std::move(list));
  const Vector3 place(0.25, 0, 0.5), way(1, 3, 0);
  const auto there = segments.at(place, way), back = segments.at(place, -way);
  ASSERT_TRUE(there && back);
  EXPECT_EQ(there->triangle, 0U);
  EXPECT_EQ(back->triangle, 1U);
  EXPECT_EQ(there->point, back->point);
  EXPECT_FALSE(segments.at(place, Vector3(0, 1, 0)));
}

TEST(QuadProjection, RefusesADistanceThatIsNone)
{
  QuadGrid grid = gridAt(1, 0);
  EXPECT_THROW(
    projectQuads(grid.points, grid.quads, NearestTriangle(plateOf(1)), {}), InvalidInput);
}

} // namespace
