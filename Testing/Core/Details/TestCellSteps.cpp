// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/CellSteps.h"

#include "Base/Angles.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille
{
namespace
{

/// Voxels of unit size in a box of that many, those with the middle where `inside` says so.
template <typename Inside>
Mesh voxels(int x, int y, int z, Inside inside)
{
  return test::markFeatures(
    test::voxelSurface({ x, y, z }, 1,
      [&](int i, int j, int k) { return inside(Vector3(i + 0.5, j + 0.5, k + 0.5)); }),
    radians(40));
}

Mesh ball()
{
  return voxels(
    20, 20, 20, [](const Vector3& p) { return (p - Vector3(10, 10, 10)).norm() < 9.9; });
}

Mesh cylinder()
{
  return voxels(
    20, 20, 30, [](const Vector3& p) { return (p - Vector3(10, 10, p.z())).norm() < 9.9; });
}

std::size_t featureCount(const Mesh& mesh)
{
  return static_cast<std::size_t>(std::count_if(mesh.flags.begin(), mesh.flags.end(),
           [](std::uint8_t flags) { return (flags & kFeatureEdge) != 0; })) /
    2;
}

TEST(CellSteps, EdgesOfABallAreStepsOfOneCell)
{
  const Mesh mesh = ball();
  EXPECT_TRUE(stepsBelow(mesh, 0.9).empty());
  const std::vector<Index> steps = stepsBelow(mesh, 1.1);
  // Where a step is two cells high and two wide its edges are none.
  EXPECT_GT(static_cast<double>(steps.size()), 0.9 * static_cast<double>(featureCount(mesh)));
  EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
}

TEST(CellSteps, RimsOfACylinderAreNone)
{
  const Mesh mesh = cylinder();
  const std::vector<Index> steps = stepsBelow(mesh, 1.5);
  EXPECT_FALSE(steps.empty());
  for (const Index h : steps)
  {
    const double z = mesh.position[mesh.origin[h]].z();
    EXPECT_TRUE((z > 0 && z < 30) || mesh.edgeVector(h).z() != 0);
  }
}

TEST(CellSteps, BlocksHaveNone)
{
  EXPECT_TRUE(stepsBelow(voxels(12, 8, 6, [](const Vector3&) { return true; }), 3).empty());
  // One groove of a cell: most of the edges are others.
  EXPECT_TRUE(stepsBelow(
    voxels(12, 8, 6, [](const Vector3& p) { return p.z() < 5 || p.x() < 5 || p.x() > 6; }), 3)
                .empty());
}

TEST(CellSteps, WhatWasAskedForIsNoStep)
{
  Mesh mesh = ball();
  for (std::uint8_t& flags : mesh.flags.editAll())
  {
    flags |= (flags & kFeatureEdge) != 0 ? kRequestedFeature : 0;
  }
  EXPECT_TRUE(stepsBelow(mesh, 2).empty());
}

} // namespace
} // namespace quadrille
