// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/Creases.h"

#include "Features/Features.h"
#include "Isosurface.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <random>

namespace quadrille
{
namespace
{

constexpr double kAngle = 40 * test::kPi / 180;

struct Counts
{
  Index sharp = 0;   ///< by the angle alone
  Index creases = 0; ///< that are left
};

Counts countEdges(const Mesh& mesh, int threads = 1)
{
  const Mesh sharp = test::markFeatures(mesh, kAngle);
  Mesh creases = mesh;
  markCreases(creases, kAngle, threads);
  return { test::featureHalfEdges(sharp) / 2, test::featureHalfEdges(creases) / 2 };
}

/// A prism over a closed polygon with these corners, whose lids are fans. twist: of its upper lid.
Mesh prism(const std::vector<Vector2>& polygon, double height, double twist = 0)
{
  std::vector<Vector3> points;
  std::vector<test::Triangle> triangles;
  const auto n = static_cast<Index>(polygon.size());
  for (Index i = 0; i < 2 * n; ++i)
  {
    const Vector2 p = Eigen::Rotation2Dd(i < n ? 0 : twist) * polygon[i % n];
    points.emplace_back(p.x(), p.y(), i < n ? 0.0 : height);
  }
  points.emplace_back(0, 0, 0);
  points.emplace_back(0, 0, height);
  for (Index i = 0; i < n; ++i)
  {
    const Index j = (i + 1) % n;
    triangles.insert(triangles.end(),
      { { i, j, n + j }, { i, n + j, n + i }, { 2 * n, j, i }, { 2 * n + 1, n + i, n + j } });
  }
  return test::makeMesh(std::move(points), triangles);
}

Mesh prism(int sides)
{
  std::vector<Vector2> polygon;
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2 * test::kPi * i / sides;
    polygon.emplace_back(std::cos(angle), std::sin(angle));
  }
  return prism(polygon, 1);
}

TEST(Creases, FacetsOfACoarseIsosurfaceAreNone)
{
  const Mesh mesh = test::isosurface(8, test::waves);
  const Counts counts = countEdges(mesh);
  ASSERT_GT(counts.sharp, 300u); // else the surface is not coarse
  EXPECT_LT(10 * counts.creases, counts.sharp);
}

TEST(Creases, SolidsKeepAllOfTheirEdges)
{
  for (const int sides : { 3, 4, 5, 6, 7, 8 })
  {
    const Counts counts = countEdges(prism(sides));
    EXPECT_EQ(counts.creases, static_cast<Index>(3 * sides)) << sides;
  }
  // The rims of a round solid stand out from its flat and its bent sides alike.
  for (const int sides : { 10, 12, 16, 40 })
  {
    EXPECT_EQ(countEdges(prism(sides)).creases, static_cast<Index>(2 * sides)) << sides;
  }
  EXPECT_EQ(countEdges(test::sphere(0)).creases, 30u);
  EXPECT_EQ(countEdges(test::unitCube(5)).creases, 60u);
  EXPECT_EQ(countEdges(test::doubleTorus(2)).creases, countEdges(test::doubleTorus(2)).sharp);
}

TEST(Creases, OnADesignedSurfaceEachEdgeAboveTheAngleIsOne)
{
  // Its sides turn by 47 and by 25 degrees in turn: the sharp ones do not stand out from the others.
  std::vector<Vector2> polygon;
  Vector2 corner(-0.5, -1.6);
  double way = 0;
  for (int i = 0; i < 10; ++i)
  {
    polygon.push_back(corner);
    corner += Vector2(std::cos(way), std::sin(way));
    way += (i % 2 == 0 ? 47 : 25) * test::kPi / 180;
  }
  const Mesh flat = prism(polygon, 1);
  const Counts counts = countEdges(flat);
  EXPECT_EQ(counts.sharp, 20U + 5U); // the rims, and every second side
  EXPECT_EQ(counts.creases, counts.sharp);
  Mesh creases = flat;
  EXPECT_TRUE(markCreases(creases, kAngle, 1).isDesigned);
  // Without planes but its small lids it may be a coarse sampling of a round body.
  const Mesh bent = prism(polygon, 20, 0.1);
  ASSERT_EQ(countEdges(bent).sharp, 20U + 5U);
  EXPECT_LT(countEdges(bent).creases, countEdges(bent).sharp);
  creases = bent;
  EXPECT_FALSE(markCreases(creases, kAngle, 1).isDesigned);
}

TEST(Creases, ARidgeThroughNoiseStays)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.8, 0.8);
  Mesh mesh = test::gridPlane(40, 24);
  Index ridge = 0;
  for (Vector3& p : mesh.position.editAll())
  {
    const bool onRidge = std::abs(p.y() - 12) < 1e-9;
    ridge += onRidge ? 1 : 0;
    p.z() = -2 * std::abs(p.y() - 12) + (onRidge ? 0.0 : noise(random));
  }
  Mesh creases = mesh;
  markCreases(creases, kAngle, 1);
  Index kept = 0, elsewhere = 0;
  for (Index h = 0; h < creases.halfEdgeCount(); ++h)
  {
    if (creases.isFeature(h))
    {
      const bool on = std::abs(creases.position[creases.origin[h]].y() - 12) < 1e-9 &&
        std::abs(creases.position[creases.target(h)].y() - 12) < 1e-9;
      ++(on ? kept : elsewhere);
    }
  }
  EXPECT_EQ(kept, 2 * (ridge - 1));
  EXPECT_GT(countEdges(mesh).sharp, ridge + 100); // the noise is sharp, too
  EXPECT_LT(elsewhere, 60u);
}

TEST(Creases, WhatWasAskedForStays)
{
  Mesh mesh = test::markFeatures(test::isosurface(6, test::waves), kAngle);
  for (std::uint8_t& flags : mesh.flags.editAll())
  {
    flags |= (flags & kFeatureEdge) != 0 ? kRequestedFeature : 0;
  }
  const Index before = test::featureHalfEdges(mesh);
  EXPECT_EQ(markCreases(mesh, kAngle, 1).edges, 0u);
  EXPECT_EQ(test::featureHalfEdges(mesh), before);
}

TEST(Creases, ThreadsDoNotMatter)
{
  const Mesh mesh = test::isosurface(9, test::waves);
  Mesh one = mesh, four = mesh;
  markCreases(one, kAngle, 1);
  markCreases(four, kAngle, 4);
  EXPECT_EQ(one.flags, four.flags);
}

TEST(Creases, TheUserIsTold)
{
  const PreparedSurface surface =
    test::prepare(test::toSoup(test::isosurface(6, test::waves)), kAngle);
  EXPECT_GT(surface.facets.edges, 0u);
  EXPECT_TRUE(test::contains(surface.facets.text(), "do not stand out")) << surface.facets.text();
  EXPECT_TRUE(test::contains(surface.facets.text(), "near (")) << surface.facets.text();
  EXPECT_EQ(test::prepare(test::toSoup(test::unitCube(4)), kAngle).facets.text(), "");
}

} // namespace
} // namespace quadrille
