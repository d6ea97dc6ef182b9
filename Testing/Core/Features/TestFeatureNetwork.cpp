// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FeatureNetwork.h"

#include "Base/Error.h"
#include "Features/GivenUpFeatures.h"
#include "Mesh/Sizing.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>

namespace quadrille
{
namespace
{

using EdgeTest = std::function<bool(const Vector3&, const Vector3&)>;

constexpr std::uint8_t kAsked = kFeatureEdge | kRequestedFeature;

/// Marks inner edges for which `test` holds in one of their directions.
void markEdges(Mesh& mesh, std::uint8_t flags, const EdgeTest& test)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!mesh.isBoundary(h) && test(mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]))
    {
      mesh.flags.edit()[h] |= flags;
      mesh.flags.edit()[mesh.twin[h]] |= flags;
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

std::size_t featuresOn(const Mesh& mesh, const EdgeTest& test)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    count += mesh.isFeature(h) && h < mesh.twin[h] && (test(p, q) || test(q, p));
  }
  return count;
}

std::size_t allFeatures(const Mesh& mesh)
{
  return featuresOn(mesh, [](const Vector3&, const Vector3&) { return true; });
}

/// The shortest arc between two vertices where other than two constrained edges meet, by a walk of its own; of arcs
/// that are all detected.
double shortestDetectedArc(const Mesh& mesh)
{
  std::map<Index, std::set<Index>> next;
  std::set<std::pair<Index, Index>> fixed;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      const Index a = mesh.origin[h], b = mesh.target(h);
      next[a].insert(b);
      next[b].insert(a);
      if (mesh.isBoundary(h) || (mesh.flags[h] & kRequestedFeature) != 0)
      {
        fixed.insert({ std::min(a, b), std::max(a, b) });
      }
    }
  }
  double shortest = 1e300;
  for (const auto& [start, around] : next)
  {
    for (Index v : around)
    {
      if (around.size() == 2)
      {
        continue;
      }
      Index from = start;
      double length = 0;
      bool detected = true;
      while (true)
      {
        length += (mesh.position[v] - mesh.position[from]).norm();
        detected = detected && fixed.count({ std::min(v, from), std::max(v, from) }) == 0;
        const std::set<Index>& ways = next[v];
        if (ways.size() != 2)
        {
          break;
        }
        const Index other = *ways.begin() == from ? *ways.rbegin() : *ways.begin();
        from = v;
        v = other;
      }
      shortest = detected ? std::min(shortest, length) : shortest;
    }
  }
  return shortest;
}

NetworkReport simplify(Mesh& mesh, double edgeLength)
{
  FeatureFilterReport filtered;
  return simplifyFeatureNetwork(mesh, edgeLength, false, filtered);
}

TEST(FeatureNetwork, RungBetweenTwoCurvesGoes)
{
  // Two curves that end in the surface, 10 s long, and a rung of s / 4 between them.
  Mesh mesh = test::gridPlane(44, 12);
  markEdges(mesh, kFeatureEdge, onSegment(2, 5, 42, 5));
  markEdges(mesh, kFeatureEdge, onSegment(2, 6, 42, 6));
  markEdges(mesh, kFeatureEdge, onSegment(20, 5, 20, 6));
  ASSERT_EQ(allFeatures(mesh), 81u);
  const NetworkReport report = simplify(mesh, 4);
  EXPECT_EQ(report.shortArcs, 1u);
  EXPECT_EQ(report.removedCurves, 1u);
  EXPECT_EQ(report.removedEdges, 1u);
  EXPECT_DOUBLE_EQ(report.removedLength, 0.25);
  EXPECT_DOUBLE_EQ(report.longest, 0.25);
  EXPECT_DOUBLE_EQ(report.keptLength, 20);
  EXPECT_EQ(report.place, Vector3(20, 5.5, 0));
  EXPECT_EQ(featuresOn(mesh, onSegment(20, 5, 20, 6)), 0u);
  EXPECT_EQ(allFeatures(mesh), 80u);
}

TEST(FeatureNetwork, BetweenTwoJunctionsTheShortestBranchGoes)
{
  // On a curve of 11 s a branch of 1.5 s leaves upwards and one of 4.5 s downwards, an edge further on.
  Mesh mesh = test::gridPlane(44, 24);
  markEdges(mesh, kFeatureEdge, onSegment(0, 18, 44, 18));
  markEdges(mesh, kFeatureEdge, onSegment(20, 18, 20, 24));
  markEdges(mesh, kFeatureEdge, onSegment(21, 0, 21, 18));
  ASSERT_EQ(allFeatures(mesh), 68u);
  const NetworkReport report = simplify(mesh, 4);
  EXPECT_EQ(report.removedCurves, 1u);
  EXPECT_DOUBLE_EQ(report.removedLength, 1.5);
  EXPECT_EQ(featuresOn(mesh, onSegment(20, 18, 20, 24)), 0u);
  EXPECT_EQ(featuresOn(mesh, onSegment(21, 0, 21, 18)), 18u);
  EXPECT_EQ(featuresOn(mesh, onSegment(0, 18, 44, 18)), 44u);
}

TEST(FeatureNetwork, BetweenTwoLongBranchesTheArcGoes)
{
  // Both branches are longer than what two near ends count as, 3 s, and so are both halves of the curve.
  Mesh mesh = test::gridPlane(44, 44);
  markEdges(mesh, kFeatureEdge, onSegment(0, 22, 44, 22));
  markEdges(mesh, kFeatureEdge, onSegment(20, 22, 20, 44));
  markEdges(mesh, kFeatureEdge, onSegment(21, 0, 21, 22));
  const std::size_t before = allFeatures(mesh);
  const NetworkReport report = simplify(mesh, 4);
  EXPECT_EQ(report.removedEdges, 1u);
  EXPECT_EQ(featuresOn(mesh, onSegment(20, 22, 21, 22)), 0u);
  EXPECT_EQ(allFeatures(mesh), before - 1);
}

TEST(FeatureNetwork, WhereAllIsLongNoTinyGapIsMade)
{
  // The same, the arc being s / 8: its ends would be in each other's way without it, too.
  Mesh mesh = test::gridPlane(60, 60);
  markEdges(mesh, kFeatureEdge, onSegment(0, 30, 60, 30));
  markEdges(mesh, kFeatureEdge, onSegment(30, 30, 30, 60));
  markEdges(mesh, kFeatureEdge, onSegment(31, 0, 31, 30));
  const Mesh before = mesh;
  EXPECT_EQ(simplify(mesh, 8).removedCurves, 0u);
  EXPECT_EQ(mesh.flags, before.flags);
}

TEST(FeatureNetwork, LongArcsStay)
{
  Mesh mesh = test::gridPlane(44, 12);
  markEdges(mesh, kFeatureEdge, onSegment(0, 5, 44, 5));
  markEdges(mesh, kFeatureEdge, onSegment(0, 7, 44, 7));
  markEdges(mesh, kFeatureEdge, onSegment(20, 5, 20, 7));
  const Mesh before = mesh;
  // Rungs of exactly half an edge length are long enough.
  const NetworkReport report = simplify(mesh, 4);
  EXPECT_EQ(report.removedCurves, 0u);
  EXPECT_TRUE(report.text().empty());
  EXPECT_EQ(mesh.flags, before.flags);
}

TEST(FeatureNetwork, WhatTheUserAskedForStays)
{
  Mesh mesh = test::gridPlane(44, 12);
  markEdges(mesh, kAsked, onSegment(2, 5, 42, 5));
  markEdges(mesh, kAsked, onSegment(2, 6, 42, 6));
  markEdges(mesh, kAsked, onSegment(20, 5, 20, 6));
  const Mesh before = mesh;
  EXPECT_EQ(simplify(mesh, 4).removedCurves, 0u);
  EXPECT_EQ(mesh.flags, before.flags);
  // A rung that stays takes no curves of 4 s with it.
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool rail = mesh.isFeature(h) && mesh.edgeVector(h).y() == 0;
    mesh.flags.edit()[h] = rail ? std::uint8_t{ kFeatureEdge } : mesh.flags[h];
  }
  const Mesh detected = mesh;
  EXPECT_EQ(simplify(mesh, 4).removedCurves, 0u);
  EXPECT_EQ(mesh.flags, detected.flags);
}

TEST(FeatureNetwork, LadderBecomesItsRails)
{
  // Cells of 8 s between rungs go as thin patches, which takes one rail; so the rails are asked for, and the rungs are
  // not.
  Mesh mesh = test::gridPlane(104, 12);
  markEdges(mesh, kAsked, onSegment(2, 5, 102, 5));
  markEdges(mesh, kAsked, onSegment(2, 6, 102, 6));
  for (const int x : { 20, 52, 84 })
  {
    markEdges(mesh, kFeatureEdge, onSegment(x, 5, x, 6));
  }
  simplify(mesh, 4);
  for (const int x : { 20, 52, 84 })
  {
    EXPECT_EQ(featuresOn(mesh, onSegment(x, 5, x, 6)), 0u);
  }
  EXPECT_EQ(featuresOn(mesh, onSegment(2, 5, 102, 5)), 100u);
  EXPECT_EQ(featuresOn(mesh, onSegment(2, 6, 102, 6)), 100u);
}

TEST(FeatureNetwork, StairsBelowTheQuadsLeaveNoShortArc)
{
  // Twelve steps of s / 4, seen from the side: at the ends of each step's two edges three features meet.
  const Mesh stairs = test::markFeatures(
    test::voxelSurface({ 12, 8, 12 }, 1, [](int i, int, int k) { return k <= i; }), 0.5);
  ASSERT_LT(shortestDetectedArc(stairs), 0.5 * 4);
  Mesh mesh = stairs;
  const NetworkReport report = simplify(mesh, 4);
  EXPECT_GT(report.shortArcs, 0u);
  EXPECT_GE(shortestDetectedArc(mesh), kShortestArc * 4);
  // The two long edges below, and those of the high end, are far from the steps.
  const EdgeTest below = [](const Vector3& p, const Vector3& q)
  { return p.z() == 0 && q.z() == 0 && p.y() == q.y() && (p.y() == 0 || p.y() == 8); };
  EXPECT_EQ(featuresOn(mesh, below), featuresOn(stairs, below));
  // Quads smaller than the steps follow all of it.
  Mesh fine = stairs;
  EXPECT_EQ(simplify(fine, 1).removedCurves, 0u);
  EXPECT_EQ(fine.flags, stairs.flags);
}

TEST(FeatureNetwork, CombLosesItsTeeth)
{
  // A plate with teeth of s / 4 on one side: all edges of teeth are short, those of the plate are not.
  const Mesh comb = test::markFeatures(
    test::voxelSurface({ 24, 12, 12 }, 1, [](int i, int, int k) { return k < 11 || i % 2 == 0; }),
    0.5);
  Mesh mesh = comb;
  simplify(mesh, 4);
  EXPECT_GE(shortestDetectedArc(mesh), kShortestArc * 4);
  const EdgeTest below = [](const Vector3& p, const Vector3& q)
  { return p.z() == 0 && q.z() == 0; };
  EXPECT_EQ(featuresOn(mesh, below), featuresOn(comb, below));
}

TEST(FeatureNetwork, SizesCount)
{
  const auto ladder = []
  {
    Mesh mesh = test::gridPlane(44, 12);
    markEdges(mesh, kFeatureEdge, onSegment(2, 5, 42, 5));
    markEdges(mesh, kFeatureEdge, onSegment(2, 6, 42, 6));
    markEdges(mesh, kFeatureEdge, onSegment(20, 5, 20, 6));
    return mesh;
  };
  Mesh plain = ladder();
  EXPECT_EQ(simplify(plain, 4).removedEdges, 1u);
  Mesh sized = test::withSizes(ladder(), [](const Vector3&) { return 0.25; });
  EXPECT_EQ(simplify(sized, 4).removedEdges, 0u);
}

TEST(FeatureNetwork, InvalidEdgeLength)
{
  Mesh mesh = test::gridPlane(2, 2);
  FeatureFilterReport filtered;
  EXPECT_THROW(simplifyFeatureNetwork(mesh, 0, false, filtered), InvalidInput);
  EXPECT_THROW(givenUpCurves(mesh, { 0 }, 0, FeatureLoss::ShortArc), InvalidInput);
  EXPECT_THROW(lostFeatures(mesh, {}), InvalidInput);
}

TEST(GivenUpFeatures, CurvesAddUpToWhatWasLost)
{
  // Any marks: what is told and what is left is what there was, edge by edge.
  std::mt19937 random(7);
  for (int round = 0; round < 5; ++round)
  {
    Mesh mesh = test::gridPlane(30, 30);
    markEdges(mesh, kFeatureEdge,
      [&](const Vector3& p, const Vector3& q)
      { return std::abs((q - p).norm() - 1) < 1e-12 && random() % 5 == 0; });
    const double before = lengthOfFeatures(mesh, 3);
    const std::size_t edgesBefore = allFeatures(mesh);
    const std::vector<std::uint8_t> flags = mesh.flags;
    simplify(mesh, 3);
    const std::vector<GivenUpCurve> curves =
      givenUpCurves(mesh, lostFeatures(mesh, flags), 3, FeatureLoss::ShortArc);
    double length = 0, inQuads = 0;
    std::size_t edges = 0;
    for (const GivenUpCurve& curve : curves)
    {
      EXPECT_EQ(curve.reason, FeatureLoss::ShortArc);
      length += curve.length;
      inQuads += curve.lengthInQuads;
      edges += curve.edges;
      // In the middle of a unit edge along an axis.
      const double x = curve.place.x() * 2, y = curve.place.y() * 2;
      EXPECT_EQ(std::abs(std::fmod(x, 2)) + std::abs(std::fmod(y, 2)), 1);
    }
    EXPECT_GT(edges, 0u);
    EXPECT_EQ(edges + allFeatures(mesh), edgesBefore);
    EXPECT_EQ(length, static_cast<double>(edges)); // unit edges
    // Sums in another order, of some hundred numbers of the size of one.
    EXPECT_NEAR(inQuads + lengthOfFeatures(mesh, 3), before, 1e-10);
  }
}

TEST(GivenUpFeatures, CurvesEndWhereTheyMeet)
{
  // A cross whose one bar is lost is two curves, as the other bar parts it; a whole cross is four.
  Mesh mesh = test::gridPlane(20, 20);
  markEdges(mesh, kFeatureEdge, onSegment(2, 10, 18, 10));
  const std::vector<std::uint8_t> bar = mesh.flags;
  markEdges(mesh, kFeatureEdge, onSegment(10, 2, 10, 18));
  const std::vector<std::uint8_t> cross = mesh.flags;
  mesh.flags = bar;
  const std::vector<GivenUpCurve> halves =
    givenUpCurves(mesh, lostFeatures(mesh, cross), 2, FeatureLoss::FailedMap);
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].length, 8);
  EXPECT_EQ(halves[1].lengthInQuads, 4);
  mesh.flags.assign(mesh.flags.size(), 0);
  EXPECT_EQ(givenUpCurves(mesh, lostFeatures(mesh, cross), 2, FeatureLoss::FailedMap).size(), 4u);
  EXPECT_EQ(givenUpCurves(mesh, lostFeatures(mesh, bar), 2, FeatureLoss::NoCrease).size(), 1u);
}

} // namespace
} // namespace quadrille
