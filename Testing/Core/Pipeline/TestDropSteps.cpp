// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces of voxels, as a threshold on a volume leaves them.
#include "Pipeline/Pipeline.h"

#include "Base/Angles.h"
#include "MeshInput.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include "Quads/QuadShape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

namespace quadrille
{
namespace
{

constexpr int kRadius = 12;

Mesh voxelBall()
{
  return test::voxelSurface({ 2 * kRadius, 2 * kRadius, 2 * kRadius }, 1,
    [](int i, int j, int k)
    {
      const Vector3 middle(kRadius, kRadius, kRadius);
      return (Vector3(i + 0.5, j + 0.5, k + 0.5) - middle).norm() < kRadius - 0.1;
    });
}

RemeshResult remeshVoxels(const Mesh& voxels, double edgeLength)
{
  RemeshOptions options;
  options.edgeLength = edgeLength;
  options.featureAngle = radians(40);
  options.threads = 1;
  return remesh(test::toInput(voxels), options);
}

double meanScaledJacobian(const QuadMesh& mesh)
{
  double sum = 0;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    sum += scaledJacobian(
      { mesh.points[quad[0]], mesh.points[quad[1]], mesh.points[quad[2]], mesh.points[quad[3]] });
  }
  return sum / static_cast<double>(mesh.quads.size());
}

bool tellsOfSteps(const RemeshResult& result)
{
  return std::any_of(result.notices.begin(), result.notices.end(),
    [](const std::string& text) { return test::contains(text, "steps between the cells"); });
}

TEST(DropSteps, QuadsLargerThanCellsAreThoseOfTheShape)
{
  const RemeshResult result = remeshVoxels(voxelBall(), 3);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(tellsOfSteps(result));
  EXPECT_EQ(test::featureHalfEdges(result.surface.mesh), 0U);
  EXPECT_FALSE(result.givenUpFeatures.empty());
  EXPECT_EQ(result.attempts.size(), 1U);
  // The area of the voxels' sides is one and a half times that of the ball.
  const auto made = static_cast<double>(result.quads.quads.size());
  EXPECT_NEAR(made, test::area(result.surface.mesh) / 9, 0.15 * made);
  EXPECT_GT(meanScaledJacobian(result.quads), 0.93);
}

TEST(DropSteps, RimsThatGoByStepsAreGoneWithThem)
{
  const Mesh cylinder = test::voxelSurface({ 24, 24, 30 }, 1,
    [](int i, int j, int) { return Vector3(i - 11.5, j - 11.5, 0).norm() < 11.9; });
  EXPECT_EQ(test::featureHalfEdges(remeshVoxels(cylinder, 3).surface.mesh), 0U);
}

TEST(DropSteps, BlocksKeepTheirEdges)
{
  // Closed by twelve edges of 10 cells each.
  const RemeshResult result = remeshVoxels(test::unitCube(10), 0.2);
  EXPECT_FALSE(tellsOfSteps(result));
  EXPECT_GE(test::featureHalfEdges(result.surface.mesh), 240U);
}

TEST(DropSteps, SmallerOnesFollowThem)
{
  const RemeshResult result = remeshVoxels(voxelBall(), 0.9);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(tellsOfSteps(result));
  EXPECT_GT(test::featureHalfEdges(result.surface.mesh), 0U);
}

} // namespace
} // namespace quadrille
