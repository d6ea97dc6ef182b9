// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/GaussianCurvatureCost.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Arc tangents of the removal are exact to 3e-10, and a star has fewer than 40 of them.
constexpr double kAngles = 40 * 3e-10;
/// Defects are kept in single precision, and are at most 2 pi.
constexpr double kSingle = 1e-6;

RemovalGuards costGuards()
{
  RemovalGuards guards;
  guards.minimumQuality = 1e-3;
  guards.minimumNormalDot = -1;
  guards.minimumValence = 3;
  guards.maximumValence = kMaximumRing;
  guards.curveTolerance = 1e300;
  return guards;
}

/// Two rings of triangles in the plane, whose middle, vertex 0, is raised.
Mesh hexagonalCone(double height)
{
  std::vector<Vector3> points{ { 0, 0, height } };
  const auto direction = [](int i)
  { return Vector3(std::cos(i * test::kPi / 3), std::sin(i * test::kPi / 3), 0); };
  for (int i = 0; i < 6; ++i)
  {
    points.push_back(direction(i));
  }
  for (int i = 0; i < 6; ++i)
  {
    points.emplace_back(2 * direction(i));
    points.emplace_back(direction(i) + direction(i + 1));
  }
  std::vector<Triangle> triangles;
  for (Index i = 0; i < 6; ++i)
  {
    const Index inner = 1 + i, nextInner = 1 + (i + 1) % 6;
    const Index outer = 7 + 2 * i, middle = outer + 1, nextOuter = 7 + 2 * ((i + 1) % 6);
    triangles.push_back({ 0, inner, nextInner });
    triangles.push_back({ inner, outer, middle });
    triangles.push_back({ inner, middle, nextInner });
    triangles.push_back({ nextInner, middle, nextOuter });
  }
  return makeMesh(points, triangles);
}

double coneDefect(double height)
{
  return 2 * test::kPi - 12 * std::asin(0.5 / std::sqrt(1 + height * height));
}

/// Defects by the arc cosine of each angle, in double precision.
std::vector<double> slowDefects(const Mesh& mesh)
{
  std::vector<double> defect(mesh.position.size(), 2 * test::kPi);
  for (Index v = 0; v < mesh.position.size(); ++v)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.origin[h] != v)
      {
        continue;
      }
      const Vector3 a = mesh.position[mesh.target(h)] - mesh.position[v];
      const Vector3 b = mesh.position[mesh.origin[Mesh::previous(h)]] - mesh.position[v];
      defect[v] -= std::acos(a.dot(b) / (a.norm() * b.norm()));
    }
  }
  return defect;
}

/// E_G as the removal measures it; then the removal is carried out on `work`.
double removeAndMeasure(DecimationMesh& work, Index v)
{
  VertexRemoval removal(work);
  VertexRemoval::Change change;
  EXPECT_TRUE(removal.gather(v) && removal.plan(costGuards()));
  removal.measureChange(change);
  RecordWriter records;
  removal.apply(records);
  return gaussianCurvatureCost(change, removal.ringSize());
}

} // namespace

TEST(GaussianCurvatureCost, TheDefectOfAConeIsThatOfItsApex)
{
  for (const double height : { 0.0, 0.5, 3.0 })
  {
    const std::vector<float> defect = angleDefects(hexagonalCone(height));
    EXPECT_NEAR(defect[0], coneDefect(height), kSingle);
    for (Index v = 1; v <= 6; ++v)
    {
      EXPECT_NEAR(defect[v], -coneDefect(height) / 6, kSingle) << "the plane takes up the rest";
    }
    EXPECT_NEAR(defect[7], test::kPi / 3, kSingle) << "a corner of a hexagon";
    EXPECT_NEAR(defect[8], 0, kSingle) << "a straight boundary";
  }
}

TEST(GaussianCurvatureCost, TheCornersOfACubeHaveAllOfItsCurvature)
{
  const Mesh cube = unitCube(3);
  const std::vector<float> defect = angleDefects(cube);
  int corners = 0;
  for (Index v = 0; v < cube.vertexCount(); ++v)
  {
    const Vector3& p = cube.position[v];
    const bool corner = ((p.array() - p.array().round()).abs() < 1e-9).all();
    EXPECT_NEAR(defect[v], corner ? test::kPi / 2 : 0, kSingle);
    corners += corner ? 1 : 0;
  }
  EXPECT_EQ(corners, 8);
}

TEST(GaussianCurvatureCost, TheApexOfAConeCostsItsDefectTwice)
{
  for (const double height : { 0.0, 0.5, 1.0 })
  {
    const Mesh cone = hexagonalCone(height);
    DecimationMesh work(cone, traceFeatureCurves(cone, 0.01));
    EXPECT_NEAR(removeAndMeasure(work, 0), 2 * coneDefect(height), kAngles);
  }
}

TEST(GaussianCurvatureCost, AVertexOfASphereCostsWhatTheDirectSumSays)
{
  const Mesh ball = sphere(2);
  const std::vector<double> before = slowDefects(ball);
  for (const Index v : { Index{ 0 }, Index{ 17 }, Index{ 50 }, Index{ 101 } })
  {
    DecimationMesh work(ball, traceFeatureCurves(ball, 0.01));
    const double cost = removeAndMeasure(work, v);
    const Level level = work.extract();
    const std::vector<double> after = slowDefects(level.mesh);
    double direct = std::abs(before[v]);
    for (Index i = 0; i < level.fineVertex.size(); ++i)
    {
      direct += std::abs(after[i] - before[level.fineVertex[i]]);
    }
    // Rounding of the arc cosine of each of the mesh's angles adds to that of the removal.
    EXPECT_NEAR(cost, direct, kAngles + 1e-15 * 3 * ball.faceCount() * 10);
    EXPECT_GE(cost, 2 * std::abs(before[v]) - kAngles) << "curvature moves, and does not vanish";
  }
}

TEST(GaussianCurvatureCost, AStraightFeatureIsNoCurvature)
{
  const Mesh cube = markFeatures(unitCube(4), test::kPi / 4);
  const auto found = std::find_if(cube.position.begin(), cube.position.end(),
    [](const Vector3& p) { return (p - Vector3(0.5, 0, 0)).norm() < 1e-9; });
  ASSERT_NE(found, cube.position.end());
  DecimationMesh work(cube, traceFeatureCurves(cube, 0.01));
  EXPECT_NEAR(
    removeAndMeasure(work, static_cast<Index>(found - cube.position.begin())), 0, kAngles);
}
