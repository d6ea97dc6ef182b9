// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FeatureFilter.h"

#include "Base/Error.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

Index featureEdges(const Mesh& mesh)
{
  Index count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) && h < mesh.twin[h];
  }
  return count;
}

void mark(Mesh& mesh, Index h, std::uint8_t flags)
{
  mesh.flags.edit()[h] |= flags;
  mesh.flags.edit()[mesh.twin[h]] |= flags;
}

/// The horizontal edges of a grid plane in one inner row of vertices, from column a to column b.
void markRow(Mesh& mesh, int row, double a, double b, std::uint8_t flags)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    if (!mesh.isBoundary(h) && p.y() == row && q.y() == row && p.x() >= a && q.x() <= b &&
      q.x() > p.x())
    {
      mark(mesh, h, flags);
    }
  }
}

constexpr std::uint8_t kDetected = kFeatureEdge;

TEST(FeatureFilter, ShortDanglingChainGoesLongOneStays)
{
  Mesh mesh = test::gridPlane(20, 6);
  markRow(mesh, 2, 3, 6, kDetected);  // length 3
  markRow(mesh, 4, 3, 15, kDetected); // length 12
  const FeatureFilterReport report = removeUnresolvedFeatures(mesh, 1.0);
  EXPECT_EQ(report.removedEdges, 3u);
  EXPECT_EQ(report.keptEdges, 12u);
  EXPECT_EQ(featureEdges(mesh), 12u);
}

TEST(FeatureFilter, WhatTheUserAskedForStays)
{
  Mesh mesh = test::gridPlane(20, 6);
  markRow(mesh, 2, 3, 6, kFeatureEdge | kRequestedFeature);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 10.0).removedEdges, 0u);
  EXPECT_EQ(featureEdges(mesh), 3u);
}

TEST(FeatureFilter, ChainFromBoundaryToBoundaryNeedsLengthToo)
{
  Mesh mesh = test::gridPlane(3, 6);
  markRow(mesh, 2, 0, 3, kDetected);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 1.0).keptEdges, 0u);
  markRow(mesh, 2, 0, 3, kDetected);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 0.5).keptEdges, 3u);
}

TEST(FeatureFilter, LoopIsJudgedByItsBox)
{
  // The edges of one side of the cube form a loop without nodes, in a box with a diagonal of 1.41.
  const Mesh cube = test::unitCube(3);
  Mesh mesh = cube;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    const auto onRim = [](const Vector3& x)
    { return x.z() == 1 && (x.x() == 0 || x.x() == 1 || x.y() == 0 || x.y() == 1); };
    // On the rim, and along it: the edge keeps x or y.
    if (onRim(p) && onRim(q) && ((p.x() == q.x()) != (p.y() == q.y())) && (p - q).norm() < 0.4)
    {
      mark(mesh, h, kDetected);
    }
  }
  Mesh coarse = mesh;
  EXPECT_EQ(featureEdges(mesh), 12u);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 1.4).keptEdges, 12u);
  EXPECT_EQ(removeUnresolvedFeatures(coarse, 1.5).keptEdges, 0u);
}

TEST(FeatureFilter, GroupsOfShortChainsGoOnlyWhereTheyAreSmall)
{
  // A ladder of unit steps over `columns`: all of its chains are of length one, but the four at its ends.
  for (const auto& [columns, kept] : { std::pair(3, 0U), std::pair(12, 37U) })
  {
    Mesh mesh = test::gridPlane(20, 6);
    markRow(mesh, 2, 3, 3 + columns, kDetected);
    markRow(mesh, 3, 3, 3 + columns, kDetected);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& p = mesh.position[mesh.origin[h]];
      const Vector3& q = mesh.position[mesh.target(h)];
      if (p.x() == q.x() && p.y() == 2 && q.y() == 3 && p.x() >= 3 && p.x() <= 3 + columns)
      {
        mark(mesh, h, kDetected);
      }
    }
    EXPECT_EQ(removeUnresolvedFeatures(mesh, 4).keptEdges, kept);
  }
}

TEST(FeatureFilter, SharpCubeIsLeftAlone)
{
  Mesh mesh = test::markFeatures(test::unitCube(6), 0.5);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 0.9).removedEdges, 0u);
  EXPECT_EQ(featureEdges(mesh), 72u);
}

constexpr double kBand = 1.0 / 30;

/// A plane 40 by 40 with a band between the rows y = 20 and y = 20 + rows, where it bends by `first` and `second`
/// radians. Rows of the band are kBand wide.
Mesh bentBand(int rows, double first, double second, std::uint8_t secondFlags = kDetected)
{
  Mesh mesh = test::gridPlane(40, 40);
  markRow(mesh, 20, 0, 40, kDetected);
  markRow(mesh, 20 + rows, 0, 40, secondFlags);
  for (Vector3& p : mesh.position.editAll())
  {
    const double inBand = kBand * std::clamp(p.y() - 20, 0.0, double(rows));
    const double beyond = std::max(p.y() - 20 - rows, 0.0);
    p = Vector3(p.x(),
      std::min(p.y(), 20.0) + inBand * std::cos(first) + beyond * std::cos(first + second),
      inBand * std::sin(first) + beyond * std::sin(first + second));
  }
  return mesh;
}

/// Feature edges in row y = 20, which did not move.
Index edgesOfFirstRow(const Mesh& mesh)
{
  Index count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) && h < mesh.twin[h] && mesh.position[mesh.origin[h]].y() == 20 &&
      mesh.position[mesh.target(h)].y() == 20;
  }
  return count;
}

TEST(FeatureFilter, ThinBandKeepsItsSharperSide)
{
  // The mean width of the band is 1 / 30, which is 0.01 of 3.33.
  Mesh bluntFirst = bentBand(1, 0.8, 0.9);
  EXPECT_EQ(removeUnresolvedFeatures(bluntFirst, 3.4).removedEdges, 40u);
  EXPECT_EQ(edgesOfFirstRow(bluntFirst), 0u);
  Mesh sharpFirst = bentBand(1, 0.9, 0.8);
  EXPECT_EQ(removeUnresolvedFeatures(sharpFirst, 3.4).removedEdges, 40u);
  EXPECT_EQ(edgesOfFirstRow(sharpFirst), 40u);
}

TEST(FeatureFilter, BandThatQuadsResolveKeepsBothSides)
{
  Mesh mesh = bentBand(1, 0.8, 0.9);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 3.2).removedEdges, 0u);
  Mesh wide = bentBand(2, 0.8, 0.9);
  EXPECT_EQ(removeUnresolvedFeatures(wide, 3.4).removedEdges, 0u);
}

TEST(FeatureFilter, SideOfAThinBandThatWasAskedForStays)
{
  Mesh mesh = bentBand(1, 0.9, 0.8, kFeatureEdge | kRequestedFeature);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 3.4).removedEdges, 40u);
  EXPECT_EQ(edgesOfFirstRow(mesh), 0u); // though it is the sharper one
  Mesh both = bentBand(1, 0.9, 0.8, kFeatureEdge | kRequestedFeature);
  markRow(both, 20, 0, 40, kFeatureEdge | kRequestedFeature);
  EXPECT_EQ(removeUnresolvedFeatures(both, 3.4).removedEdges, 0u);
}

TEST(FeatureFilter, EndOfAThinBandIsNoSideOfIt)
{
  // A flat column of features at x = 30 ends the band. Without its edge there the band would be a bay of the wide patch
  // beyond, and as thin as before.
  Mesh mesh = bentBand(1, 0.8, 0.9);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    if (mesh.isFeature(h) && std::max(p.x(), q.x()) > 30)
    {
      unmarkFeatures(mesh, { h });
    }
    if (p.x() == 30 && q.x() == 30)
    {
      mark(mesh, h, kDetected);
    }
  }
  ASSERT_EQ(featureEdges(mesh), 100u);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 3.4).removedEdges, 30u);
  EXPECT_EQ(edgesOfFirstRow(mesh), 0u);
}

TEST(FeatureFilter, OfTwoThinBandsSideBySideTheMiddleCurveMayGo)
{
  // Bends of 0.8, 0.3 and 0.9 radians: without the middle one there is one band of two rows left, which is wide enough.
  Mesh mesh = test::gridPlane(40, 20);
  for (const int row : { 9, 10, 11 })
  {
    markRow(mesh, row, 0, 40, kDetected);
  }
  for (Vector3& p : mesh.position.editAll())
  {
    Vector3 bent(p.x(), std::min(p.y(), 9.0), 0);
    double angle = 0;
    for (const auto& [start, bend] :
      { std::pair(9.0, 0.8), std::pair(10.0, 0.3), std::pair(11.0, 0.9) })
    {
      angle += bend;
      const double length =
        (start < 11 ? kBand : 1) * std::clamp(p.y() - start, 0.0, start < 11 ? 1.0 : 20.0);
      bent += Vector3(0, length * std::cos(angle), length * std::sin(angle));
    }
    p = bent;
  }
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 3.4).removedEdges, 40u);
  EXPECT_EQ(featureEdges(mesh), 80u);
}

TEST(FeatureFilter, NearAPlaceOnlyDetectedFeaturesGo)
{
  Mesh mesh = test::gridPlane(20, 6);
  markRow(mesh, 2, 0, 20, kDetected);
  markRow(mesh, 4, 0, 20, kFeatureEdge | kRequestedFeature);
  // The row at y = 2 is 0.5 away; edges [7, 8] to [11, 12] come closer than 2.2 to (9.5, 2.5).
  const std::vector<Index> near = featuresNear(mesh, { Vector3(9.5, 2.5, 0) }, 2.2);
  EXPECT_EQ(near.size(), 5u);
  unmarkFeatures(mesh, near);
  EXPECT_EQ(featureEdges(mesh), 35u);
  EXPECT_TRUE(featuresNear(mesh, { Vector3(9.5, 2.5, 0) }, 2.2).empty());
  EXPECT_TRUE(featuresNear(mesh, {}, 100).empty());
  // Boundaries are no features.
  EXPECT_EQ(featuresNear(mesh, { Vector3(10, 3, 0) }, 100).size(), 15u);
  EXPECT_THROW(featuresNear(mesh, {}, 0), InvalidInput);
}

TEST(ClearFeatures, TakesTheCurveNearestToAPlaceAndNoOther)
{
  Mesh mesh = test::markFeatures(test::unitCube(6), 0.5);
  const Vector3 onEdge(0.5, 0, 1);
  const std::vector<ClearedFeature> cleared =
    clearFeatures(mesh, { onEdge + Vector3(0, 0.05, 0), { 0.5, 0.5, 1 } }, 0.1, 0.05);
  ASSERT_EQ(cleared.size(), 2u);
  EXPECT_NEAR(cleared[0].length, 1, 1e-12);
  EXPECT_NEAR(cleared[0].distance, 0.05, 1e-12);
  EXPECT_NEAR((cleared[0].nearest - onEdge).norm(), 0, 1e-12);
  EXPECT_EQ(cleared[1].length, 0);
  EXPECT_NEAR(cleared[1].distance, 0.5, 1e-12);
  EXPECT_EQ(featureEdges(mesh), 66u);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 middle = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
    EXPECT_FALSE(mesh.isFeature(h) && middle.y() == 0 && middle.z() == 1);
  }
}

TEST(ClearFeatures, TakesWholeLoops)
{
  Mesh mesh = test::openCylinder(24, 6);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const double z = mesh.position[mesh.origin[h]].z();
    if (!mesh.isBoundary(h) && std::abs(z - 1) < 1e-9 &&
      std::abs(mesh.position[mesh.target(h)].z() - 1) < 1e-9)
    {
      mark(mesh, h, kDetected);
    }
  }
  ASSERT_EQ(featureEdges(mesh), 24u);
  EXPECT_NEAR(clearFeatures(mesh, { { 1, 0, 1 } }, 0.5, 0.3).front().length, 2 * 3.14159265, 0.05);
  EXPECT_EQ(featureEdges(mesh), 0u);
}

TEST(ClearFeatures, TakesWhatWasAskedFor)
{
  Mesh mesh = test::gridPlane(12, 6);
  markRow(mesh, 2, 2, 9, kDetected | kRequestedFeature);
  EXPECT_EQ(clearFeatures(mesh, { { 5, 2, 0 } }, 0.5, 0.3).front().length, 7);
  EXPECT_EQ(featureEdges(mesh), 0u);
  EXPECT_FALSE(hasDetectedFeature(mesh));
  const ClearedFeature none = clearFeatures(mesh, { { 5, 2, 0 } }, 0.5, 0.3).front();
  EXPECT_EQ(none.length, 0);
  EXPECT_TRUE(std::isinf(none.distance));
}

TEST(ClearFeatures, TakesTheOtherSideOfAStep)
{
  const auto marked = []
  {
    Mesh mesh = test::gridPlane(24, 8);
    markRow(mesh, 3, 4, 16, kDetected);
    markRow(mesh, 4, 5, 15, kDetected); // beside it, a little shorter
    markRow(mesh, 5, 4, 20, kDetected); // beside the second one alone
    return mesh;
  };
  Mesh mesh = marked();
  EXPECT_EQ(clearFeatures(mesh, { { 9, 3, 0 } }, 0.5, 1.1).front().beside, 1u);
  EXPECT_EQ(featureEdges(mesh), 16u);
  mesh = marked();
  EXPECT_EQ(clearFeatures(mesh, { { 9, 3, 0 } }, 0.5, 0.9).front().beside, 0u);
  EXPECT_EQ(featureEdges(mesh), 26u);
  // A shorter one does not take longer ones with it.
  mesh = marked();
  EXPECT_EQ(clearFeatures(mesh, { { 9, 4, 0 } }, 0.5, 1.1).front().beside, 0u);
  EXPECT_EQ(featureEdges(mesh), 28u);
}

TEST(ClearFeatures, LeavesTheBoundary)
{
  Mesh mesh = test::gridPlane(6, 6);
  EXPECT_EQ(clearFeatures(mesh, { { 3, 0, 0 } }, 1, 0.3).front().length, 0);
}

TEST(FeatureFilter, NothingIsBelowZero)
{
  Mesh mesh = test::gridPlane(20, 6);
  markRow(mesh, 2, 3, 4, kDetected);
  EXPECT_EQ(removeUnresolvedFeatures(mesh, 0).keptEdges, 1u);
  EXPECT_THROW(removeUnresolvedFeatures(mesh, -1), InvalidInput);
}

TEST(FeatureFilter, ALargerDetailNeverBringsAFeatureBack)
{
  Mesh mesh = test::gridPlane(40, 12);
  markRow(mesh, 2, 3, 6, kDetected);
  markRow(mesh, 4, 3, 30, kDetected);
  markRow(mesh, 5, 0, 40, kDetected);
  markRow(mesh, 8, 0, 40, kDetected);
  std::size_t before = featureEdges(mesh);
  const std::size_t all = before;
  for (const double smallest : { 0.0, 0.5, 1.0, 5.0, 10.0, 80.0, 200.0, 400.0 })
  {
    Mesh one = mesh;
    const std::size_t kept = removeUnresolvedFeatures(one, smallest).keptEdges;
    EXPECT_LE(kept, before) << smallest;
    before = kept;
  }
  EXPECT_LT(before, all);
}

} // namespace
} // namespace quadrille
