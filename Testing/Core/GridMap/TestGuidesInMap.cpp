// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Positions as coordinates, but for a shear: isolines of v run along x, those of u lean over.
std::vector<FixedVec2> shearedUv(const Mesh& mesh, double shear)
{
  std::vector<FixedVec2> uv;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    uv.push_back(toFixed(Vector2(p.x() + shear * p.y(), p.y())));
  }
  return uv;
}

std::vector<Guide> guidesInColumns(const Mesh& mesh, const Vector3& direction)
{
  std::vector<Guide> guides(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const double x = mesh.position[mesh.origin[3 * f]].x();
    if (x < 2 || x > 7)
    {
      guides[f] = { direction, 1 };
    }
  }
  return guides;
}

TEST(GuidesInMap, RegionsAreCountedOneByOne)
{
  const Mesh mesh = gridPlane(10, 4);
  const Vector3 slanted(std::cos(0.3), std::sin(0.3), 0);
  EXPECT_EQ(unfollowedRegions(mesh, {}, shearedUv(mesh, 0)), 0U);
  EXPECT_EQ(unfollowedRegions(mesh, guidesInColumns(mesh, { 1, 0, 0 }), shearedUv(mesh, 0)), 0U);
  EXPECT_EQ(unfollowedRegions(mesh, guidesInColumns(mesh, slanted), shearedUv(mesh, 0)), 2U);
}

TEST(GuidesInMap, TheNearerFamilyOfIsolinesCounts)
{
  const Mesh mesh = gridPlane(10, 4);
  // Isolines of u are those of x = -shear y.
  const Vector3 across = Vector3(-0.5, 1, 0).normalized();
  EXPECT_EQ(unfollowedRegions(mesh, guidesInColumns(mesh, across), shearedUv(mesh, 0.5)), 0U);
  EXPECT_EQ(unfollowedRegions(mesh, guidesInColumns(mesh, { 0, 1, 0 }), shearedUv(mesh, 0.5)), 2U);
  EXPECT_EQ(unfollowedRegions(mesh, guidesInColumns(mesh, { 1, 0, 0 }), shearedUv(mesh, 0.5)), 0U);
}

} // namespace
} // namespace quadrille
