// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/GuideRegions.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Topology.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

Vector3 middleOf(const Mesh& mesh, Index f)
{
  return (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
           mesh.position[mesh.origin[3 * f + 2]]) /
    3;
}

double areaOf(const Mesh& mesh, Index f)
{
  return 0.5 * mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm();
}

std::vector<FaceGuide> guidesWhere(const Mesh& mesh,
  const std::function<bool(const Vector3&)>& wants,
  const std::function<Vector3(const Vector3&)>& direction)
{
  std::vector<FaceGuide> guides;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 p = middleOf(mesh, f);
    const Vector3 n = faceNormal(mesh, f);
    if (wants(p))
    {
      const Vector3 d = direction(p);
      guides.push_back({ f, { (d - n * n.dot(d)).normalized(), 0.5F } });
    }
  }
  return guides;
}

double angleOfCrosses(const Vector3& a, const Vector3& b, const Vector3& normal)
{
  const double angle = std::atan2(a.cross(b).dot(normal), a.dot(b));
  return std::abs(angle - kPi / 2 * std::round(angle / (kPi / 2)));
}

const Vector3 kSlanted(std::cos(0.5), std::sin(0.5), 0);

/// A square region in the middle of a plane; s is four of its triangles' edges.
struct Square
{
  Mesh mesh = gridPlane(80, 80);
  HierarchyOptions options;

  static bool isInside(const Vector3& p)
  {
    return p.x() > 20 && p.x() < 60 && p.y() > 24 && p.y() < 56;
  }
  Square()
  {
    options.targetEdgeLength = 4;
    options.coarseVertices = 90;
    options.threads = 1;
    options.guides = guidesWhere(mesh, isInside, [](const Vector3&) { return kSlanted; });
  }
};

void expectRegion(const Square& square)
{
  const Hierarchy hierarchy = buildHierarchy(square.mesh, 1, square.options);
  const Mesh& coarse = hierarchy.coarse.mesh;
  ASSERT_EQ(hierarchy.coarse.guides.size(), coarse.faceCount());
  EXPECT_EQ(coarse.vertexCount(), square.options.coarseVertices);
  double guided = 0, wrong = 0;
  std::vector<Vector3> border;
  for (Index f = 0; f < coarse.faceCount(); ++f)
  {
    const Guide& guide = hierarchy.coarse.guides[f];
    guided += guide.isFree() ? 0 : areaOf(coarse, f);
    // Sixteen samples of each triangle.
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        const double u = (i + 0.5) / 4, v = (j + 0.5) / 4 * (1 - u);
        const Vector3 p = coarse.position[coarse.origin[3 * f]] + u * coarse.edgeVector(3 * f) -
          v * coarse.edgeVector(3 * f + 2);
        wrong += Square::isInside(p) == guide.isFree() ? areaOf(coarse, f) * (1 - u) / 10 : 0;
      }
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const bool parts = !coarse.isBoundary(h) &&
        guide.isFree() != hierarchy.coarse.guides[Mesh::face(coarse.twin[h])].isFree();
      EXPECT_EQ((coarse.flags[h] & kRegionBorder) != 0, parts);
      if (parts)
      {
        border.push_back(coarse.position[coarse.origin[h]]);
      }
    }
    if (!guide.isFree())
    {
      EXPECT_LT(angleOfCrosses(guide.direction, kSlanted, Vector3::UnitZ()), 1e-6);
      EXPECT_EQ(guide.weight, 0.5F);
    }
  }
  // A border of 144 that lies a quarter of s off its course on the average would be wrong on 144 of 1280.
  EXPECT_NEAR(guided, 1280, 80);
  EXPECT_LT(wrong, 144);
  for (const Vector3& corner :
    { Vector3(20, 24, 0), Vector3(60, 24, 0), Vector3(60, 56, 0), Vector3(20, 56, 0) })
  {
    const auto nearest = std::min_element(border.begin(), border.end(),
      [&](const Vector3& a, const Vector3& b)
      { return (a - corner).norm() < (b - corner).norm(); });
    EXPECT_LT((*nearest - corner).norm(), square.options.targetEdgeLength) << corner.transpose();
  }
  // The coarse mesh knows no border as a feature.
  for (Index h = 0; h < coarse.halfEdgeCount(); ++h)
  {
    EXPECT_EQ(coarse.isConstrained(h), coarse.isBoundary(h));
  }
}

TEST(GuideRegions, CoarseTrianglesAreInsideOrOutside)
{
  expectRegion(Square());
}

TEST(GuideRegions, RegionsOfLargeLevelsWaitForTheOrder)
{
  Square square;
  square.options.mostOrdered = 300;
  const Hierarchy hierarchy = buildHierarchy(square.mesh, 1, square.options);
  EXPECT_GT(hierarchy.log.rounds.size(), hierarchy.log.intermediateRounds + 1);
  expectRegion(square);
}

TEST(GuideRegions, DirectionsAreCarriedOverCurvedSurfaces)
{
  const Mesh mesh = openCylinder(120, 60, 10, 30);
  const auto helix = [](const Vector3& p)
  { return Vector3(Vector3(-p.y(), p.x(), 0).normalized() + 0.5 * Vector3::UnitZ()); };
  HierarchyOptions options;
  options.targetEdgeLength = 1.5;
  options.coarseVertices = 120;
  options.guides = guidesWhere(
    mesh, [](const Vector3& p) { return std::abs(p.z() - 15) < 8; }, helix);
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, options);
  const Mesh& coarse = hierarchy.coarse.mesh;
  ASSERT_LT(coarse.vertexCount(), 200u);
  double area = 0, sum = 0, worst = 0;
  for (Index f = 0; f < coarse.faceCount(); ++f)
  {
    const Guide& guide = hierarchy.coarse.guides[f];
    const Vector3 n = faceNormal(coarse, f);
    if (guide.isFree())
    {
      continue;
    }
    EXPECT_NEAR(guide.direction.dot(n), 0, 1e-9);
    EXPECT_NEAR(guide.direction.norm(), 1, 1e-9);
    const Vector3 d = helix(middleOf(coarse, f));
    const double angle = angleOfCrosses(guide.direction, (d - n * n.dot(d)).normalized(), n);
    area += areaOf(coarse, f);
    sum += areaOf(coarse, f) * angle;
    worst = std::max(worst, angle);
  }
  EXPECT_NEAR(area, 2 * kPi * 10 * 16, 0.12 * 2 * kPi * 10 * 16);
  // A coarse triangle spans some 30 degrees of the cylinder; planes cannot do better than a few.
  EXPECT_LT(sum / area, 3 * kPi / 180);
  EXPECT_LT(worst, 15 * kPi / 180);
}

/// Vertices that stay for the region of `wants` on a plane of unit cells.
std::vector<Vector3> keptOf(const std::function<bool(const Vector3&)>& wants, double length)
{
  const Mesh mesh = gridPlane(40, 40);
  std::vector<Guide> guides(mesh.faceCount());
  for (const FaceGuide& guide :
    guidesWhere(mesh, wants, [](const Vector3&) { return Vector3::UnitX(); }))
  {
    guides[guide.face] = guide.guide;
  }
  DecimationMesh decimated(mesh, traceFeatureCurves(mesh, 1));
  std::vector<Vector3> kept;
  for (const Index v : markGuideRegions(decimated, guides, length))
  {
    kept.push_back(mesh.position[v]);
  }
  return kept;
}

bool contains(const std::vector<Vector3>& points, double x, double y)
{
  return std::find(points.begin(), points.end(), Vector3(x, y, 0)) != points.end();
}

TEST(GuideRegions, CornersStayUnlessTheyAreClose)
{
  const auto inside = [](const Vector3& p, double x0, double y0, double x1, double y1)
  { return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1; };
  const auto square = [&](const Vector3& p) { return inside(p, 10, 10, 30, 30); };
  const std::vector<Vector3> four = keptOf(square, 4);
  EXPECT_EQ(four.size(), 4u);
  EXPECT_TRUE(contains(four, 10, 10) && contains(four, 30, 10) && contains(four, 30, 30) &&
    contains(four, 10, 30));

  // The reflex corner of an L is none: the region cannot shrink there.
  const std::vector<Vector3> l =
    keptOf([&](const Vector3& p) { return square(p) && !inside(p, 20, 20, 40, 40); }, 4);
  EXPECT_EQ(l.size(), 5u);
  EXPECT_FALSE(contains(l, 20, 20));

  // A knob smaller than s has two corners closer than s to each other, of which one at most stays.
  const std::vector<Vector3> knob =
    keptOf([&](const Vector3& p) { return square(p) || inside(p, 18, 9, 20, 12); }, 4);
  EXPECT_LE(knob.size(), 5u);
  EXPECT_FALSE(contains(knob, 18, 9) && contains(knob, 20, 9));
  // One of the size of s keeps both.
  const std::vector<Vector3> block =
    keptOf([&](const Vector3& p) { return square(p) || inside(p, 16, 4, 24, 12); }, 4);
  EXPECT_TRUE(contains(block, 16, 4) && contains(block, 24, 4));

  // A staircase is a straight border; inner angles of 3/4 pi and more are no corners.
  const std::vector<Vector3> diagonal = keptOf(
    [&](const Vector3& p) { return square(p) && std::floor(p.x()) + std::floor(p.y()) < 40; }, 4);
  EXPECT_EQ(diagonal.size(), 3u);
}

TEST(GuideRegions, BordersThatMeetABoundaryOrAFeatureEndThere)
{
  const std::vector<Vector3> kept = keptOf([](const Vector3& p) { return p.x() > 20; }, 4);
  EXPECT_EQ(kept.size(), 2u);
  EXPECT_TRUE(contains(kept, 20, 0) && contains(kept, 20, 40));
}

TEST(GuideRegions, AStrokeOneFaceWideSurvives)
{
  const Mesh mesh = gridPlane(120, 60);
  HierarchyOptions options;
  options.targetEdgeLength = 8;
  options.coarseVertices = 120;
  options.guides = guidesWhere(
    mesh, [](const Vector3& p) { return p.y() > 30 && p.y() < 31 && p.x() > 20 && p.x() < 100; },
    [](const Vector3&) { return kSlanted; });
  const Hierarchy hierarchy = buildHierarchy(mesh, 1, options);
  // The line is all under guided triangles but for its ends.
  const Mesh& coarse = hierarchy.coarse.mesh;
  int covered = 0, samples = 0;
  for (double x = 24; x < 96; x += 1, ++samples)
  {
    for (Index f = 0; f < coarse.faceCount(); ++f)
    {
      bool inside = !hierarchy.coarse.guides[f].isFree();
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        inside = inside &&
          coarse.edgeVector(h)
              .cross(Vector3(x + 0.01, 30.51, 0) - coarse.position[coarse.origin[h]])
              .z() > 0;
      }
      covered += inside ? 1 : 0;
    }
  }
  EXPECT_GE(covered, 0.85 * samples);
}

TEST(GuideRegions, StrokesLeadBesideThemAndWideRegionsDoNot)
{
  const Mesh mesh = gridPlane(60, 60);
  Level level;
  level.mesh = mesh;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    level.fineVertex.push_back(v);
  }
  constexpr double kReach = 2;   // a stroke reaches three times as far,
  constexpr double kAFace = 1.5; // give or take a triangle
  for (const double halfWidth : { 0.5, 15.0 })
  {
    const auto away = [&](Index f) { return std::abs(middleOf(mesh, f).y() - 30.5) - halfWidth; };
    const std::vector<FaceGuide> guides = guidesWhere(
      mesh, [&](const Vector3& p) { return std::abs(p.y() - 30.5) < halfWidth; },
      [](const Vector3&) { return kSlanted; });
    const std::vector<Guide> led = guidesOfLevel(mesh, level, guides, kReach, 1);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const double reach = halfWidth < 1 ? 3 * kReach : 0;
      EXPECT_TRUE(!led[f].isFree() || away(f) > std::max(0.0, reach - kAFace)) << f;
      EXPECT_TRUE(led[f].isFree() || away(f) <= reach) << f;
    }
  }
}

void expectSame(const Hierarchy& a, const Hierarchy& b)
{
  EXPECT_EQ(a.coarse.mesh.origin, b.coarse.mesh.origin);
  EXPECT_EQ(a.coarse.fineVertex, b.coarse.fineVertex);
  EXPECT_EQ(a.coarse.fineFace, b.coarse.fineFace);
  EXPECT_EQ(a.coarse.mesh.flags, b.coarse.mesh.flags);
  EXPECT_TRUE(a.coarse.guides == b.coarse.guides);
  EXPECT_TRUE(a.intermediate.guides == b.intermediate.guides);
  EXPECT_EQ(a.log.serialize(), b.log.serialize());
}

TEST(GuideRegions, ChangesNeedPhase2OnlyAndLeaveNoTrace)
{
  Square square;
  square.options.threads = 2;
  const std::vector<FaceGuide> first = square.options.guides;
  const std::vector<FaceGuide> second = guidesWhere(
    square.mesh, [](const Vector3& p) { return (p - Vector3(30, 30, 0)).norm() < 14; },
    [](const Vector3&) { return Vector3::UnitX(); });
  Redecimation levels(square.mesh, 1, square.options);
  for (const std::vector<FaceGuide>& guides : { first, second, {}, first })
  {
    HierarchyOptions options = square.options;
    options.guides = guides;
    ASSERT_TRUE(levels.allows(options));
    options.threads = 1;
    expectSame(levels.update(options), buildHierarchy(square.mesh, 1, options));
  }
}

TEST(GuideRegions, AStoppedChangeLeavesNoTrace)
{
  const Square square;
  HierarchyOptions free = square.options;
  free.guides.clear();
  HierarchyOptions other = square.options;
  other.guides.pop_back();
  Redecimation levels(square.mesh, 1, square.options);
  levels.update(square.options);
  {
    PollScope scope([](double, const std::string&) { return false; });
    std::this_thread::sleep_for(PollScope::kInterval);
    EXPECT_THROW(levels.update(other), Cancelled);
  }
  expectSame(levels.update(free), buildHierarchy(square.mesh, 1, free));
}

TEST(GuideRegions, TheSameForAnyNumberOfThreads)
{
  const Mesh mesh = sphere(5);
  HierarchyOptions options;
  options.targetEdgeLength = 0.1;
  options.coarseVertices = 150;
  options.guides = guidesWhere(
    mesh, [](const Vector3& p) { return p.z() > 0.3; }, [](const Vector3&) { return kSlanted; });
  options.threads = 1;
  const Hierarchy one = buildHierarchy(mesh, 1, options);
  EXPECT_FALSE(one.coarse.guides.empty());
  options.threads = 4;
  expectSame(one, buildHierarchy(mesh, 1, options));
}

TEST(GuideRegions, GuidesOutOfOrderAreRefused)
{
  Square square;
  Redecimation levels(square.mesh, 1, square.options);
  std::swap(square.options.guides[0], square.options.guides[1]);
  EXPECT_THROW(levels.update(square.options), InvalidInput);
  EXPECT_THROW(buildHierarchy(square.mesh, 1, square.options), InvalidInput);
  square.options.guides = { { square.mesh.faceCount(), { Vector3::UnitX(), 1 } } };
  EXPECT_THROW(levels.update(square.options), InvalidInput);
  EXPECT_THROW(buildHierarchy(square.mesh, 1, square.options), InvalidInput);
}

} // namespace
} // namespace quadrille
