// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "BothPhases.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/SurfaceEdit.h"
#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

constexpr double kFeatureAngle = 0.7; // radians, 40 degrees

HierarchyOptions makeOptions(double edgeLength, Index coarseVertices, int threads = 1)
{
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = coarseVertices;
  options.threads = threads;
  return options;
}

/// Closed bumpy surface of genus 0 with curvature of both signs.
Mesh bumpySphere(int level)
{
  Mesh mesh = sphere(level);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.15 * std::sin(4 * p.x()) * std::cos(3 * p.y());
  }
  return mesh;
}

Index countFacesWithTwoConstrainedEdges(const Mesh& mesh)
{
  Index count = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    int edges = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      edges += mesh.isConstrained(h) ? 1 : 0;
    }
    count += edges > 1 ? 1 : 0;
  }
  return count;
}

/// Every level is a valid mesh with the input's topology whose corners are slots of the input.
void expectLevel(const Mesh& fine, const Level& level)
{
  EXPECT_EQ(validate(level.mesh), "");
  const TopologySummary before = summarizeTopology(fine);
  const TopologySummary after = summarizeTopology(level.mesh);
  EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.boundaryLoops, before.boundaryLoops);
  ASSERT_EQ(level.fineVertex.size(), level.mesh.position.size());
  ASSERT_EQ(level.fineFace.size(), level.mesh.faceCount());
  for (Index v = 0; v < level.mesh.vertexCount(); ++v)
  {
    EXPECT_EQ(level.mesh.position[v], fine.position[level.fineVertex[v]]);
  }
  EXPECT_TRUE(std::is_sorted(level.fineFace.begin(), level.fineFace.end()));
}

void expectHierarchy(const Mesh& fine, const Hierarchy& hierarchy)
{
  expectLevel(fine, hierarchy.intermediate);
  expectLevel(fine, hierarchy.coarse);
  EXPECT_EQ(hierarchy.log.collapses + hierarchy.coarse.mesh.vertexCount(), fine.vertexCount());
}

double distanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

} // namespace

TEST(Hierarchy, KeepsTopologyOfEveryKindOfSurface)
{
  const std::vector<Mesh> meshes{ bumpySphere(4), torus(60, 30), gridPlane(30, 20),
    plateWithHole(10), plateL(15), openCylinder(48, 20), markFeatures(unitCube(14), kFeatureAngle),
    markFeatures(doubleTorus(6), kFeatureAngle), twoComponents() };
  for (const Mesh& mesh : meshes)
  {
    double diagonal = 0;
    for (const Vector3& p : mesh.position)
    {
      diagonal = std::max(diagonal, (p - mesh.position[0]).norm());
    }
    expectHierarchy(mesh, buildHierarchy(mesh, 1, makeOptions(0.15 * diagonal, 60)));
  }
}

TEST(Hierarchy, ReachesTheBudgetExactlyOnASmoothSurface)
{
  const Mesh mesh = bumpySphere(5);
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, makeOptions(0.15, 300));
  EXPECT_EQ(hierarchy.coarse.mesh.vertexCount(), 300U);
  EXPECT_EQ(hierarchy.notice, "");
}

TEST(Hierarchy, LeavesFewShortEdgesAfterPhase1)
{
  const Mesh mesh = bumpySphere(5);
  const double s = 0.2;
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, makeOptions(s, 100000));
  const Mesh& level = hierarchy.intermediate.mesh;
  Index shortEdges = 0;
  for (Index h = 0; h < level.halfEdgeCount(); ++h)
  {
    shortEdges += level.edgeVector(h).norm() < 0.5 * s ? 1 : 0;
  }
  // Guards for normals and shapes may hold a few back; a smooth surface has hardly any reason for them.
  EXPECT_LT(shortEdges, level.halfEdgeCount() / 50);
  EXPECT_LT(level.vertexCount(), mesh.vertexCount() / 4);
  EXPECT_EQ(hierarchy.coarse.mesh.vertexCount(), level.vertexCount()) << "already below the budget";
}

TEST(Hierarchy, EveryCostReachesTheBudget)
{
  const Mesh mesh = bumpySphere(4);
  for (const DecimationCost cost : { DecimationCost::Gaussian, DecimationCost::GaussianMemory,
         DecimationCost::Quadric, DecimationCost::Uniform })
  {
    HierarchyOptions options = makeOptions(0.1, 200);
    options.cost = cost;
    const Hierarchy hierarchy = buildHierarchy(mesh, 1, options);
    expectHierarchy(mesh, hierarchy);
    EXPECT_EQ(hierarchy.coarse.mesh.vertexCount(), 200U) << static_cast<int>(cost);
  }
}

TEST(Hierarchy, GivesTheSameBytesForAnyNumberOfThreads)
{
  // Large enough for several blocks in a round.
  const Mesh mesh = torus(300, 150);
  const Hierarchy one = buildHierarchy(mesh, 7, makeOptions(0.15, 400, 1));
  ASSERT_GT(one.log.blocks.size(), one.log.rounds.size() + 2);
  for (const int threads : { 2, 4, 8 })
  {
    const Hierarchy many = buildHierarchy(mesh, 7, makeOptions(0.15, 400, threads));
    EXPECT_EQ(many.log.serialize(), one.log.serialize());
    EXPECT_EQ(many.coarse.mesh.origin, one.coarse.mesh.origin);
    EXPECT_EQ(many.coarse.fineFace, one.coarse.fineFace);
  }
}

TEST(Hierarchy, LogIsAsSmallAsThePapers)
{
  const Mesh mesh = bumpySphere(5);
  const DecimationLog log = buildHierarchy(mesh, 1, makeOptions(0.15, 200)).log;
  // 13 bytes a flip and 32 + 4 k a collapse; k is 5 to 6 on average on any surface.
  EXPECT_LE(log.recordBytes(), 13 * log.flips + (32 + 4 * 5) * log.collapses);
}

TEST(Hierarchy, KeepsCubeCornersAndStraightEdges)
{
  const Mesh mesh = markFeatures(unitCube(16), kFeatureAngle);
  const Mesh coarse = buildHierarchy(mesh, 1, makeOptions(0.3, 60)).coarse.mesh;
  Index corners = 0;
  for (const Vector3& p : coarse.position)
  {
    corners += (p.array() * (1 - p.array())).isZero(0) ? 1 : 0;
  }
  EXPECT_EQ(corners, 8U);
  double length = 0;
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    if (coarse.isFeature(h))
    {
      const Vector3 edge = coarse.edgeVector(h);
      EXPECT_EQ((edge.array() != 0).count(), 1)
        << "feature edges stay parallel to an axis, exactly";
      length += 0.5 * edge.norm();
    }
  }
  EXPECT_NEAR(length, 12, 1e-12) << "sum of at most a few hundred roundings of 1e-16";
  EXPECT_EQ(countFacesWithTwoConstrainedEdges(coarse), 0U);
}

TEST(Hierarchy, NeverJoinsACurveWithItself)
{
  // Both rims of a cylinder are circles; an edge inside the surface must not join two points of one.
  const Mesh mesh = openCylinder(64, 24);
  const Mesh coarse = buildHierarchy(mesh, 1, makeOptions(0.8, 20)).coarse.mesh;
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    const double z = coarse.position[coarse.origin[h]].z();
    const bool chord =
      !coarse.isBoundary(h) && (z == 0 || z == 2) && z == coarse.position[coarse.target(h)].z();
    EXPECT_FALSE(chord) << coarse.origin[h] << " - " << coarse.target(h);
  }
}

TEST(Hierarchy, NeverJoinsTwoCurvesByAChord)
{
  // Long narrow strips: quads of the wanted size would span them, and an edge across would be shorter than those
  // along them. The second one is closed, between two circles without corners.
  for (const Mesh& mesh : { gridPlane(120, 4), openCylinder(128, 6) })
  {
    const double s = (mesh.position.back() - mesh.position.front()).norm() / 12;
    const Hierarchy hierarchy = buildHierarchy(mesh, 1, makeOptions(s, 20));
    for (const Level* level : { &hierarchy.intermediate, &hierarchy.coarse })
    {
      ASSERT_LT(level->mesh.vertexCount(), mesh.vertexCount() / 2);
      std::vector<char> onCurve(level->mesh.vertexCount(), 0);
      for (Index h = 0; h < level->mesh.halfEdgeCount(); ++h)
      {
        if (level->mesh.isBoundary(h))
        {
          onCurve[level->mesh.origin[h]] = 1;
        }
      }
      for (Index h = 0; h < level->mesh.halfEdgeCount(); ++h)
      {
        EXPECT_TRUE(level->mesh.isBoundary(h) || !onCurve[level->mesh.origin[h]] ||
          !onCurve[level->mesh.target(h)])
          << level->mesh.origin[h] << " - " << level->mesh.target(h);
      }
    }
  }
}

TEST(Hierarchy, ChordsOfTheInputMoveAlong)
{
  // One row of squares: every inner edge is a chord between the two sides, and none is a reason to keep a vertex.
  const Mesh mesh = gridPlane(40, 1);
  const Mesh coarse = buildHierarchy(mesh, 1, makeOptions(6, 4)).coarse.mesh;
  EXPECT_LT(coarse.vertexCount(), mesh.vertexCount() / 2);
}

TEST(Hierarchy, KeepsCornersOfABoundary)
{
  const int n = 16;
  const Mesh coarse = buildHierarchy(plateL(n), 1, makeOptions(8, 30)).coarse.mesh;
  for (const Vector3& corner : { Vector3(0, 0, 0), Vector3(2 * n, 0, 0), Vector3(2 * n, n, 0),
         Vector3(n, n, 0), Vector3(n, 2 * n, 0), Vector3(0, 2 * n, 0) })
  {
    EXPECT_NE(
      std::find(coarse.position.begin(), coarse.position.end(), corner), coarse.position.end())
      << corner.transpose();
  }
}

TEST(Hierarchy, StaysCloseToRoundCurves)
{
  const double s = 0.5;
  const Mesh mesh = openCylinder(256, 60);
  const Mesh coarse = buildHierarchy(mesh, 1, makeOptions(s, 10)).coarse.mesh;
  for (const Vector3& p : mesh.position)
  {
    if (p.z() != 0)
    {
      continue;
    }
    double distance = 10;
    for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
    {
      if (coarse.isBoundary(h))
      {
        distance = std::min(distance,
          distanceToSegment(
            p, coarse.position[coarse.origin[h]], coarse.position[coarse.target(h)]));
      }
    }
    // The bound on the curve is s / 10; it is met with the accumulated error, so never exceeded.
    EXPECT_LE(distance, 0.1 * s);
  }
}

TEST(Hierarchy, BoundaryLoopsKeepFourEdges)
{
  // A hole that is tiny against s: everything about it wants to collapse.
  const Mesh mesh = plateWithHole(4);
  Mesh warped = mesh;
  for (Vector3& p : warped.position.editAll())
  {
    const Vector3 d = p - Vector3(6, 6, 0);
    const double r = d.head<2>().norm();
    p = Vector3(6, 6, 0) + d * std::pow(r / 8.5, 3); // the hole shrinks to a fiftieth of the plate
  }
  const Mesh coarse = buildHierarchy(warped, 1, makeOptions(4, 12)).coarse.mesh;
  Index holeEdges = 0;
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    const Vector3& p = coarse.position[coarse.origin[h]];
    holeEdges += coarse.isBoundary(h) && (p - Vector3(6, 6, 0)).norm() < 2 ? 1 : 0;
  }
  EXPECT_GE(holeEdges, 4U);
  EXPECT_EQ(summarizeTopology(coarse).boundaryLoops, 2U);
}

TEST(Hierarchy, EndsAndJunctionsOfFeaturesStay)
{
  // A feature line in the middle of a plate that ends inside, with a branch at its middle.
  Mesh mesh = gridPlane(40, 40);
  const auto isOnLine = [](const Vector3& p) { return p.y() == 20 && p.x() >= 10 && p.x() <= 30; };
  const auto isOnBranch = [](const Vector3& p)
  { return p.x() == 20 && p.y() >= 20 && p.y() <= 30; };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& a = mesh.position[mesh.origin[h]];
    const Vector3& b = mesh.position[mesh.target(h)];
    if ((isOnLine(a) && isOnLine(b)) || (isOnBranch(a) && isOnBranch(b)))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  const Mesh coarse = buildHierarchy(mesh, 1, makeOptions(20, 20)).coarse.mesh;
  for (const Vector3& p :
    { Vector3(10, 20, 0), Vector3(30, 20, 0), Vector3(20, 20, 0), Vector3(20, 30, 0) })
  {
    EXPECT_NE(std::find(coarse.position.begin(), coarse.position.end(), p), coarse.position.end())
      << p.transpose();
  }
  double length = 0;
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    length += coarse.isFeature(h) ? 0.5 * coarse.edgeVector(h).norm() : 0;
  }
  EXPECT_NEAR(length, 30, 1e-12);
}

TEST(Hierarchy, KeptVerticesStay)
{
  const Mesh mesh = bumpySphere(4);
  HierarchyOptions options = makeOptions(0.4, 100); // both phases would like to remove them
  for (Index v = 0; v < mesh.vertexCount(); v += 50)
  {
    options.keepVertices.push_back(v);
  }
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, options);
  ASSERT_LT(hierarchy.intermediate.mesh.vertexCount(), mesh.vertexCount() / 2);
  const Level& coarse = hierarchy.coarse;
  for (const Index v : options.keepVertices)
  {
    EXPECT_TRUE(std::binary_search(coarse.fineVertex.begin(), coarse.fineVertex.end(), v)) << v;
  }
}

/// Every 29th vertex of the intermediate level.
std::vector<Index> someIntermediateVertices(const Hierarchy& hierarchy)
{
  std::vector<Index> some;
  for (std::size_t i = 7; i < hierarchy.intermediate.fineVertex.size(); i += 29)
  {
    some.push_back(hierarchy.intermediate.fineVertex[i]);
  }
  return some;
}

TEST(Hierarchy, RedecimationGivesWhatStartingAnewGives)
{
  for (const Mesh& mesh : { bumpySphere(4), markFeatures(unitCube(14), kFeatureAngle),
         plateWithHole(12), twoComponents() })
  {
    const double s = 0.05 * (mesh.position.back() - mesh.position.front()).norm();
    for (const DecimationCost cost : { DecimationCost::Gaussian, DecimationCost::GaussianMemory,
           DecimationCost::Quadric, DecimationCost::Uniform })
    {
      HierarchyOptions options = makeOptions(s, 150);
      options.cost = cost;
      Redecimation levels(mesh, 3, options);
      const Hierarchy first = levels.update(options);
      HierarchyOptions other = options;
      other.keepVertices = someIntermediateVertices(first);
      other.coarseVertices = 180;
      ASSERT_FALSE(other.keepVertices.empty());
      const Hierarchy updated = levels.update(other);
      const Hierarchy anew = buildHierarchy(mesh, 3, other);
      EXPECT_EQ(updated.log.serialize(), anew.log.serialize());
      EXPECT_EQ(updated.coarse.fineVertex, anew.coarse.fineVertex);
      EXPECT_EQ(updated.coarse.fineFace, anew.coarse.fineFace);
      EXPECT_EQ(updated.coarse.mesh.origin, anew.coarse.mesh.origin);
      for (const Index v : other.keepVertices)
      {
        EXPECT_TRUE(std::binary_search(
          updated.coarse.fineVertex.begin(), updated.coarse.fineVertex.end(), v));
      }
      expectHierarchy(mesh, updated);
      // And back again: nothing of the second time is left.
      EXPECT_EQ(levels.update(options).log.serialize(), first.log.serialize());
    }
  }
}

TEST(Hierarchy, LargeLevelsAreThinnedOutBeforeTheOrder)
{
  for (const Mesh& mesh : { bumpySphere(5), torus(120, 60), plateWithHole(40),
         markFeatures(unitCube(30), kFeatureAngle), twoComponents() })
  {
    const double s = 0.02 * (mesh.position.back() - mesh.position.front()).norm();
    HierarchyOptions options = makeOptions(s, 80);
    options.mostOrdered = 600;
    options.keepVertices = { 3, mesh.vertexCount() / 2, mesh.vertexCount() - 5 };
    const Hierarchy one = buildHierarchy(mesh, 9, options);
    expectHierarchy(mesh, one);
    if (one.intermediate.mesh.vertexCount() <= options.mostOrdered)
    {
      EXPECT_EQ(one.log.rounds.size(), one.log.intermediateRounds + 1);
      continue;
    }
    EXPECT_GT(one.log.rounds.size(), one.log.intermediateRounds + 3);
    for (const Index v : options.keepVertices)
    {
      EXPECT_TRUE(
        std::binary_search(one.coarse.fineVertex.begin(), one.coarse.fineVertex.end(), v));
    }
    const std::vector<std::uint8_t> bytes = one.log.serialize();
    EXPECT_EQ(DecimationLog::deserialize(bytes, 9).serialize(), bytes); // walks all records
    options.threads = 4;
    EXPECT_EQ(buildHierarchy(mesh, 9, options).log.serialize(), bytes);
  }
}

TEST(Hierarchy, RedecimationOfALargeLevelGivesWhatStartingAnewGives)
{
  const Mesh mesh = bumpySphere(5);
  for (const DecimationCost cost : { DecimationCost::Gaussian, DecimationCost::GaussianMemory,
         DecimationCost::Quadric, DecimationCost::Uniform })
  {
    HierarchyOptions options = makeOptions(0.05, 150);
    options.cost = cost;
    options.mostOrdered = 800;
    Redecimation levels(mesh, 3, options);
    const Hierarchy first = levels.update(options);
    ASSERT_GT(first.intermediate.mesh.vertexCount(), options.mostOrdered);
    EXPECT_EQ(first.coarse.mesh.vertexCount(), 150U);
    HierarchyOptions other = options;
    other.keepVertices = someIntermediateVertices(first);
    const Hierarchy updated = levels.update(other);
    EXPECT_EQ(updated.log.serialize(), buildHierarchy(mesh, 3, other).log.serialize());
    EXPECT_EQ(levels.update(options).log.serialize(), first.log.serialize());
  }
}

TEST(Hierarchy, RedecimationLogsAreWellFormed)
{
  const Mesh mesh = bumpySphere(4);
  const HierarchyOptions options = makeOptions(0.1, 100);
  Redecimation levels(mesh, 9, options);
  for (const Index budget : { 100U, 300U, 50U })
  {
    const DecimationLog& log = levels.update(makeOptions(0.1, budget)).log;
    const std::vector<std::uint8_t> bytes = log.serialize();
    const DecimationLog back = DecimationLog::deserialize(bytes, 9); // walks all records
    EXPECT_EQ(back.collapses + budget, mesh.vertexCount());
    EXPECT_EQ(back.intermediateRounds, log.intermediateRounds);
    EXPECT_EQ(back.rounds.size(), log.intermediateRounds + 1);
  }
}

TEST(Hierarchy, RedecimationKnowsTheCostsThatItHadBefore)
{
  const Mesh mesh = bumpySphere(5);
  HierarchyOptions options = makeOptions(0.05, 200);
  Redecimation levels(mesh, 1, options);
  const CacheReport cold = levels.update(options).cache;
  const CacheReport warm = levels.update(options).cache;
  // The same steps meet the same stars; only stars whose triangulation met an edge elsewhere are not stored.
  EXPECT_EQ(warm.lookups, cold.lookups);
  EXPECT_GT(warm.hits * 1000, warm.lookups * 999);
  EXPECT_GT(warm.bytes, 0U);
  // In the first run each star is new when its cost is asked for, and known when its vertex goes.
  EXPECT_LT(cold.hits, cold.lookups / 4);
  EXPECT_GE(cold.hits, levels.hierarchy().intermediate.mesh.vertexCount() - 200U);
  // One vertex more to keep changes the order only near it.
  options.keepVertices = { levels.hierarchy().intermediate.fineVertex[100] };
  const CacheReport near = levels.update(options).cache;
  EXPECT_GT(near.hits * 2, near.lookups);
}

/// Rough surfaces cost more than the first ceilings allow. What was planned under one of them, with the same guards, is
/// known under the next: otherwise one lookup in five finds something here, and with it three in ten.
TEST(Hierarchy, LaterCeilingsKnowThePlansOfEarlierOnes)
{
  Mesh mesh = test::sphere(5);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.04 * std::sin(91 * p.x()) * std::sin(87 * p.y()) * std::sin(95 * p.z());
  }
  const HierarchyOptions options = makeOptions(0.02, 100);
  const CacheReport report = Redecimation(mesh, 1, options).update(options).cache;
  EXPECT_GT(4 * report.hits, report.lookups);
}

TEST(Hierarchy, RedecimationRefusesAnotherEdgeLength)
{
  const Mesh mesh = bumpySphere(4);
  Redecimation levels(mesh, 1, makeOptions(0.4, 50));
  const HierarchyOptions options = makeOptions(0.5, 50);
  EXPECT_THROW(levels.update(options), InvalidInput);
}

TEST(Hierarchy, EveryComponentKeepsItsShare)
{
  // One large sphere and thirty that are smaller than s.
  Mesh mesh = bumpySphere(4);
  Mesh small = sphere(2);
  for (Vector3& p : small.position.editAll())
  {
    p *= 0.05;
  }
  for (int i = 0; i < 30; ++i)
  {
    mesh = disjointUnion(std::move(mesh), small, Vector3(3 + i, 0, 0));
  }
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, makeOptions(0.3, 100));
  expectHierarchy(mesh, hierarchy);
  EXPECT_NE(hierarchy.notice, "") << "31 components of 12 vertices do not fit into 100";
  Index count = 0;
  const std::vector<Index> component = faceComponents(hierarchy.coarse.mesh, count);
  std::vector<std::set<Index>> vertices(count);
  for (Index h = 0; h < hierarchy.coarse.mesh.halfEdgeCount(); ++h)
  {
    vertices[component[h / 3]].insert(hierarchy.coarse.mesh.origin[h]);
  }
  for (const std::set<Index>& set : vertices)
  {
    EXPECT_GE(set.size(), 12U);
  }
}

TEST(Hierarchy, TrianglesOfTheCoarseLevelAreWellShaped)
{
  const Mesh coarse = buildHierarchy(bumpySphere(5), 1, makeOptions(0.1, 500)).coarse.mesh;
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    const Vector3 a = coarse.edgeVector(h);
    const Vector3 b = -coarse.edgeVector(Mesh::previous(h));
    // The loosest stage allows quality 0.2, that is 6.6 degrees for a needle.
    EXPECT_GT(std::atan2(a.cross(b).norm(), a.dot(b)), 6 * kPi / 180);
  }
}

TEST(Hierarchy, RefusesBadOptionsAndCancels)
{
  const Mesh mesh = sphere(2);
  EXPECT_THROW(buildHierarchy(mesh, 1, makeOptions(0, 10)), InvalidInput);
  EXPECT_THROW(buildHierarchy(mesh, 1, makeOptions(std::nan(""), 10)), InvalidInput);
  HierarchyOptions options = makeOptions(0.1, 10);
  options.keepVertices = { 100000 };
  EXPECT_THROW(buildHierarchy(mesh, 1, options), InvalidInput);
  options = makeOptions(1, 10);
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(buildHierarchy(mesh, 1, options), Cancelled);
}
