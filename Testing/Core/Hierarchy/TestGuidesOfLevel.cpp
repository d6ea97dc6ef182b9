// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "BothPhases.h"
#include "Hierarchy/GuidesOfLevel.h"
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

std::vector<FaceGuide> guidesWhere(const Mesh& mesh,
  const std::function<bool(const Vector3&)>& wants,
  const std::function<Vector3(const Vector3&)>& direction)
{
  std::vector<FaceGuide> guides;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 p = mesh.middleOfFace(f);
    const Vector3 n = faceNormal(mesh, f);
    if (wants(p))
    {
      const Vector3 d = direction(p);
      guides.push_back({ f, { (d - n * n.dot(d)).normalized(), 0.5F } });
    }
  }
  return guides;
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

TEST(GuidesOfLevel, StrokesLeadBesideThemAndWideRegionsDoNot)
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
    const auto away = [&](Index f)
    { return std::abs(mesh.middleOfFace(f).y() - 30.5) - halfWidth; };
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
  EXPECT_TRUE(a.intermediate.guides == b.intermediate.guides);
  EXPECT_EQ(a.log.serialize(), b.log.serialize());
}

TEST(GuidesOfLevel, ChangeNoTriangleAndLeaveNoTrace)
{
  Square square;
  square.options.threads = 2;
  const std::vector<FaceGuide> first = square.options.guides;
  const std::vector<FaceGuide> second = guidesWhere(
    square.mesh, [](const Vector3& p) { return (p - Vector3(30, 30, 0)).norm() < 14; },
    [](const Vector3&) { return Vector3::UnitX(); });
  Redecimation levels(square.mesh, 1, square.options);
  Redecimation guided(square.mesh, 1, square.options);
  guided.update(square.options);
  const auto coarse = guided.hierarchy().coarse.fineFace;
  for (const std::vector<FaceGuide>& guides : { first, second, {}, first })
  {
    HierarchyOptions options = square.options;
    options.guides = guides;
    options.threads = 1;
    const Hierarchy anew = buildHierarchy(square.mesh, 1, options);
    EXPECT_EQ(anew.coarse.fineFace, coarse);
    EXPECT_EQ(anew.intermediate.guides.empty(), guides.empty());
    expectSame(levels.update(options), anew);
    guided.setGuides(options);
    expectSame(guided.hierarchy(), anew);
  }
}

TEST(GuidesOfLevel, AStoppedChangeLeavesNoTrace)
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

TEST(GuidesOfLevel, TheSameForAnyNumberOfThreads)
{
  const Mesh mesh = sphere(5);
  HierarchyOptions options;
  options.targetEdgeLength = 0.1;
  options.coarseVertices = 150;
  options.guides = guidesWhere(
    mesh, [](const Vector3& p) { return p.z() > 0.3; }, [](const Vector3&) { return kSlanted; });
  options.threads = 1;
  const Hierarchy one = buildHierarchy(mesh, 1, options);
  EXPECT_FALSE(one.intermediate.guides.empty());
  options.threads = 4;
  expectSame(one, buildHierarchy(mesh, 1, options));
}

TEST(GuidesOfLevel, GuidesOutOfOrderAreRefused)
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
