// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BentCurves.h"

#include "Base/Angles.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Edges of quads along both boundary circles of an open cylinder together.
double quadsRound(const Mesh& cylinder, double edgeLength)
{
  const std::vector<double> quads = quadsAlongCurves(cylinder, edgeLength);
  return std::accumulate(quads.begin(), quads.end(), 0.0);
}

/// A chord of length e leaves a circle of radius r by e^2 / (8 r).
TEST(BentCurves, EdgesOnCirclesStayWithinATwentiethOfTheirLength)
{
  for (const double edgeLength : { 0.1, 0.5, 1.0, 2.0 })
  {
    const double edge = std::min(edgeLength, std::sqrt(0.4 * edgeLength));
    for (const int around : { 8, 12, 100 })
    {
      const double circles = 4 * around * std::sin(kPi / around);
      EXPECT_NEAR(
        quadsRound(openCylinder(around, 3), edgeLength), circles / edge, 0.03 * circles / edge)
        << around << " edges, quads of " << edgeLength;
    }
  }
}

/// Points between on the same edges change nothing, nor does a size that scales all.
TEST(BentCurves, PointsBetweenChangeNothing)
{
  // Every second point of the circle lies in the middle of a chord.
  const auto polygon = [](int sides, bool halved)
  {
    Mesh mesh = openCylinder(halved ? 2 * sides : sides, 1);
    for (Vector3& p : mesh.position.editAll())
    {
      const double angle = std::atan2(p.y(), p.x()), part = 2 * kPi / sides;
      const double before = part * std::floor(angle / part + 1e-6), t = (angle - before) / part;
      p.head<2>() = (1 - t) * Vector2(std::cos(before), std::sin(before)) +
        t * Vector2(std::cos(before + part), std::sin(before + part));
    }
    return mesh;
  };
  for (const double edgeLength : { 0.5, 1.0 })
  {
    const double whole = quadsRound(polygon(12, false), edgeLength);
    EXPECT_NEAR(quadsRound(polygon(12, true), edgeLength), whole, 0.05 * whole) << edgeLength;
  }
  const Mesh halfSized = withSizes(polygon(12, false), [](const Vector3&) { return 0.5; });
  EXPECT_NEAR(quadsRound(halfSized, 1.0), quadsRound(polygon(12, false), 0.5), 1e-9);
}

/// The sides of a square, and a staircase of steps below a quad, get what their lengths are worth.
TEST(BentCurves, CornersAndStepsAreNoBends)
{
  const Mesh square = gridPlane(8, 8);
  for (const double edgeLength : { 0.5, 1.0, 3.0 })
  {
    const std::vector<double> quads = quadsAlongCurves(square, edgeLength);
    for (Index h = 0; h < square.halfEdgeCount(); ++h)
    {
      EXPECT_NEAR(quads[h], square.isBoundary(h) ? 1 / edgeLength : 0, 1e-9);
    }
  }
  Mesh jagged = gridPlane(40, 4);
  for (Vector3& p : jagged.position.editAll())
  {
    const bool isOdd = std::lround(p.x()) % 2 != 0;
    p.y() += p.y() == 0 && isOdd ? -0.3 : 0.0;
  }
  const std::vector<double> quads = quadsAlongCurves(jagged, 8.0);
  double asked = 0, length = 0;
  for (Index h = 0; h < jagged.halfEdgeCount(); ++h)
  {
    const bool isInside = jagged.isBoundary(h) && jagged.position[jagged.origin[h]].y() <= 0 &&
      std::abs(jagged.position[jagged.origin[h]].x() - 20) < 10;
    asked += isInside ? quads[h] : 0;
    length += isInside ? jagged.edgeVector(h).norm() / 8.0 : 0;
  }
  EXPECT_NEAR(asked, length, 1e-9);
}

/// What is known to be smooth has no corner, however few points it has.
TEST(BentCurves, KnownToBeSmooth)
{
  const Mesh square = openCylinder(4, 1);
  const std::vector<std::uint8_t> smooth(square.vertexCount(), 1);
  const std::vector<double> corners = quadsAlongCurves(square, 1.0);
  const std::vector<double> circle = quadsAlongCurves(square, 1.0, smooth);
  for (Index h = 0; h < square.halfEdgeCount(); ++h)
  {
    if (square.isBoundary(h))
    {
      EXPECT_NEAR(corners[h], std::sqrt(2.0), 1e-9);
      EXPECT_GT(circle[h], 1.5 * corners[h]);
    }
  }
}

} // namespace
} // namespace quadrille
