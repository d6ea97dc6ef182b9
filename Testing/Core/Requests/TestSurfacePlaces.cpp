// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Nearest places by trees against looking at all of them, and what strokes cover.
#include "Requests/DrawnConstraints.h"

#include "Base/Error.h"
#include "Mesh/Distance.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

Vector3 randomPlace(std::mt19937& random)
{
  std::uniform_real_distribution<double> in(-1.6, 1.6);
  return { in(random), in(random), in(random) };
}

TEST(SurfacePlaces, AreThoseOfLookingAtAll)
{
  const SurfaceInput input = toInput(torus(24, 12));
  const SurfacePlaces places(input, 2);
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) // more than it takes for a tree of the corners
  {
    const Vector3 p = randomPlace(random);
    Index corner = 0;
    for (Index v = 0; v < input.points.size(); ++v)
    {
      corner = (input.points[v] - p).norm() < (input.points[corner] - p).norm() ? v : corner;
    }
    EXPECT_EQ(places.nearestCorner(p), corner);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f + 1 < input.polygonOffsets.size(); ++f)
    {
      const auto at = [&](std::size_t k) { return input.points[input.polygonPoints[3 * f + k]]; };
      least = std::min(least, (nearestOnTriangle(p, at(0), at(1), at(2)) - p).norm());
    }
    const SurfacePlaces::Place place = places.nearestPlace(p);
    EXPECT_EQ((place.point - p).norm(), least);
  }
}

TEST(SurfacePlaces, NearestOnATriangleIsNotFartherThanAnyOfItsPoints)
{
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i)
  {
    const Vector3 p = randomPlace(random), a = randomPlace(random), b = randomPlace(random);
    // Also triangles without area.
    const Vector3 c = i % 4 == 0 ? Vector3(0.5 * (a + b)) : i % 4 == 1 ? a : randomPlace(random);
    const double distance = (nearestOnTriangle(p, a, b, c) - p).norm();
    constexpr int kSteps = 12;
    for (int u = 0; u <= kSteps; ++u)
    {
      for (int v = 0; u + v <= kSteps; ++v)
      {
        const Vector3 q = a + (b - a) * u / kSteps + (c - a) * v / kSteps;
        EXPECT_LE(distance, (q - p).norm() + 1e-12); // rounding
      }
    }
  }
}

TEST(SurfacePlaces, PolygonsAreTakenAsTheirTriangles)
{
  // A square without a quarter, as one polygon that is not convex: the missing quarter is no place on it.
  SurfaceInput input;
  input.points = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 1, 1, 0 }, { 1, 2, 0 }, { 0, 2, 0 },
    { 9, 9, 9 } };
  input.polygonPoints = { 0, 1, 2, 3, 4, 5 };
  input.polygonOffsets = { 0, 6 };
  const SurfacePlaces places(input);
  EXPECT_LT((places.nearestPlace({ 1.5, 1.75, 0 }).point - Vector3(1, 1.75, 0)).norm(), 1e-15);
  EXPECT_EQ(places.nearestPlace({ 0.5, 0.5, 3 }).point, Vector3(0.5, 0.5, 0));
  EXPECT_EQ(places.nearestCorner({ 8, 8, 8 }), 2u); // point 6 is on no polygon
  EXPECT_TRUE(places.isOnBoundary(3));
  EXPECT_THROW(places.nearestPlace({ std::nan(""), 0, 0 }), InvalidInput);
  EXPECT_THROW(places.nearestCorner({ std::nan(""), 0, 0 }), InvalidInput);
  input.polygonPoints.edit()[3] = 7;
  EXPECT_THROW(SurfacePlaces{ input }, InvalidInput);
}

TEST(SurfacePlaces, KnowTheBoundary)
{
  const SurfaceInput open = toInput(gridPlane(4, 4));
  const SurfacePlaces places(open);
  for (Index p = 0; p < open.points.size(); ++p)
  {
    const Vector3& at = open.points[p];
    const bool isBorder = at.x() == 0 || at.x() == 4 || at.y() == 0 || at.y() == 4;
    EXPECT_EQ(places.isOnBoundary(p), isBorder) << at.transpose();
  }
}

TEST(DrawnConstraints, AStrokeCoversItsRadius)
{
  const SurfaceInput input = toInput(gridPlane(20, 20));
  const SurfacePlaces places(input);
  constexpr double kRadius = 2.2;
  const Vector3 a(5.3, 10.4, 0), b(14.6, 10.4, 0);
  ConstraintPlacement placement(input, places);
  placement.addStroke({ 0, { a, b } }, 0.5, kRadius);
  const std::vector<GuideMark> marks = placement.guideMarks();
  std::vector<bool> isMarked(input.polygonOffsets.size() - 1, false);
  for (const GuideMark& mark : marks)
  {
    isMarked[mark.polygon] = true;
    EXPECT_LT((mark.direction - Vector3(1, 0, 0)).norm(), 1e-14); // places are rounded
    EXPECT_EQ(mark.weight, 0.5);
  }
  for (Index f = 0; f < isMarked.size(); ++f)
  {
    const Vector3 centre = guidedPolygon(input, f, Vector3::UnitX(), 1).centre;
    const double distance = distanceToSegment(centre, a, b);
    if (distance > 1) // those below the stroke are marked wherever their centres are
    {
      EXPECT_EQ(isMarked[f], distance <= kRadius) << centre.transpose();
    }
  }
}

} // namespace
} // namespace quadrille
