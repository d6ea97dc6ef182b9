// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Angles.h"
#include "Base/TryCount.h"
#include "GridMap/GridMap.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

using namespace quadrille;

namespace
{

constexpr int kAround = 24;
constexpr int kAlong = 12;
constexpr double kHeight = 2;

/// A tube with features along it, one in four columns, which turn by twice `angle` at half of its height: between each
/// two of them lies a chevron.
Mesh chevrons(double angle)
{
  Mesh mesh = test::openCylinder(kAround, kAlong, 1, kHeight);
  const auto column = [&](const Vector3& p)
  { return std::lround(std::atan2(p.y(), p.x()) / (2 * kPi) * kAround); };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const long from = column(mesh.position[mesh.origin[h]]);
    const long to = column(mesh.position[mesh.target(h)]);
    mesh.flags.edit()[h] = from == to && from % 4 == 0 ? kFeatureEdge : 0;
  }
  for (Vector3& p : mesh.position.editAll())
  {
    const double along = kHeight / 2 - std::abs(p.z() - kHeight / 2);
    const double around = std::atan2(p.y(), p.x()) + along * std::tan(angle);
    p.x() = std::cos(around);
    p.y() = std::sin(around);
  }
  return mesh;
}

struct Mapped
{
  GridMapResult map;
  std::size_t tries = 0;
};

Mapped mapOf(const Mesh& mesh)
{
  const TryScope scope;
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = 200;
  Mapped mapped;
  mapped.map = computeGridMap(mesh, options);
  mapped.tries = scope.counts().taken[static_cast<std::size_t>(Try::TurnsForStrips)];
  return mapped;
}

} // namespace

// By their angles chevrons would have three turns at the one corner in the middle and one at the other. Then each is
// longer on its one side by its own width, and all round the tube widths sum up to nothing.
TEST(PatchStrips, ChevronsAllRoundHaveAMap)
{
  const Mesh mesh = chevrons(0.5);
  const Mapped mapped = mapOf(mesh);
  ASSERT_TRUE(mapped.map.status.ok()) << mapped.map.status.message;
  EXPECT_TRUE(mapped.map.certificate.valid());
  EXPECT_GE(mapped.tries, 1U);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isFeature(h) && std::abs(mesh.position[mesh.origin[h]].z() - kHeight / 2) < 1e-9)
    {
      EXPECT_EQ(mapped.map.field.sectorTurns[h], 2);
    }
  }
}

TEST(PatchStrips, WhereAllSidesHaveStripsNothingChanges)
{
  const Mapped mapped = mapOf(chevrons(0.1));
  EXPECT_TRUE(mapped.map.status.ok());
  EXPECT_EQ(mapped.tries, 0U);
}
