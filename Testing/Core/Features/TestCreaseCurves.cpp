// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/CreaseCurves.h"

#include "Base/Error.h"
#include "Features/Features.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace quadrille
{
namespace
{

constexpr double kSharp = 40 * test::kPi / 180;

/// Edges that are features.
Index featuresOf(const Mesh& mesh)
{
  return test::featureHalfEdges(mesh) / 2;
}

/// As the pipeline has them: by the angle, resolved, judged.
CreaseReport judge(Mesh& mesh, double edgeLength, int threads = 1)
{
  markCreases(mesh, kSharp, threads);
  FeatureFilterReport filtered = removeUnresolvedFeatures(mesh, edgeLength);
  return removeFalseCreases(mesh, edgeLength, threads, filtered);
}

/// Normal noise with this standard deviation on each coordinate, the same for the same seed.
Mesh noisy(Mesh mesh, double deviation, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, deviation);
  for (Vector3& p : mesh.position.editAll())
  {
    p += Vector3(noise(random), noise(random), noise(random));
  }
  return mesh;
}

/// A sheet of unit squares with the height that is asked for.
Mesh sheet(int columns, int rows, const std::function<double(double x, double y)>& height)
{
  Mesh mesh = test::gridPlane(columns, rows);
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() = height(p.x(), p.y());
  }
  return mesh;
}

/// The edges of the row y = 12 from column a to column b become features; requested ones with `flags`.
void markRidge(Mesh& mesh, double a, double b, std::uint8_t flags = kFeatureEdge)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    if (p.y() == 12 && q.y() == 12 && std::min(p.x(), q.x()) >= a && std::max(p.x(), q.x()) <= b)
    {
      mesh.flags.edit()[h] |= flags;
    }
  }
}

/// A roof with its ridge at y = 12, of angle 2 atan(slope).
double roof(double y, double slope)
{
  return -slope * std::abs(y - 12);
}

TEST(CreaseCurves, ABoxKeepsItsTwelveEdges)
{
  const int n = 12;
  Mesh mesh = test::unitCube(n);
  const CreaseReport report = judge(mesh, 2.0 / n);
  EXPECT_EQ(report.removedCurves, 0u);
  EXPECT_EQ(report.text(), "");
  // Three edges meet at right angles at a corner: none goes straight on.
  EXPECT_EQ(report.keptCurves, 12u);
  EXPECT_NEAR(report.keptLength, 12 * n / 2.0, 1e-9);
  EXPECT_EQ(featuresOf(mesh), static_cast<Index>(12 * n));
}

// Parts of the edge length, on each coordinate. With twice as much the edges are no straight lines to edgesOfFacets.
TEST(CreaseCurves, ABoxKeepsThemThroughNoise)
{
  const int n = 16;
  for (const double part : { 0.02, 0.05 })
  {
    for (const unsigned seed : { 1U, 2U, 3U })
    {
      Mesh mesh = noisy(test::unitCube(n), part / n, seed);
      const CreaseReport report = judge(mesh, 2.0 / n);
      EXPECT_EQ(report.keptCurves, 12u) << part << ' ' << seed;
      EXPECT_EQ(featuresOf(mesh), static_cast<Index>(12 * n)) << part << ' ' << seed;
    }
  }
}

TEST(CreaseCurves, NoisyAndFacettedBallsHaveNone)
{
  const Mesh ball = test::sphere(4); // edges of about 0.07
  for (const double deviation : { 0.01, 0.02 })
  {
    for (const unsigned seed : { 1U, 2U, 3U })
    {
      Mesh mesh = noisy(ball, deviation, seed);
      ASSERT_GT(
        featuresOf(test::markFeatures(mesh, kSharp)), 20u); // else there is nothing to judge
      judge(mesh, 0.15);
      EXPECT_EQ(featuresOf(mesh), 0u) << deviation << ' ' << seed;
    }
  }
  // An icosahedron has 30 edges of 41.8 degrees; quads larger than it do not see them.
  Mesh facets = test::sphere(0);
  judge(facets, 4);
  EXPECT_EQ(featuresOf(facets), 0u);
}

TEST(CreaseCurves, AFoldThatFadesOutStaysWhereItIsSharp)
{
  // Its angle falls from 90 degrees to 0 along x; it ends free where it is 40.
  const auto slope = [](double x) { return std::tan(test::kPi / 4 * (1 - x / 60)); };
  Mesh mesh = sheet(60, 24, [&](double x, double y) { return roof(y, slope(x)); });
  const CreaseReport report = judge(mesh, 2);
  EXPECT_EQ(report.removedCurves, 0u);
  EXPECT_EQ(report.keptCurves, 1u);
  const double end = 60 * (1 - 40.0 / 90);
  EXPECT_NEAR(2 * report.keptLength, end, 3); // the roof's sides are not quite flat
}

TEST(CreaseCurves, ARowOfSharpEdgesInARoughSurfaceIsNone)
{
  // Both ends are free. The same row is a crease where the surface beside it is smooth.
  for (const bool isRough : { false, true })
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-0.3, 0.3);
    Mesh mesh = sheet(40, 24,
      [&](double, double y) { return roof(y, 0.5) + (isRough && y != 12 ? noise(random) : 0.0); });
    markRidge(mesh, 10, 30);
    FeatureFilterReport filtered;
    const CreaseReport report = removeFalseCreases(mesh, 2, 1, filtered);
    EXPECT_EQ(report.removedCurves, isRough ? 1u : 0u);
    EXPECT_EQ(featuresOf(mesh), isRough ? 0u : 20u);
    if (isRough)
    {
      EXPECT_NEAR(report.removedLength, 10, 1e-9);
      EXPECT_NEAR(report.longest, 10, 1e-9);
      EXPECT_EQ(report.removedEdges, 20u);
      EXPECT_NEAR(report.place.x(), 20, 1);
      EXPECT_TRUE(test::contains(report.text(), "10 edge lengths")) << report.text();
    }
  }
}

TEST(CreaseCurves, SharpAcrossOneEdgeOnlyIsNone)
{
  // A step of a fifth of an edge length: 72 degrees down and the same up again, and the sheets beyond are level.
  const auto step = [](double, double y) { return y <= 12 ? 0.0 : 3.0; };
  Mesh mesh = sheet(60, 24, step);
  markRidge(mesh, 10, 50);
  Mesh fine = mesh;
  const std::vector<CreaseCurve> wide = traceCreases(mesh, 16, 1);
  ASSERT_EQ(wide.size(), 1u);
  EXPECT_EQ(wide[0].freeEnds, 2);
  EXPECT_LT(wide[0].wideAngle, 0.5 * wide[0].angle);
  EXPECT_FALSE(wide[0].isCrease());
  // Quads that can go down the step see its edge as one.
  const std::vector<CreaseCurve> narrow = traceCreases(fine, 1, 1);
  ASSERT_EQ(narrow.size(), 1u);
  EXPECT_TRUE(narrow[0].isCrease());
}

TEST(CreaseCurves, WhatWasAskedForStays)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  Mesh mesh =
    sheet(40, 24, [&](double, double y) { return roof(y, 0.5) + (y != 12 ? noise(random) : 0.0); });
  markRidge(mesh, 10, 30, kFeatureEdge | kRequestedFeature);
  EXPECT_TRUE(traceCreases(mesh, 2, 1).empty());
  FeatureFilterReport filtered;
  EXPECT_EQ(removeFalseCreases(mesh, 2, 1, filtered).removedCurves, 0u);
  EXPECT_EQ(featuresOf(mesh), 20u);
}

TEST(CreaseCurves, GoOnStraightThroughJunctions)
{
  // A row from side to side, and a column that ends at it: two curves, the column with no free end.
  Mesh mesh = sheet(40, 24, [](double, double y) { return roof(y, 1); });
  markRidge(mesh, 0, 40);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    if (p.x() == 20 && q.x() == 20 && std::min(p.y(), q.y()) >= 12)
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  std::vector<CreaseCurve> curves = traceCreases(mesh, 2, 1);
  ASSERT_EQ(curves.size(), 2u);
  std::sort(curves.begin(), curves.end(),
    [](const CreaseCurve& a, const CreaseCurve& b) { return a.length > b.length; });
  EXPECT_EQ(curves[0].halfEdges.size(), 40u);
  EXPECT_NEAR(curves[0].length, 20, 1e-9);
  EXPECT_EQ(curves[1].freeEnds, 0);
  for (std::size_t i = 0; i + 1 < curves[0].halfEdges.size(); ++i)
  {
    const Index a = curves[0].halfEdges[i], b = curves[0].halfEdges[i + 1];
    const Vector3 middles = 0.5 *
      (mesh.position[mesh.origin[b]] + mesh.position[mesh.target(b)] -
        mesh.position[mesh.origin[a]] - mesh.position[mesh.target(a)]);
    EXPECT_NEAR(middles.norm(), 1, 1e-9); // one after the other
  }
}

TEST(CreaseCurves, LengthsAreOverTheSizes)
{
  Mesh mesh = sheet(40, 24, [](double, double y) { return roof(y, 1); });
  markRidge(mesh, 10, 30);
  const Mesh half = test::withSizes(mesh, [](const Vector3&) { return 0.5; });
  EXPECT_NEAR(
    traceCreases(half, 2, 1).at(0).length, 2 * traceCreases(mesh, 2, 1).at(0).length, 1e-9);
  EXPECT_THROW(traceCreases(mesh, 0, 1), InvalidInput);
}

TEST(CreaseCurves, ThreadsDoNotMatter)
{
  const Mesh mesh = noisy(sheet(60, 24, [](double, double y) { return roof(y, 1); }), 0.12, 3);
  Mesh one = mesh, four = mesh;
  const CreaseReport first = judge(one, 3, 1);
  const CreaseReport second = judge(four, 3, 4);
  EXPECT_EQ(one.flags, four.flags);
  EXPECT_EQ(first.text(), second.text());
  EXPECT_EQ(first.keptLength, second.keptLength);
}

} // namespace
} // namespace quadrille
