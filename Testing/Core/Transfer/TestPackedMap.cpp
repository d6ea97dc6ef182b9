// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/PackedMap.h"

#include <gtest/gtest.h>

#include <random>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

std::vector<FixedVec2> continuousMap(const Mesh& mesh)
{
  return mapByPosition(mesh, [](const Vector3& p) { return Vector2(2 * p.x(), 3 * p.y()); });
}

} // namespace

TEST(PackedMap, AMapWithoutCutsNeedsAQuarter)
{
  const Mesh mesh = gridPlane(60, 50);
  const std::vector<FixedVec2> uv = continuousMap(mesh);
  const PackedMap packed(mesh, uv);
  EXPECT_EQ(packed.unpack(mesh), uv);
  EXPECT_EQ(packed.bytes(), sizeof(FixedVec2) * mesh.vertexCount());
  EXPECT_LT(5 * packed.bytes(), sizeof(FixedVec2) * uv.size());
}

TEST(PackedMap, EveryCornerMayHaveItsOwnImage)
{
  const Mesh mesh = torus(30, 20);
  std::mt19937_64 random(7);
  std::vector<FixedVec2> uv = continuousMap(mesh);
  for (std::size_t h = 0; h < uv.size(); h += 1 + random() % 9)
  {
    uv[h] = { static_cast<std::int64_t>(random() >> 20),
      -static_cast<std::int64_t>(random() >> 20) };
  }
  EXPECT_EQ(PackedMap(mesh, uv).unpack(mesh), uv);
  for (FixedVec2& p : uv)
  {
    p = { static_cast<std::int64_t>(random() >> 20), static_cast<std::int64_t>(random() >> 20) };
  }
  EXPECT_EQ(PackedMap(mesh, uv).unpack(mesh), uv);
}

TEST(PackedMap, RefusesTheMapOfAnotherMesh)
{
  const Mesh mesh = gridPlane(4, 4);
  const Mesh other = gridPlane(5, 4);
  EXPECT_THROW(PackedMap(other, continuousMap(mesh)), InvalidInput);
  EXPECT_THROW(PackedMap(mesh, continuousMap(mesh)).unpack(other), InvalidInput);
}
