// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/CellFaces.h"

#include "TestMeshes.h"

#include <gtest/gtest.h>

namespace quadrille
{
namespace
{

Mesh voxelBall(int radius)
{
  const auto offCentre = [radius](int i) { return i + 0.5 - radius; };
  return test::voxelSurface({ 2 * radius, 2 * radius, 2 * radius }, 1,
    [=](int i, int j, int k)
    {
      const Vector3 place(offCentre(i), offCentre(j), offCentre(k));
      return place.norm() < radius - 0.1;
    });
}

TEST(CellFaces, VoxelsAreCellsInWhateverDirectionTheyLie)
{
  Mesh ball = voxelBall(8);
  EXPECT_TRUE(isMadeOfCells(ball));
  const Eigen::AngleAxisd rotation(0.7, Vector3(1, 2, 3).normalized());
  for (Vector3& p : ball.position.editAll())
  {
    // Slices of a scanner are farther from each other than its pixels; files are in single precision.
    p = (rotation * Vector3(0.3 * p.x(), 0.3 * p.y(), 1.5 * p.z()) + Vector3(40, 50, 60))
          .cast<float>()
          .cast<double>();
  }
  EXPECT_TRUE(isMadeOfCells(ball));
}

TEST(CellFaces, OtherSurfacesAreNone)
{
  EXPECT_FALSE(isMadeOfCells(test::sphere(4)));
  EXPECT_FALSE(isMadeOfCells(test::torus(40, 20)));
  EXPECT_FALSE(isMadeOfCells(test::openCylinder(64, 30)));
  // A designed body of few planes: each vector is that of a few edges.
  EXPECT_FALSE(isMadeOfCells(test::unitCube(1)));
  EXPECT_FALSE(isMadeOfCells(test::squareTorus(1)));
  EXPECT_FALSE(isMadeOfCells(Mesh{}));
}

} // namespace
} // namespace quadrille
