// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/DrawnLines.h"

#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "Requests/InsertPlaces.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace quadrille
{
namespace
{

using namespace test;

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

/// With lines as features; they get their course on it.
Mesh cubeWith(std::vector<CurveRequest>& lines)
{
  PrepareOptions options;
  options.featureAngle = kPi / 4;
  PreparedSurface surface = prepareSurface(toInput(unitCube(4)), options);
  std::vector<std::string> notices;
  std::vector<FeatureRequest> features;
  addFeatures(lines, CurveKind::Cycle, features);
  addFeatures(lines, CurveKind::Connection, features);
  const auto paths = insertFeatures(surface, features, { 0.2, 1 }, notices);
  EXPECT_TRUE(notices.empty());
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    lines[i].points = paths[i];
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

TEST(DrawnLines, StraightOnFacesAndAcrossFeatures)
{
  std::vector<CurveRequest> cycles{ roundCube(0.3, 0.2) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<int> turns = straightAlong(mesh, cycles, {});
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
  EXPECT_TRUE(isStraightAlong(mesh, cycles[0], found));
  *std::find(found.begin(), found.end(), 2) = 3;
  EXPECT_FALSE(isStraightAlong(mesh, cycles[0], found));
  // Where there is none.
  EXPECT_FALSE(isStraightAlong(mesh, roundCube(0.8, 0), found));
}

TEST(DrawnLines, TwoThatCross)
{
  std::vector<CurveRequest> cycles{ roundCube(0.2, 0.6), roundCube(0.5, 0) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<int> turns = straightAlong(mesh, cycles, {});
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

TEST(DrawnLines, WhatIsAskedForStays)
{
  std::vector<CurveRequest> cycles{ roundCube(0.3, 0) };
  const Mesh mesh = cubeWith(cycles);
  const std::vector<int> free = straightAlong(mesh, cycles, {});
  std::vector<int> asked(mesh.halfEdgeCount(), 0);
  const auto h = static_cast<std::size_t>(std::find(free.begin(), free.end(), 2) - free.begin());
  asked[h] = 3;
  EXPECT_EQ(straightAlong(mesh, cycles, asked)[h], 3);
}

/// From a place on the front, where `ends` says what is there, over the edge x = y = 1 to one on the right.
CurveRequest overTheEdge(const std::array<int, 2>& ends)
{
  CurveRequest connection{ CurveKind::Connection,
    { { 0.3, 0, 0.4 }, { 1, 0, 0.5 }, { 1, 0.7, 0.6 } } };
  connection.ends = ends;
  return connection;
}

TEST(DrawnLines, AConnectionIsStraightButForItsEnds)
{
  std::vector<CurveRequest> lines{ overTheEdge({ 3, 5 }) };
  const Mesh mesh = cubeWith(lines);
  const EdgesOfLine edges = edgesOfLine(mesh, lines[0]);
  const std::vector<int> turns = straightAlong(mesh, lines, {});
  std::size_t ends = 0, across = 0, along = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (edges.edges[h] == 0)
    {
      continue;
    }
    const Index v = mesh.origin[h];
    const Vector3& p = mesh.position[v];
    const std::multiset<int> there = turnsAt(mesh, v, turns);
    if ((p - lines[0].points.front()).norm() < 1e-9 || (p - lines[0].points.back()).norm() < 1e-9)
    {
      ++ends;
      EXPECT_EQ(edges.ends[v], 1);
      EXPECT_EQ(there, std::multiset<int>{ 0 });
      continue;
    }
    EXPECT_EQ(edges.ends[v], 0);
    (isOnEdgeOfCube(p) ? across : along) += 1;
    EXPECT_EQ(
      there, (isOnEdgeOfCube(p) ? std::multiset<int>{ 1, 1, 1, 1 } : std::multiset<int>{ 2, 2 }));
  }
  EXPECT_EQ(ends, 2U);
  EXPECT_EQ(across, 2U); // half-edges
  EXPECT_GE(along, 4U);
}

TEST(DrawnLines, OneThatEndsOnAnotherLeavesThatStraight)
{
  CurveRequest below = roundCube(0.3, 0);
  CurveRequest to{ CurveKind::Connection, { { 0.5, 0, 0.3 }, { 0.5, 0, 0.8 } } };
  to.ends = { 0, 3 };
  std::vector<CurveRequest> lines{ below, to };
  const Mesh mesh = cubeWith(lines);
  const std::vector<int> turns = straightAlong(mesh, lines, {});
  std::size_t ends = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if ((mesh.position[v] - Vector3(0.5, 0, 0.3)).norm() < 1e-9)
    {
      ++ends;
      EXPECT_EQ(turnsAt(mesh, v, turns), (std::multiset<int>{ 1, 1, 2 }));
    }
  }
  EXPECT_EQ(ends, 1U);
}

TEST(DrawnLines, AConnectionWhoseEndsAreNotKnownIsNone)
{
  CurveRequest connection = overTheEdge({ 3, 5 });
  connection.ends.reset();
  EXPECT_FALSE(hasLines({ connection }));
  EXPECT_TRUE(hasLines({ connection, roundCube(0.5, 0) }));
  std::vector<FeatureRequest> features;
  addFeatures({ connection }, CurveKind::Connection, features);
  EXPECT_TRUE(features.empty());
  connection.setEnds({ 0.2, 0, 0.4 }, { 1, 0.8, 0.6 }, { 0, 5 });
  addFeatures({ connection }, CurveKind::Connection, features);
  ASSERT_EQ(features.size(), 1U);
  EXPECT_EQ(features[0].points.front(), Vector3(0.2, 0, 0.4));
  EXPECT_EQ(features[0].points.back(), Vector3(1, 0.8, 0.6));
}

} // namespace
} // namespace quadrille
