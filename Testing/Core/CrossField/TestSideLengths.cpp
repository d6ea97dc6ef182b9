// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/CrossField.h"
#include "CrossField/FieldTopology.h"
#include "CrossField/PatchSides.h"
#include "CrossField/PatchStrips.h"
#include "CrossField/SideLengths.h"
#include "CrossField/Turns.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

using namespace quadrille;

namespace
{

constexpr double kLength = 0.5;

/// A rectangle of 8 by 4 whose corners are cut off. Each of its corners has one turn or two: by its angle either will
/// do. The triangles meet in the middle, and triangle i has side i as its first half-edge.
Mesh octagon()
{
  std::vector<Triangle> triangles;
  for (Index i = 0; i < 8; ++i)
  {
    triangles.push_back({ i, (i + 1) % 8, 8 });
  }
  return test::makeMesh({ { 1, 0, 0 }, { 7, 0, 0 }, { 8, 1, 0 }, { 8, 3, 0 }, { 7, 4, 0 },
                          { 1, 4, 0 }, { 0, 3, 0 }, { 0, 1, 0 }, { 4, 2, 0 } },
    triangles);
}

/// With features along its sides, and from its corners to those of one twice as large.
Mesh octagonInOctagon()
{
  const Mesh inner = octagon();
  std::vector<Vector3> points(inner.position.begin(), inner.position.end());
  std::vector<Triangle> triangles;
  for (Index f = 0; f < 8; ++f)
  {
    triangles.push_back({ inner.origin[3 * f], inner.origin[3 * f + 1], inner.origin[3 * f + 2] });
    points.push_back(2 * inner.position[f] - inner.position[8]);
  }
  for (Index i = 0; i < 8; ++i)
  {
    const Index next = (i + 1) % 8;
    triangles.push_back({ i, 9 + i, next });
    triangles.push_back({ next, 9 + i, 9 + next });
  }
  Mesh mesh = test::makeMesh(points, triangles);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index a = std::min(mesh.origin[h], mesh.target(h));
    const Index b = std::max(mesh.origin[h], mesh.target(h));
    const bool isSide = b < 8;
    const bool isSpoke = b == a + 9;
    mesh.flags.edit()[h] = isSide || isSpoke ? kFeatureEdge : 0;
  }
  return mesh;
}

/// The sides of patches with a field that has these turns at the corners of the octagon.
class OctagonSides
{
public:
  /// held: per half-edge or empty, the turns that stay.
  OctagonSides(Mesh mesh, const std::array<int, 8>& turns, std::vector<int> held = {})
    : mesh_(std::move(mesh)), held_(std::move(held)), topology_(buildFieldTopology(mesh_)),
      natural_(naturalTurns(topology_, kLength))
  {
    CrossFieldOptions options;
    options.targetEdgeLength = kLength;
    options.sectorTurns.assign(mesh_.halfEdgeCount(), 0);
    for (Index i = 0; i < 8; ++i)
    {
      options.sectorTurns[3 * i] = turns[i];
    }
    field_ = computeCrossField(mesh_, options);
    for (const Fan& fan : topology_.fans)
    {
      turns_.push_back(fan.sector ? field_.sectorTurns[fan.first] : field_.turns[fan.vertex]);
    }
  }

  const CrossField& field() const { return field_; }
  PatchSides sides() const
  {
    return PatchSides({ mesh_, topology_, turns_, field_.matching, field_.alignment, natural_,
      kLength, held_, valences_ });
  }

private:
  Mesh mesh_;
  std::vector<int> held_;
  std::vector<int> valences_;
  FieldTopology topology_;
  std::vector<double> natural_;
  CrossField field_;
  std::vector<int> turns_;
};

/// Whether any turn moves.
bool changes(const OctagonSides& octagons)
{
  PatchSides sides = octagons.sides();
  PatchStrips strips(sides);
  EXPECT_EQ(strips.find(), 0U);
  SideLengths(sides, strips).evenOut();
  return sides.isAnyChanged();
}

/// A right angle at corners 0, 1, 4 and 7: 6 along u and 9.4 against it, 4.8 along v and 1.4 against it.
constexpr std::array<int, 8> kUneven{ 1, 1, 2, 2, 1, 2, 2, 1 };
/// At 0, 1, 4 and 5: the long sides and what lies between them.
constexpr std::array<int, 8> kEven{ 1, 1, 2, 2, 1, 1, 2, 2 };

} // namespace

TEST(SideLengths, TurnsMoveToWhereOppositeSidesAreAsLong)
{
  const OctagonSides octagons(octagonInOctagon(), kUneven);
  ASSERT_TRUE(octagons.field().status.ok()) << octagons.field().status.message;
  PatchSides sides = octagons.sides();
  PatchStrips strips(sides);
  ASSERT_EQ(strips.find(), 0U);
  SideLengths lengths(sides, strips);
  const double before = lengths.strain();
  lengths.evenOut();
  EXPECT_TRUE(sides.isAnyChanged());
  EXPECT_LT(lengths.strain(), before - 1);
  EXPECT_EQ(strips.find(), 0U);
  const std::vector<int> turns = sides.sectorTurns();
  for (Index i = 0; i < 4; ++i)
  {
    EXPECT_EQ(turns[3 * i], turns[3 * (i + 4)]) << "corner " << i; // opposite sides are alike
  }
}

TEST(SideLengths, EvenSidesStay)
{
  EXPECT_FALSE(changes(OctagonSides(octagonInOctagon(), kEven)));
}

TEST(SideLengths, HeldTurnsStay)
{
  const Mesh mesh = octagonInOctagon();
  std::vector<int> held(mesh.halfEdgeCount(), 0);
  for (Index i = 0; i < 8; ++i)
  {
    held[3 * i] = kUneven[i];
  }
  EXPECT_FALSE(changes(OctagonSides(mesh, kUneven, held)));
}

// All sides that run the same way are stretched by one factor, and those that run against them by its inverse.
TEST(SideLengths, StrainIsWhatEqualSumsNeed)
{
  const OctagonSides octagons(octagon(), kUneven);
  PatchSides sides = octagons.sides();
  PatchStrips strips(sides);
  ASSERT_EQ(strips.find(), 0U);
  const double diagonal = std::sqrt(2.0);
  const auto strainOf = [](double along, double against)
  {
    const double stretch = std::log(std::sqrt(against / along));
    return (along + against) * stretch * stretch / kLength;
  };
  EXPECT_NEAR(SideLengths(sides, strips).strain(),
    strainOf(6, 8 + diagonal) + strainOf(2 + 2 * diagonal, diagonal), 1e-9);
}
