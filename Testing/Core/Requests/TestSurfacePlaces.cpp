// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Nearest places by a tree against looking at all of them, and places along strokes.
#include "Requests/GuidedPlaces.h"
#include "Requests/SurfacePlaces.h"

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
  for (int i = 0; i < 200; ++i)
  {
    const Vector3 p = randomPlace(random);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f + 1 < input.polygonOffsets.size(); ++f)
    {
      const auto at = [&](std::size_t k) { return input.points[input.polygonPoints[3 * f + k]]; };
      least = std::min(least, (nearestOnTriangle(p, at(0), at(1), at(2)) - p).norm());
    }
    const SurfacePlaces::Place place = places.nearestPlace(p);
    EXPECT_EQ((place.point - p).norm(), least);
    EXPECT_EQ(places.nearestPlace(place.point).point, place.point); // it is on the surface now
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
  EXPECT_EQ(places.nearestPlace({ 8, 8, 8 }).point, Vector3(2, 1, 0)); // point 6 is on no polygon
  EXPECT_TRUE(places.isOnBoundary(places.nearestPlace({ 1, 1, 0 })));
  EXPECT_THROW(places.nearestPlace({ std::nan(""), 0, 0 }), InvalidInput);
  input.polygonPoints.edit()[3] = 7;
  EXPECT_THROW(SurfacePlaces{ input }, InvalidInput);
}

TEST(SurfacePlaces, KnowTheBoundary)
{
  const SurfaceInput open = toInput(gridPlane(4, 4));
  const SurfacePlaces places(open);
  const auto isOnBoundary = [&places](const Vector3& p)
  { return places.isOnBoundary(places.nearestPlace(p)); };
  for (const Vector3& at : open.points)
  {
    const bool isBorder = at.x() == 0 || at.x() == 4 || at.y() == 0 || at.y() == 4;
    EXPECT_EQ(isOnBoundary(at), isBorder) << at.transpose();
  }
  EXPECT_TRUE(isOnBoundary({ 1.3, 0, 0 }));
  EXPECT_TRUE(isOnBoundary({ 1.3, -2, 0 })); // comes to lie there
  EXPECT_FALSE(isOnBoundary({ 1.3, 0.01, 0 }));
}

/// Every triangle has points of its own, as in STL files.
TEST(SurfacePlaces, PointsAtOnePlaceAreNoBoundary)
{
  const SurfaceInput joined = toInput(gridPlane(2, 2));
  SurfaceInput soup;
  for (const Index p : joined.polygonPoints)
  {
    soup.polygonPoints.push_back(static_cast<Index>(soup.points.size()));
    soup.points.push_back(joined.points[p]);
  }
  soup.polygonOffsets = joined.polygonOffsets;
  const SurfacePlaces places(soup);
  EXPECT_FALSE(places.isOnBoundary(places.nearestPlace({ 1, 1, 0 })));
  EXPECT_TRUE(places.isOnBoundary(places.nearestPlace({ 1, 2, 0 })));
}

TEST(GuidedPlaces, LieWithinTheRadiusWithTheDirectionOfTheStroke)
{
  // Two triangles, larger than all that is asked for.
  const SurfaceInput input = toInput(gridPlane(1, 1));
  const SurfacePlaces places(input);
  constexpr double kRadius = 0.1;
  const Vector3 a(0.3, 0.4, 0), b(0.7, 0.6, 0);
  const Vector3 along = (b - a).normalized();
  const std::vector<GuidedPlace> found = guidedAlong(input, places, { a, b }, 0.5, kRadius);
  double area = 0, farthest = 0;
  for (const GuidedPlace& guided : found)
  {
    const double distance = distanceToSegment(guided.place, a, b);
    EXPECT_LE(distance, kRadius + 1e-12);
    farthest = std::max(farthest, distance);
    EXPECT_NEAR(std::abs(guided.direction.dot(along)), 1, 1e-9);
    EXPECT_EQ(guided.weight, 0.5);
    area += guided.area;
  }
  EXPECT_GT(farthest, 0.7 * kRadius);
  const double whole = 2 * kRadius * (b - a).norm() + 3.14159 * kRadius * kRadius;
  EXPECT_NEAR(area, whole,
    0.02 * whole); // steps of a sixth of the radius, each place in the middle of its own
  const std::vector<GuidedPlace> under = guidedAlong(input, places, { a, b }, 1, 0);
  EXPECT_GT(under.size(), 100U);
  for (const GuidedPlace& guided : under)
  {
    EXPECT_LT(distanceToSegment(guided.place, a, b), 1e-12);
  }
}

/// A stroke over an edge goes on along it on both sides.
TEST(GuidedPlaces, FollowTheSurfaceOverItsEdges)
{
  const SurfaceInput input = toInput(unitCube(1));
  const SurfacePlaces places(input);
  const std::vector<Vector3> course{ { 0.5, 0.5, 1 }, { 1, 0.5, 1 }, { 1, 0.5, 0.5 } };
  for (const GuidedPlace& guided : guidedAlong(input, places, course, 1, 0.2))
  {
    const bool isOnTop = guided.normal.z() > 0.5;
    EXPECT_NEAR(std::abs(isOnTop ? guided.direction.x() : guided.direction.z()), 1, 1e-9)
      << guided.place.transpose();
    EXPECT_NEAR(isOnTop ? guided.place.z() : guided.place.x(), 1, 1e-9);
    EXPECT_LE(std::abs(guided.place.y() - 0.5), 0.2 + 1e-9);
  }
}

/// What lies round an edge beside a stroke, or beyond its end, is another side.
TEST(GuidedPlaces, StayOnTheSideOfTheStroke)
{
  const SurfaceInput input = toInput(unitCube(1));
  const SurfacePlaces places(input);
  const std::vector<Vector3> course{ { 0.5, 0.95, 1 }, { 0.9, 0.95, 1 } };
  const std::vector<GuidedPlace> found = guidedAlong(input, places, course, 1, 0.2);
  double farthest = 0;
  for (const GuidedPlace& guided : found)
  {
    EXPECT_EQ(guided.place.z(), 1);
    farthest = std::max(farthest, guided.place.x());
  }
  EXPECT_GT(farthest, 0.95);
}

} // namespace
} // namespace quadrille
