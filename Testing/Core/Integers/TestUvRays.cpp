// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/UvRays.h"

#include "CrossField/CrossField.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

namespace quadrille
{
namespace
{

/// A plane of n by n unit squares whose inner vertices are moved, by so little that no triangle turns over.
Mesh wavyPlane(int n, unsigned seed)
{
  Mesh mesh = test::gridPlane(n, n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-0.2, 0.2);
  for (Vector3& p : mesh.position.editAll())
  {
    if (p.x() > 0 && p.x() < n && p.y() > 0 && p.y() < n)
    {
      p += Vector3(offset(random), offset(random), 0);
    }
  }
  return mesh;
}

/// Each vertex at its place.
UvMesh mapByPlace(const Mesh& mesh)
{
  CrossField field;
  field.matching.assign(mesh.halfEdgeCount(), 0);
  std::vector<FixedVec2> uv;
  for (const Index v : mesh.origin)
  {
    uv.push_back(toFixed(Vector2(mesh.position[v].head<2>())));
  }
  return UvMesh::from(mesh, field, uv);
}

Index vertexAt(const Mesh& mesh, double x, double y)
{
  Index v = 0;
  while ((mesh.position[v] - Vector3(x, y, 0)).norm() > 1e-9)
  {
    ++v;
  }
  return v;
}

TEST(UvRays, AxesOfAPlaneMeetTheNeighbours)
{
  const Mesh mesh = test::gridPlane(6, 6);
  const UvMesh map = mapByPlace(mesh);
  const Index v = vertexAt(mesh, 3, 3);
  const std::vector<UvDirection> directions = axisDirections(map, v);
  ASSERT_EQ(directions.size(), 4U);
  for (const UvDirection& direction : directions)
  {
    const UvRay ray = followLine(map, direction, 10 * kOne, false);
    ASSERT_TRUE(ray.meetsVertex());
    EXPECT_EQ(ray.length, kOne);
    const Vector3 step = mesh.position[map.origin[ray.end.corner]] - mesh.position[v];
    const FixedVec2 unit = rotate(FixedVec2{ 1, 0 }, direction.axis);
    EXPECT_EQ(step, Vector3(static_cast<double>(unit.u), static_cast<double>(unit.v), 0));
  }
}

TEST(UvRays, GoStraightOnUpToTheBoundary)
{
  const Mesh mesh = test::gridPlane(6, 6);
  const UvMesh map = mapByPlace(mesh);
  for (UvDirection direction : axisDirections(map, vertexAt(mesh, 2, 3)))
  {
    std::int64_t length = 0;
    for (std::optional<UvDirection> on = direction; on;)
    {
      const UvRay ray = followLine(map, *on, 10 * kOne, false);
      ASSERT_TRUE(ray.meetsVertex());
      length += ray.length;
      on = straightOn(map, ray.end);
    }
    const double expected[] = { 4, 3, 2, 3 }; // to x = 6, y = 6, x = 0, y = 0
    EXPECT_EQ(toDouble(length), expected[direction.axis]);
  }
}

TEST(UvRays, EndAtACurve)
{
  Mesh mesh = test::gridPlane(6, 6);
  UvMesh map = mapByPlace(mesh);
  // From the middle of nowhere: no other vertex has this y.
  const Index v = vertexAt(mesh, 3, 3);
  for (Index h = 0; h < map.origin.size(); ++h)
  {
    map.uv[h].v += map.origin[h] == v ? kOne / 3 : 0;
  }
  for (const UvDirection& direction : axisDirections(map, v))
  {
    if (direction.axis % 2 == 0)
    {
      const UvRay ray = followLine(map, direction, 10 * kOne, true);
      EXPECT_FALSE(ray.meetsVertex());
      ASSERT_NE(ray.curve, kInvalidIndex);
      EXPECT_EQ(map.twin[ray.curve], kInvalidIndex);
      EXPECT_EQ(map.uv[ray.curve].u, direction.axis == 0 ? 6 * kOne : 0);
    }
  }
}

TEST(UvRays, EdgesAlongLinesComeByFlipsAndGoByTheirUndoing)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    Mesh mesh = wavyPlane(8, seed);
    // Two vertices on a line that no other one lies on, across seven columns.
    const Index a = 4 * 9 + 1, b = 4 * 9 + 7;
    mesh.position.edit()[a].y() = mesh.position.edit()[b].y() = 4.137;
    UvMesh map = mapByPlace(mesh);
    const std::vector<FixedVec2> before = map.uv;
    const std::vector<Index> twins = map.twin;
    const auto directions = axisDirections(map, a);
    const auto east = std::find_if(directions.begin(), directions.end(),
      [](const UvDirection& direction) { return direction.axis == 0; });
    ASSERT_NE(east, directions.end());
    const std::int64_t length = map.uv[map.outgoing[b]].u - map.uv[map.outgoing[a]].u;
    const UvRay ray = followLine(map, *east, length, true);
    ASSERT_TRUE(ray.meetsVertex());
    EXPECT_EQ(map.origin[ray.end.corner], b);
    EXPECT_EQ(ray.length, length);
    EXPECT_GE(ray.crossed.size(), 5U);

    UvEditor editor(map);
    const std::optional<UvDirection> edge = makeEdgeAlong(map, editor, *east, length);
    ASSERT_TRUE(edge) << "seed " << seed;
    EXPECT_EQ(map.origin[edge->corner], a);
    EXPECT_EQ(map.target(edge->corner), b);
    EXPECT_EQ(map.vector(edge->corner), (FixedVec2{ length, 0 }));
    for (Index f = 0; f < map.alive.size(); ++f)
    {
      EXPECT_GT(map.faceDeterminant(f), 0) << "seed " << seed << ", face " << f;
    }
    editor.undoTo(0, std::vector<std::uint8_t>(map.outgoing.size(), 1));
    EXPECT_TRUE(map.uv == before);
    EXPECT_TRUE(map.twin == twins);
  }
}

} // namespace
} // namespace quadrille
