// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/GivenUpFeatures.h"

#include "Base/Error.h"
#include "Features/FeatureFilter.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace quadrille
{
namespace
{

using EdgeTest = std::function<bool(const Vector3&, const Vector3&)>;

/// Marks inner edges for which `test` holds in one of their directions.
void markEdges(Mesh& mesh, const EdgeTest& test)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!mesh.isBoundary(h) && test(mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
      mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
    }
  }
}

/// Unit edges on the segment from (x0, y0) to (x1, y1), along an axis.
EdgeTest onSegment(double x0, double y0, double x1, double y1)
{
  return [=](const Vector3& p, const Vector3& q)
  {
    const auto within = [](double v, double a, double b) { return v >= a && v <= b; };
    return std::abs((q - p).norm() - 1) < 1e-12 && within(p.x(), x0, x1) && within(q.x(), x0, x1) &&
      within(p.y(), y0, y1) && within(q.y(), y0, y1);
  };
}

std::size_t featureEdges(const Mesh& mesh)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h];
  }
  return count;
}

TEST(GivenUpCurves, TheyAddUpToWhatWasLost)
{
  // Any marks: what is told and what is left is what there was, edge by edge.
  std::mt19937 random(7);
  for (int round = 0; round < 5; ++round)
  {
    Mesh mesh = test::gridPlane(30, 30);
    markEdges(mesh,
      [&](const Vector3& p, const Vector3& q)
      { return std::abs((q - p).norm() - 1) < 1e-12 && random() % 5 == 0; });
    const std::size_t before = featureEdges(mesh);
    const std::vector<std::uint8_t> flags = mesh.flags;
    removeUnresolvedFeatures(mesh, 3);
    double length = 0, inQuads = 0;
    std::size_t edges = 0;
    for (const GivenUpCurve& curve :
      givenUpCurves(mesh, lostFeatures(mesh, flags), 3, FeatureLoss::Unresolved))
    {
      EXPECT_EQ(curve.reason, FeatureLoss::Unresolved);
      length += curve.length;
      inQuads += curve.lengthInQuads;
      edges += curve.edges;
      // In the middle of a unit edge along an axis.
      const double x = curve.place.x() * 2, y = curve.place.y() * 2;
      EXPECT_EQ(std::abs(std::fmod(x, 2)) + std::abs(std::fmod(y, 2)), 1);
    }
    EXPECT_GT(edges, 0u);
    EXPECT_EQ(edges + featureEdges(mesh), before);
    EXPECT_EQ(length, static_cast<double>(edges)); // unit edges
    // Sums in another order, of some hundred numbers of the size of one.
    EXPECT_NEAR(inQuads, length / 3, 1e-10);
  }
}

TEST(GivenUpCurves, TheyEndWhereTheyMeet)
{
  // A cross whose one bar is lost is two curves, as the other bar parts it; a whole cross is four.
  Mesh mesh = test::gridPlane(20, 20);
  markEdges(mesh, onSegment(2, 10, 18, 10));
  const std::vector<std::uint8_t> bar = mesh.flags;
  markEdges(mesh, onSegment(10, 2, 10, 18));
  const std::vector<std::uint8_t> cross = mesh.flags;
  mesh.flags = bar;
  const std::vector<GivenUpCurve> halves =
    givenUpCurves(mesh, lostFeatures(mesh, cross), 2, FeatureLoss::Unresolved);
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].length, 8);
  EXPECT_EQ(halves[1].lengthInQuads, 4);
  mesh.flags.assign(mesh.flags.size(), 0);
  EXPECT_EQ(givenUpCurves(mesh, lostFeatures(mesh, cross), 2, FeatureLoss::Unresolved).size(), 4u);
  EXPECT_EQ(givenUpCurves(mesh, lostFeatures(mesh, bar), 2, FeatureLoss::NoCrease).size(), 1u);
}

TEST(GivenUpCurves, InvalidArguments)
{
  const Mesh mesh = test::gridPlane(2, 2);
  EXPECT_THROW(givenUpCurves(mesh, { 0 }, 0, FeatureLoss::Unresolved), InvalidInput);
  EXPECT_THROW(lostFeatures(mesh, {}), InvalidInput);
}

} // namespace
} // namespace quadrille
