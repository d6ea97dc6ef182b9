// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/SharpCorners.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// A plate with a straight curve in y = 10, from which another one goes off at x = 10 by `degrees`, to the boundary at
/// x = 40. Above the curves the plate is bent by a fold along y = 10, so that the straight curve is the sharper one, or
/// the blunter one.
struct Fork
{
  Mesh mesh;
  std::size_t straight = 0, aslant = 0; ///< feature edges
};

bool isAslant(const Vector3& grid)
{
  return grid.y() == 11 && grid.x() >= 11;
}

Fork fork(double degrees, bool straightIsSharper, std::uint8_t flags = kFeatureEdge)
{
  Fork made{ test::gridPlane(40, 20) };
  Mesh& mesh = made.mesh;
  const Mesh grid = mesh;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    Vector3& p = mesh.position.edit()[v];
    const double above = std::max(p.y() - 10, 0.0);
    if (isAslant(p))
    {
      p.y() = 10 + (p.x() - 10) * std::tan(radians(degrees));
    }
    // Where the plate goes up: at the straight curve, or only beyond the one aslant.
    p.z() = straightIsSharper ? p.y() - 10 : above > 1 ? above : 0;
    p.z() = std::max(p.z(), 0.0);
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& a = grid.position[mesh.origin[h]];
    const Vector3& b = grid.position[mesh.target(h)];
    const bool isNode = a.x() == 10 && a.y() == 10;
    const bool isStraight = a.y() == 10 && b.y() == 10;
    const bool isOther = (isAslant(a) && isAslant(b)) || (isNode && b.x() == 11 && b.y() == 11);
    if (!mesh.isBoundary(h) && b.x() > a.x() && (isStraight || isOther))
    {
      mesh.flags.edit()[h] |= flags;
      mesh.flags.edit()[mesh.twin[h]] |= flags;
      ++(isStraight ? made.straight : made.aslant);
    }
  }
  return made;
}

std::size_t featureEdges(const Mesh& mesh)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) && h < mesh.twin[h];
  }
  return count;
}

TEST(SharpCorners, BlunterCurveBeginsWhereItIsAway)
{
  // The fold lifts it as far as it is away in the plane: by the root of 2 times the tangent of 5 degrees an edge, so it is
  // 0.12 s = 0.6 away after 4.9 edges.
  Fork made = fork(5, true);
  ASSERT_EQ(made.straight, 40U);
  ASSERT_EQ(made.aslant, 30U);
  const SharpCornerReport report = trimSharpCorners(made.mesh, 5);
  EXPECT_EQ(report.corners, 1U);
  EXPECT_EQ(report.removedEdges, 5U);
  EXPECT_NEAR(report.removedLength, std::sqrt(1 + 2 * std::pow(std::tan(radians(5)), 2)), 1e-4);
  EXPECT_EQ(report.place, Vector3(10, 10, 0));
  EXPECT_NE(report.text().find("at 1 place"), std::string::npos) << report.text();
  EXPECT_EQ(featureEdges(made.mesh), 65U);
  EXPECT_EQ(trimSharpCorners(made.mesh, 5).removedEdges, 0U);
}

TEST(SharpCorners, SharperCurveStaysWhole)
{
  Fork made = fork(5, false);
  EXPECT_EQ(trimSharpCorners(made.mesh, 5).removedEdges, 7U);
  std::size_t aslant = 0;
  for (Index h = 0; h < made.mesh.halfEdgeCount(); ++h)
  {
    const Vector3 middle = made.mesh.position[made.mesh.origin[h]] + made.mesh.edgeVector(h) / 2;
    aslant += made.mesh.isFeature(h) && h < made.mesh.twin[h] && middle.y() > 10;
  }
  EXPECT_EQ(aslant, 30U);
}

TEST(SharpCorners, CornersThatQuadsHaveStay)
{
  Fork made = fork(11, true);
  const SharpCornerReport report = trimSharpCorners(made.mesh, 5);
  EXPECT_EQ(report.removedEdges, 0U);
  EXPECT_EQ(report.text(), "");
}

TEST(SharpCorners, WhatTheUserAskedForStays)
{
  Fork made = fork(5, true, kFeatureEdge | kRequestedFeature);
  EXPECT_EQ(trimSharpCorners(made.mesh, 5).removedEdges, 0U);
}

TEST(SharpCorners, SizesCount)
{
  // Quads of half the size: 0.3 is reached after 2.4.
  Fork made = fork(5, true);
  made.mesh = test::withSizes(std::move(made.mesh), [](const Vector3&) { return 0.5; });
  EXPECT_EQ(trimSharpCorners(made.mesh, 5).removedEdges, 3U);
}

TEST(SharpCorners, EdgeLengthMustBePositive)
{
  Mesh mesh = test::gridPlane(2, 2);
  EXPECT_THROW(trimSharpCorners(mesh, 0), InvalidInput);
}

} // namespace
} // namespace quadrille
