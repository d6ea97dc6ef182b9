// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/Sizing.h"
#include "TestMaps.h"
#include "Transfer/SurfaceStretch.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

std::vector<Eigen::Matrix2d> stretchOf(const Hierarchy& h)
{
  return measureStretch(h.intermediate, h.coarse, h.log);
}

/// Of the coarse level in the metric.
double stretchedArea(const Mesh& coarse, const std::vector<Eigen::Matrix2d>& stretch)
{
  double area = 0;
  for (Index f = 0; f < coarse.faceCount(); ++f)
  {
    area += stretch[f].determinant() * sizedArea(coarse, f);
  }
  return area;
}

/// Columns p1 - p0, p2 - p0 of a face in a plane whose first axis is half-edge 3f.
Eigen::Matrix2d shapeOf(const Mesh& mesh, Index f)
{
  const Vector3 a = mesh.edgeVector(3 * f);
  const Vector3 b = -mesh.edgeVector(3 * f + 2);
  Eigen::Matrix2d shape;
  shape << a.norm(), a.dot(b) / a.norm(), 0, a.cross(b).norm() / a.norm();
  return shape;
}

} // namespace

TEST(SurfaceStretch, OfAPlaneIsNone)
{
  for (const Mesh& mesh : { gridPlane(40, 30), plateWithHole(12), plateL(20) })
  {
    const Hierarchy h = decimate(mesh, 4, 30);
    ASSERT_LT(h.coarse.mesh.faceCount(), h.intermediate.mesh.faceCount() / 3);
    const std::vector<Eigen::Matrix2d> result = stretchOf(h);
    ASSERT_EQ(result.size(), h.coarse.mesh.faceCount());
    for (const Eigen::Matrix2d& stretch : result)
    {
      EXPECT_LT((stretch - Eigen::Matrix2d::Identity()).norm(), 1e-6);
    }
  }
}

TEST(SurfaceStretch, OfWavesIsTheirLengthOverThatOfTheChord)
{
  // A corrugated sheet can be unrolled, so what a coarse triangle stands for is the triangle of its unrolled corners.
  constexpr int kColumns = 240;
  constexpr int kRows = 80;
  std::vector<double> unrolled(1, 0.0);
  const auto height = [](double x) { return 2.4 * std::sin(2 * kPi * x / 12); };
  for (int i = 1; i <= kColumns; ++i)
  {
    unrolled.push_back(unrolled.back() + std::hypot(0.5, height(0.5 * i) - height(0.5 * (i - 1))));
  }
  Mesh mesh = gridPlane(kColumns, kRows);
  for (Vector3& p : mesh.position.editAll())
  {
    p = Vector3(0.5 * p.x(), 0.5 * p.y(), height(0.5 * p.x()));
  }
  const Hierarchy h = decimate(mesh, 2, 150);
  const std::vector<Eigen::Matrix2d> result = stretchOf(h);
  const Mesh& coarse = h.coarse.mesh;
  double total = 0;
  double wanted = 0;
  double along = 0;
  double across = 0;
  double difference = 0;
  double withoutIt = 0;
  for (Index f = 0; f < coarse.faceCount(); ++f)
  {
    const auto flat = [&](Index h0)
    {
      const Vector3& p = coarse.position[coarse.origin[h0]];
      return Vector2(unrolled[static_cast<std::size_t>(std::lround(2 * p.x()))], p.y());
    };
    Eigen::Matrix2d surface;
    surface << flat(3 * f + 1) - flat(3 * f), flat(3 * f + 2) - flat(3 * f);
    const Eigen::Matrix2d jacobian = surface * shapeOf(coarse, f).inverse();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> expected;
    expected.computeDirect(jacobian.transpose() * jacobian);
    const double area = sizedArea(coarse, f);
    // Along the directions in which it should stretch most and least.
    const Vector2 most = expected.eigenvectors().col(1);
    const Vector2 least = expected.eigenvectors().col(0);
    total += area;
    wanted += area * std::sqrt(expected.eigenvalues()[1]);
    along += area * (result[f] * most).norm();
    across += area * ((result[f] * least).norm() - std::sqrt(expected.eigenvalues()[0]));
    difference += area * (result[f] - expected.operatorSqrt()).norm();
    withoutIt += area * (Eigen::Matrix2d::Identity() - expected.operatorSqrt()).norm();
  }
  ASSERT_GT(wanted, 1.1 * total) << "the coarse level follows the waves: there is nothing to see";
  EXPECT_NEAR(along, wanted, 0.03 * total);
  EXPECT_NEAR(across, 0, 0.03 * total);
  EXPECT_LT(difference, 0.6 * withoutIt);
}

TEST(GatherGuides, OfOneDirectionInAPlaneIsThatDirection)
{
  Hierarchy h = decimate(gridPlane(40, 30), 4, 30);
  const Vector3 direction = Vector3(1, 0.4, 0).normalized();
  h.intermediate.guides.assign(h.intermediate.mesh.faceCount(), Guide{ direction, 0.5F });
  const std::vector<Guide> guides = gatherGuides(h.intermediate, h.coarse, h.log);
  ASSERT_EQ(guides.size(), h.coarse.mesh.faceCount());
  for (std::size_t f = 0; f < guides.size(); ++f)
  {
    // The four directions of a cross are one; weights of the log have 32 bits.
    const double angle =
      std::atan2(guides[f].direction.cross(direction).z(), guides[f].direction.dot(direction));
    EXPECT_NEAR(std::sin(4 * angle), 0, 1e-6);
    EXPECT_GT(std::cos(4 * angle), 0);
    EXPECT_NEAR(guides[f].weight, 0.5F, 1e-5);
  }
}

TEST(GatherGuides, ThereAreNoneWithoutGuides)
{
  const Hierarchy h = decimate(gridPlane(20, 20), 4, 30);
  EXPECT_TRUE(gatherGuides(h.intermediate, h.coarse, h.log).empty());
}

/// A stroke through large triangles has the share of each that it covers, so what it weighs in all is its own area.
TEST(GatherGuides, WeighAsMuchAsTheAreaThatTheyCover)
{
  Hierarchy h = decimate(gridPlane(80, 60), 4, 40);
  const Mesh& level = h.intermediate.mesh;
  h.intermediate.guides.assign(level.faceCount(), Guide{});
  double area = 0;
  for (Index f = 0; f < level.faceCount(); ++f)
  {
    if (std::abs(level.middleOfFace(f).y() - 30) < 3)
    {
      h.intermediate.guides[f] = { Vector3::UnitX(), 1 };
      area += level.faceArea(f);
    }
  }
  const std::vector<Guide> guides = gatherGuides(h.intermediate, h.coarse, h.log);
  double weighed = 0;
  int partly = 0;
  for (Index f = 0; f < guides.size(); ++f)
  {
    weighed += guides[f].weight * h.coarse.mesh.faceArea(f);
    partly += guides[f].weight > 0.05F && guides[f].weight < 0.6F ? 1 : 0;
  }
  EXPECT_NEAR(weighed, area, 1e-3 * area);
  EXPECT_GT(partly, 10);
}

TEST(GatherGuides, FollowCurvedSurfaces)
{
  const Mesh mesh = openCylinder(120, 60, 10, 30);
  const auto helix = [](const Vector3& p)
  { return Vector3(Vector3(-p.y(), p.x(), 0).normalized() + 0.5 * Vector3::UnitZ()); };
  Hierarchy h = decimate(mesh, 1.5, 120);
  const Mesh& level = h.intermediate.mesh;
  h.intermediate.guides.assign(level.faceCount(), Guide{});
  for (Index f = 0; f < level.faceCount(); ++f)
  {
    const Vector3 normal = level.doubleAreaNormal(f).normalized();
    const Vector3 along = helix(level.middleOfFace(f));
    h.intermediate.guides[f] = { (along - normal * normal.dot(along)).normalized(), 1 };
  }
  const std::vector<Guide> guides = gatherGuides(h.intermediate, h.coarse, h.log);
  const Mesh& coarse = h.coarse.mesh;
  ASSERT_LT(coarse.vertexCount(), 200u);
  double area = 0, sum = 0, worst = 0;
  for (Index f = 0; f < coarse.faceCount(); ++f)
  {
    const Vector3 normal = coarse.doubleAreaNormal(f).normalized();
    EXPECT_NEAR(guides[f].direction.dot(normal), 0, 1e-9);
    EXPECT_NEAR(guides[f].direction.norm(), 1, 1e-9);
    const Vector3 wanted = helix(coarse.middleOfFace(f));
    const double turn =
      std::atan2(guides[f].direction.cross(wanted).dot(normal), guides[f].direction.dot(wanted));
    const double angle = std::abs(turn - kPi / 2 * std::round(turn / (kPi / 2)));
    area += coarse.faceArea(f);
    sum += coarse.faceArea(f) * angle;
    worst = std::max(worst, angle);
  }
  // A coarse triangle spans some 30 degrees of the cylinder; planes cannot do better than a few.
  EXPECT_LT(sum / area, 3 * kPi / 180);
  EXPECT_LT(worst, 15 * kPi / 180);
}

TEST(SurfaceStretch, KeepsTheAreaOfTheSurface)
{
  for (const Mesh& mesh : { sphere(5), torus(90, 45), markFeatures(unitCube(24), 0.6),
         openCylinder(80, 50), twoComponents() })
  {
    const double area = sizedArea(mesh);
    const Hierarchy h = decimate(mesh, 0.1, 60);
    const std::vector<Eigen::Matrix2d> result = stretchOf(h);
    EXPECT_NEAR(stretchedArea(h.coarse.mesh, result), sizedArea(h.intermediate.mesh), 1e-6 * area);
    EXPECT_NEAR(stretchedArea(h.coarse.mesh, result), area, 0.01 * area);
  }
}

TEST(SurfaceStretch, IsSymmetricAndPositive)
{
  const std::vector<Eigen::Matrix2d> result = stretchOf(decimate(torus(90, 45), 0.1, 40));
  for (const Eigen::Matrix2d& stretch : result)
  {
    EXPECT_NEAR(stretch(0, 1), stretch(1, 0), 1e-12);
    EXPECT_GT(stretch.trace(), 0);
    EXPECT_GT(stretch.determinant(), 0); // with the trace: both eigenvalues
  }
}

TEST(SurfaceStretch, IsTheSameForAnyNumberOfThreads)
{
  const Mesh mesh = torus(90, 45);
  const std::vector<Eigen::Matrix2d> one = stretchOf(decimate(mesh, 0.1, 60, 1));
  for (const int threads : { 2, 4 })
  {
    EXPECT_TRUE(stretchOf(decimate(mesh, 0.1, 60, threads)) == one);
  }
}

TEST(SurfaceStretch, RefusesLevelsOfAnotherSurface)
{
  const Hierarchy h = decimate(torus(90, 45), 0.1, 60);
  const Hierarchy other = decimate(torus(30, 15), 0.3, 60);
  EXPECT_THROW(measureStretch(h.intermediate, h.coarse, other.log), InvalidInput);
  EXPECT_THROW(measureStretch(other.intermediate, h.coarse, h.log), InvalidInput);
}
