// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/StraightRequests.h"

#include "../TestMeshes.h"
#include "Prepare/Frame.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// The side y = 0 of a plane of 4 by 4 cells.
const StraightRequest kSide{ Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(4, 0, 0) };

TEST(StraightRequests, PartOfTheBoundary)
{
  Mesh mesh = gridPlane(4, 4);
  // Whichever way round faces run, and whichever end is named first.
  for (const bool reversed : { false, true })
  {
    for (const bool swapped : { false, true })
    {
      const StraightRequest request =
        swapped ? StraightRequest{ kSide.to, kSide.via, kSide.from } : kSide;
      const auto parts = findStraightParts(mesh, { request });
      ASSERT_EQ(parts.size(), 1U);
      ASSERT_EQ(parts.front().size(), 4U);
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index h = parts.front()[i];
        EXPECT_TRUE(mesh.isBoundary(h));
        EXPECT_EQ(mesh.position[mesh.origin[h]].y(), 0);
        EXPECT_EQ(mesh.position[mesh.target(h)].y(), 0);
        EXPECT_TRUE(i == 0 || mesh.origin[h] == mesh.target(parts.front()[i - 1]));
      }
    }
    if (!reversed)
    {
      reverseFaces(mesh);
    }
  }
  const std::vector<Index> vertices = straightVertices(mesh, { kSide });
  ASSERT_EQ(vertices.size(), 3U);
  EXPECT_TRUE(std::is_sorted(vertices.begin(), vertices.end()));
  EXPECT_TRUE(findStraightParts(sphere(1), { kSide }).front().empty()); // no boundary
}

TEST(StraightRequests, TurnsOfItsSectors)
{
  Mesh mesh = gridPlane(4, 4);
  const auto parts = findStraightParts(mesh, { kSide });
  const std::vector<int> turns = straightSectors(mesh, parts, {});
  ASSERT_EQ(turns.size(), mesh.halfEdgeCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const bool asked = mesh.isBoundary(h) && p.y() == 0;
    const bool isEnd = p.x() == 0 || p.x() == 4;
    EXPECT_EQ(turns[h], !asked ? 0 : isEnd ? 1 : 2);
  }
  // A feature that ends in the part divides it; where two end nothing is asked.
  const auto mark = [&](const Vector3& from)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& a = mesh.position[mesh.origin[h]];
      const Vector3& b = mesh.position[mesh.target(h)];
      if (!mesh.isBoundary(h) && a == from && b.y() == 1 && b.x() == from.x())
      {
        mesh.flags.edit()[h] |= kFeatureEdge;
        mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
      }
    }
  };
  mark({ 2, 0, 0 });
  const std::vector<int> divided = straightSectors(mesh, parts, {});
  int sum = 0, sectors = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool here = mesh.position[mesh.origin[h]] == Vector3(2, 0, 0);
    sum += here ? divided[h] : 0;
    sectors += here && divided[h] != 0 ? 1 : 0;
  }
  EXPECT_EQ(sum, 2);
  EXPECT_EQ(sectors, 2);
}

TEST(StraightRequests, MovesAPartOutward)
{
  StraightRequest side = kSide;
  side.outward = Vector3(0, -1, 0);
  const Mesh before =
    withSizes(gridPlane(4, 4), [](const Vector3& p) { return p.x() < 2 ? 0.5 : 1; });
  const OutsetMesh outset = withOutset(before, { side }, 0.3);
  const Mesh& after = outset.mesh;
  for (Index v = 0; v < before.vertexCount(); ++v)
  {
    const Vector3& p = before.position[v];
    const double length = p.y() > 0 ? 0 : p.x() < 2 ? 0.15 : 0.3;
    EXPECT_LT((after.position[v] - p - length * side.outward).norm(), 1e-7); // sizes are floats
  }
  EXPECT_EQ(findStraightParts(after, outset.requests), findStraightParts(before, { side }));
}

TEST(StraightRequests, ALoopIsStraightEverywhere)
{
  const Mesh mesh = openCylinder(12, 4);
  const double low = std::min_element(mesh.position.begin(), mesh.position.end(),
    [](const Vector3& a, const Vector3& b) {
      return a.z() < b.z();
    })->z();
  const auto at = std::find_if(
    mesh.position.begin(), mesh.position.end(), [&](const Vector3& p) { return p.z() == low; });
  const auto parts = findStraightParts(mesh, { { *at, *at, *at } });
  EXPECT_EQ(parts.front().size(), 12U);
  const std::vector<int> turns = straightSectors(mesh, parts, {});
  EXPECT_EQ(std::count(turns.begin(), turns.end(), 2), 12);
  EXPECT_EQ(std::count(turns.begin(), turns.end(), 0),
    static_cast<std::ptrdiff_t>(mesh.halfEdgeCount()) - 12);
}

} // namespace
} // namespace quadrille
