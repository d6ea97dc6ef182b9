// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/SizeCones.h"

#include "CrossField/CrossField.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Turns per fan of a mesh whose fans are whole rings or straight sectors, with a few changed by vertex.
std::vector<int> turnsWith(
  const FieldTopology& topology, const std::vector<std::pair<Index, int>>& irregular)
{
  std::vector<int> turns;
  for (const Fan& fan : topology.fans)
  {
    turns.push_back(fan.sector ? static_cast<int>(std::lround(fan.angle / (kPi / 2))) : 4);
    for (const auto& [v, t] : irregular)
    {
      turns.back() = fan.vertex == v ? t : turns.back();
    }
  }
  return turns;
}

TEST(SizeCones, FlatSurfaceOfOneSizeHasNoError)
{
  Mesh mesh = gridPlane(12, 12);
  const FieldTopology topology = buildFieldTopology(mesh);
  EXPECT_NEAR(sizeError(mesh, topology, turnsWith(topology, {})), 0, 1e-9);
  EXPECT_TRUE(valencesForSizes(mesh, topology, turnsWith(topology, {}), {}).empty());
}

TEST(SizeCones, LinearGrowthOnAStripIsTheErrorOfItsRegularMap)
{
  // Without irregular vertices a map of a strip has one size only in the middle of which the logarithms of the sizes
  // lie.
  const auto size = [](const Vector3& p) { return std::exp(0.05 * p.x()); };
  const Mesh mesh = withSizes(gridPlane(40, 10), size);
  const FieldTopology topology = buildFieldTopology(mesh);
  // The area in sizes is exp(-0.1 x) dx: the spread of 0.05 x under that weight.
  double sum = 0, mean = 0, square = 0;
  for (double x = 0.005; x < 40; x += 0.01)
  {
    const double w = std::exp(-0.1 * x);
    sum += w;
    mean += w * 0.05 * x;
    square += w * 0.0025 * x * x;
  }
  const double spread = std::sqrt(square / sum - mean * mean / (sum * sum));
  EXPECT_NEAR(sizeError(mesh, topology, turnsWith(topology, {})), spread, 0.02 * spread);
}

TEST(SizeCones, IrregularVerticesAreAddedInPairsAndStayApart)
{
  const Mesh mesh =
    withSizes(gridPlane(40, 20), [](const Vector3& p) { return p.x() > 20 ? 1.0 : 0.5; });
  const FieldTopology topology = buildFieldTopology(mesh);
  const std::vector<int> before = turnsWith(topology, {});
  const std::vector<int> targets = valencesForSizes(mesh, topology, before, {});
  ASSERT_EQ(targets.size(), mesh.position.size());
  int sum = 0;
  std::vector<std::pair<Index, int>> irregular;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (targets[v] != 0 && targets[v] != 4)
    {
      sum += targets[v] - 4;
      irregular.emplace_back(v, targets[v]);
    }
  }
  EXPECT_GE(irregular.size(), 2U);
  EXPECT_EQ(sum, 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const auto isIrregular = [&](Index v) { return targets[v] != 0 && targets[v] != 4; };
    EXPECT_FALSE(isIrregular(mesh.origin[h]) && isIrregular(mesh.target(h)));
  }
  EXPECT_LT(sizeError(mesh, topology, turnsWith(topology, irregular)),
    0.5 * sizeError(mesh, topology, before));
}

TEST(SizeCones, ASmallPlaceIsWorthIrregularVerticesByItsQuads)
{
  const auto sizeAt = [](const Vector3& p)
  { return std::min(1.0, 0.5 + 0.25 * std::max((p - Vector3(30, 30, 0)).norm() - 4, 0.0)); };
  const Mesh mesh = withSizes(gridPlane(60, 60), sizeAt);
  const FieldTopology topology = buildFieldTopology(mesh);
  const std::vector<int> before = turnsWith(topology, {});
  const auto irregularOf = [](const std::vector<int>& targets)
  { return std::count_if(targets.begin(), targets.end(), [](int t) { return t != 0 && t != 4; }); };
  const auto byShare = irregularOf(valencesForSizes(mesh, topology, before, {}));
  const auto byQuads =
    irregularOf(valencesForSizes(mesh, topology, before, {}, { SizeWish::AtPlaces, 3600 }));
  EXPECT_GT(byQuads, byShare);
}

TEST(SizeCones, TurnsStayWhereNoOtherSizeIsAskedFor)
{
  const Vector3 place(30, 30, 0);
  const auto sizeAt = [&](const Vector3& p)
  { return std::min(1.0, 0.5 + 0.25 * std::max((p - place).norm() - 4, 0.0)); };
  const Mesh mesh = withSizes(gridPlane(60, 60), sizeAt);
  const FieldTopology topology = buildFieldTopology(mesh);
  // A pair far from the place, which stands in the way of equal sizes and would be taken away.
  std::vector<std::pair<Index, int>> pair;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const Vector3& p = mesh.position[v];
    const bool isThree = (p - Vector3(10, 10, 0)).norm() < 0.1;
    if (isThree || (p - Vector3(10, 30, 0)).norm() < 0.1)
    {
      pair.emplace_back(v, isThree ? 3 : 5);
    }
  }
  ASSERT_EQ(pair.size(), 2U);
  const std::vector<int> before = turnsWith(topology, pair);
  const std::vector<int> anywhere = valencesForSizes(mesh, topology, before, {});
  EXPECT_EQ(anywhere[pair[0].first], 4);
  const std::vector<int> there =
    valencesForSizes(mesh, topology, before, {}, { SizeWish::AtPlaces, 3600 });
  std::size_t moved = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const bool isSector = there[v] == 0;
    const int wanted = v == pair[0].first ? 3 : v == pair[1].first ? 5 : 4;
    EXPECT_TRUE(isSector || mesh.sizing[v] != 1 || there[v] == wanted);
    moved += !isSector && there[v] != wanted ? 1 : 0;
  }
  EXPECT_GE(moved, 2U);
}

TEST(SizeCones, TargetsOfTheUserStay)
{
  const Mesh mesh =
    withSizes(gridPlane(40, 20), [](const Vector3& p) { return p.x() > 20 ? 1.0 : 0.5; });
  const FieldTopology topology = buildFieldTopology(mesh);
  std::vector<int> asked(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    asked[v] = mesh.position[v].x() > 15 && mesh.position[v].x() < 35 ? 4 : 0;
  }
  const std::vector<int> targets = valencesForSizes(mesh, topology, turnsWith(topology, {}), asked);
  ASSERT_EQ(targets.size(), asked.size());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    EXPECT_TRUE(asked[v] == 0 || targets[v] == asked[v]);
  }
}

/// Between the sides of a patch a pair has to fit these, on a surface without any it may be anywhere.
TEST(SizeCones, SizesThatNobodyAskedForMoveTurnsWhereNoSideIs)
{
  const auto sizes = [](const Vector3& p) { return p.x() > 0 ? 1.0 : 0.3; };
  const Mesh closed = withSizes(torus(60, 24, 1, 0.4), sizes);
  const FieldTopology topology = buildFieldTopology(closed);
  const std::vector<int> before = turnsWith(topology, {});
  EXPECT_FALSE(valencesForSizes(closed, topology, before, {}, { SizeWish::None }).empty());

  const Mesh open =
    withSizes(gridPlane(40, 20), [](const Vector3& p) { return p.x() > 20 ? 1.0 : 0.3; });
  const FieldTopology ofOpen = buildFieldTopology(open);
  const std::vector<int> regular = turnsWith(ofOpen, {});
  EXPECT_FALSE(valencesForSizes(open, ofOpen, regular, {}, { SizeWish::Everywhere }).empty());
  EXPECT_TRUE(valencesForSizes(open, ofOpen, regular, {}, { SizeWish::None }).empty());
}

TEST(SizeCones, FieldTakesThem)
{
  const Mesh mesh =
    withSizes(gridPlane(40, 20), [](const Vector3& p) { return p.x() > 20 ? 1.0 : 0.5; });
  CrossFieldOptions options;
  options.targetEdgeLength = 2;
  const auto irregularOf = [&](SizeWish sizes)
  {
    options.sizes = sizes;
    const CrossField field = computeCrossField(mesh, options);
    EXPECT_TRUE(field.status.ok()) << field.status.message;
    return std::count_if(
      field.turns.begin(), field.turns.end(), [](int t) { return t == 3 || t == 5; });
  };
  EXPECT_GE(irregularOf(SizeWish::Everywhere), 2);
  EXPECT_EQ(irregularOf(SizeWish::None), 0);
  const CrossField plain = computeCrossField(gridPlane(40, 20), options);
  EXPECT_EQ(std::count(plain.turns.begin(), plain.turns.end(), 5), 0);
}

/// Parts without number, some of them so small that a share of the whole area is nothing, and a triangle without area.
TEST(SizeCones, TinyComponentsAndDegenerateTrianglesHaveAFactorToo)
{
  Mesh mesh = gridPlane(12, 12);
  Mesh speck = gridPlane(3, 3);
  for (Vector3& p : speck.position.editAll())
  {
    p *= 1e-7;
  }
  speck.position.edit()[5] = 0.5 * (speck.position[4] + speck.position[6]);
  speck.position.edit()[9] = speck.position[5];
  for (int i = 0; i < 5; ++i)
  {
    mesh = disjointUnion(mesh, speck, Vector3(20 + i, 0, 0));
  }
  mesh = withSizes(mesh, [](const Vector3& p) { return p.x() < 6 ? 1.0 : 0.5; });
  const FieldTopology topology = buildFieldTopology(mesh);
  const double error = sizeError(mesh, topology, turnsWith(topology, {}));
  EXPECT_TRUE(std::isfinite(error));
  // As large as without them, as they have no area.
  const Mesh alone =
    withSizes(gridPlane(12, 12), [](const Vector3& p) { return p.x() < 6 ? 1.0 : 0.5; });
  const FieldTopology own = buildFieldTopology(alone);
  EXPECT_NEAR(error, sizeError(alone, own, turnsWith(own, {})), 1e-3);
}

} // namespace
} // namespace quadrille
