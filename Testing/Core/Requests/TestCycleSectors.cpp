// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/CycleSectors.h"

#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "Requests/InsertPlaces.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quadrille
{
namespace
{

using namespace test;

constexpr double kOnCourse = 1e-9;

/// Round a cube, upright or not.
CurveRequest roundCube(double height, double slant)
{
  CurveRequest cycle{ CurveKind::Cycle, {} };
  for (const auto& [x, y] : { std::pair(0.0, 0.0), { 0.5, 0.0 }, { 1.0, 0.0 }, { 1.0, 0.5 },
         { 1.0, 1.0 }, { 0.5, 1.0 }, { 0.0, 1.0 }, { 0.0, 0.5 } })
  {
    cycle.points.emplace_back(x, y, height + slant * x);
  }
  return cycle;
}

/// With cycles as features; they get their course on it.
Mesh cubeWith(std::vector<CurveRequest>& cycles)
{
  PrepareOptions options;
  options.featureAngle = kPi / 4;
  PreparedSurface surface = prepareSurface(toInput(unitCube(4)), options);
  std::vector<std::string> notices;
  const auto paths = insertFeatures(surface, featuresWithCycles({}, cycles), { 0.2, 1 }, notices);
  EXPECT_TRUE(notices.empty());
  for (std::size_t i = 0; i < cycles.size(); ++i)
  {
    cycles[i].points = paths[i];
  }
  return surface.mesh;
}

/// Of the sectors at a vertex.
std::multiset<int> turnsAt(const Mesh& mesh, Index v, const std::vector<int>& sectorTurns)
{
  std::multiset<int> turns;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.origin[h] == v && mesh.isConstrained(h))
    {
      turns.insert(sectorTurns[h]);
    }
  }
  return turns;
}

bool isOnEdgeOfCube(const Vector3& p)
{
  const auto isAtEnd = [](double x) { return std::abs(x) < 1e-9 || std::abs(x - 1) < 1e-9; };
  return isAtEnd(p.x()) && isAtEnd(p.y());
}

TEST(CycleSectors, StraightOnFacesAndAcrossFeatures)
{
  std::vector<CurveRequest> cycles{ roundCube(0.3, 0.2) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<std::uint8_t> edges = edgesOfCycles(mesh, cycles, kOnCourse);
  const std::vector<int> turns = straightAlong(mesh, edges, {});
  std::size_t across = 0, along = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const Vector3& p = mesh.position[v];
    if (std::abs(p.z() - 0.3 - 0.2 * p.x()) > 1e-9)
    {
      const std::multiset<int> elsewhere = turnsAt(mesh, v, turns);
      EXPECT_EQ(elsewhere.count(0), elsewhere.size());
      continue;
    }
    const bool crosses = isOnEdgeOfCube(p);
    (crosses ? across : along) += 1;
    EXPECT_EQ(turnsAt(mesh, v, turns),
      (crosses ? std::multiset<int>{ 1, 1, 1, 1 } : std::multiset<int>{ 2, 2 }));
  }
  EXPECT_EQ(across, 4U);
  EXPECT_GE(along, 4U);
  // As a field would have it, and otherwise.
  std::vector<std::int8_t> found(turns.begin(), turns.end());
  EXPECT_TRUE(isStraightAlong(mesh, edges, found));
  *std::find(found.begin(), found.end(), 2) = 3;
  EXPECT_FALSE(isStraightAlong(mesh, edges, found));
  // Where there is none.
  const std::vector<std::uint8_t> none = edgesOfCycles(mesh, { roundCube(0.8, 0) }, kOnCourse);
  EXPECT_EQ(std::count(none.begin(), none.end(), 0), static_cast<std::ptrdiff_t>(none.size()));
  EXPECT_FALSE(isStraightAlong(mesh, none, found));
}

TEST(CycleSectors, TwoThatCross)
{
  std::vector<CurveRequest> cycles{ roundCube(0.2, 0.6), roundCube(0.5, 0) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<int> turns = straightAlong(mesh, edgesOfCycles(mesh, cycles, kOnCourse), {});
  std::size_t crossings = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const Vector3& p = mesh.position[v];
    if ((p - Vector3(0.5, p.y(), 0.5)).norm() < 1e-9)
    {
      ++crossings;
      EXPECT_EQ(turnsAt(mesh, v, turns), (std::multiset<int>{ 1, 1, 1, 1 }));
    }
  }
  EXPECT_EQ(crossings, 2U);
}

TEST(CycleSectors, WhatIsAskedForStays)
{
  std::vector<CurveRequest> cycles{ roundCube(0.3, 0) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<std::uint8_t> edges = edgesOfCycles(mesh, cycles, kOnCourse);
  const std::vector<int> free = straightAlong(mesh, edges, {});
  std::vector<int> asked(mesh.halfEdgeCount(), 0);
  const auto h = static_cast<std::size_t>(std::find(free.begin(), free.end(), 2) - free.begin());
  asked[h] = 3;
  EXPECT_EQ(straightAlong(mesh, edges, asked)[h], 3);
}

} // namespace
} // namespace quadrille
