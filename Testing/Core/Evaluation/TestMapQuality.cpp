// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "../TestMeshes.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Evaluation/MapQuality.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

using namespace quadrille;

namespace
{

/// Positions of a map are multiples of 2^-24; those below are multiples of 2^-6, so only rounding is left.
constexpr double kMapRounding = 1e-9;

/// (x, y) of the points times a matrix.
std::vector<FixedVec2> mappedBy(const Mesh& mesh, const Eigen::Matrix2d& m)
{
  std::vector<FixedVec2> uv;
  for (const Index p : mesh.origin)
  {
    uv.push_back(toFixed(Vector2(m * mesh.position[p].head<2>())));
  }
  return uv;
}

Eigen::Matrix2d matrix(double a, double b, double c, double d)
{
  Eigen::Matrix2d m;
  m << a, b, c, d;
  return m;
}

void expectEverywhere(const WeightedDistribution& d, double value)
{
  EXPECT_NEAR(d.minimum(), value, kMapRounding);
  EXPECT_NEAR(d.mean(), value, kMapRounding);
  EXPECT_NEAR(d.maximum(), value, kMapRounding);
}

} // namespace

TEST(MapQuality, OfQuadsOfTheSizeAskedForIsOne)
{
  const Mesh mesh = test::gridPlane(6, 4);
  for (const double s : { 0.25, 1.0, 4.0 })
  {
    const MapQuality q = measureMapQuality(mesh, mappedBy(mesh, matrix(1 / s, 0, 0, 1 / s)), s);
    expectEverywhere(q.sizing, 1);
    expectEverywhere(q.anisotropy, 1);
    expectEverywhere(q.shear, kPi / 2);
    EXPECT_EQ(q.inverted + q.degenerate, 0U);
    EXPECT_NEAR(q.sizing.total(), 24, kMapRounding);
  }
}

TEST(MapQuality, DoesNotSeeQuarterTurnsNorWhereTheSurfaceLies)
{
  Mesh mesh = test::gridPlane(3, 3);
  const std::vector<FixedVec2> uv = mappedBy(mesh, matrix(0, -1, 1, 0));
  const double angle = 0.7;
  for (Vector3& p : mesh.position.editAll())
  {
    p = Vector3(std::cos(angle) * p.x(), p.y(), std::sin(angle) * p.x()) + Vector3(5, -3, 2);
  }
  const MapQuality q = measureMapQuality(mesh, uv, 1);
  expectEverywhere(q.sizing, 1);
  expectEverywhere(q.anisotropy, 1);
  expectEverywhere(q.shear, kPi / 2);
}

TEST(MapQuality, OfAScalingIsItsDeterminant)
{
  const Mesh mesh = test::gridPlane(4, 4);
  const MapQuality q = measureMapQuality(mesh, mappedBy(mesh, matrix(0.5, 0, 0, 0.5)), 1);
  expectEverywhere(q.sizing, 4); // a quad covers 2 by 2
  expectEverywhere(q.anisotropy, 1);
}

TEST(MapQuality, OfAStretchIsItsRatio)
{
  const Mesh mesh = test::gridPlane(4, 4);
  const MapQuality q = measureMapQuality(mesh, mappedBy(mesh, matrix(4, 0, 0, 0.5)), 1);
  expectEverywhere(q.sizing, 0.5);
  expectEverywhere(q.anisotropy, 8);
  expectEverywhere(q.shear, kPi / 2); // isolines stay square to each other
}

TEST(MapQuality, OfAShearIsItsAngle)
{
  const Mesh mesh = test::gridPlane(4, 4);
  for (const double k : { -2.0, -0.5, 0.25, 1.0 })
  {
    // g = inverse: (u, v) to (u - k v, v): isolines along (1, 0) and (-k, 1).
    const MapQuality q = measureMapQuality(mesh, mappedBy(mesh, matrix(1, k, 0, 1)), 1);
    expectEverywhere(q.sizing, 1);
    expectEverywhere(q.shear, std::atan(1 / std::abs(k)));
    const double sum = 2 + k * k; // of the squared singular values, whose product is 1
    const double square = (sum + std::sqrt(sum * sum - 4)) / 2;
    expectEverywhere(q.anisotropy, square);
  }
}

TEST(MapQuality, WeighsByArea)
{
  const Mesh mesh = test::gridPlane(4, 1);
  std::vector<FixedVec2> uv = mappedBy(mesh, matrix(1, 0, 0, 1));
  for (Index h = 0; h < mesh.halfEdgeCount();
       ++h) // the last of four columns is twice as wide in the map
  {
    if (mesh.position[mesh.origin[h]].x() > 3.5)
    {
      uv[h] = toFixed(Vector2(5, mesh.position[mesh.origin[h]].y()));
    }
  }
  const MapQuality q = measureMapQuality(mesh, uv, 1);
  EXPECT_NEAR(q.sizing.mean(), (3 + 0.5) / 4, kMapRounding);
  EXPECT_NEAR(q.sizing.quantile(0.25), 0.5, kMapRounding);
  EXPECT_NEAR(q.anisotropy.mean(), (3 + 2.0) / 4, kMapRounding);
}

TEST(MapQuality, CountsInvertedAndDegenerateFaces)
{
  const Mesh mesh = test::gridPlane(2, 2);
  std::vector<FixedVec2> uv = mappedBy(mesh, matrix(1, 0, 0, 1));
  std::swap(uv[0], uv[1]);
  uv[4] = uv[3];
  const MapQuality q = measureMapQuality(mesh, uv, 1);
  EXPECT_EQ(q.inverted, 1U);
  EXPECT_EQ(q.degenerate, 1U);
  EXPECT_NEAR(q.faces[0].sizing, -1, kMapRounding);
  EXPECT_LT(q.faces[0].shear, 0);
  EXPECT_EQ(q.areas[1], 0);
  EXPECT_EQ(q.sizing.size(), 6U);
}

TEST(MapQuality, SizesAreTakenInto)
{
  const Mesh mesh = test::withSizes(test::gridPlane(4, 4), [](const Vector3&) { return 0.5; });
  const MapQuality q = measureMapQuality(mesh, mappedBy(mesh, matrix(2, 0, 0, 2)), 1);
  expectEverywhere(q.sizing, 1);
}

TEST(MapQuality, RefusesWhatDoesNotFit)
{
  const Mesh mesh = test::gridPlane(2, 2);
  EXPECT_THROW(measureMapQuality(mesh, {}, 1), InvalidInput);
  const std::vector<FixedVec2> uv = mappedBy(mesh, matrix(1, 0, 0, 1));
  EXPECT_THROW(measureMapQuality(mesh, uv, 0), InvalidInput);
  EXPECT_THROW(measureMapQuality(mesh, uv, std::nan("")), InvalidInput);
}

TEST(MapQuality, BinsAscend)
{
  for (const std::vector<double>& bins : { sizingBins(), anisotropyBins(), shearBins() })
  {
    ASSERT_GE(bins.size(), 2U);
    EXPECT_TRUE(std::is_sorted(bins.begin(), bins.end()));
  }
  EXPECT_NEAR(sizingBins().front(), 0.25, kMapRounding);
  EXPECT_NEAR(sizingBins().back(), 4, kMapRounding);
  EXPECT_NEAR(shearBins().back(), kPi / 2, kMapRounding);
}
