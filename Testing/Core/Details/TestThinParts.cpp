// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/ThinParts.h"

#include "Mesh/Topology.h"
#include "SurfaceInputs.h"

#include <cmath>

namespace quadrille
{
namespace
{

/// Of the three edges that the thin part is behind: an equilateral triangle in the plane x + y + z = 1, with its
/// corners so far along the axes from its foot.
constexpr double kRing = 0.05;

/// Rings of three points along the direction (1, 1, 1), joined by two triangles for each edge.
class Tower
{
public:
  explicit Tower(SurfaceInput& input) : input_(input) {}

  Index point(const Vector3& p)
  {
    input_.points.push_back(p);
    return static_cast<Index>(input_.points.size() - 1);
  }

  void face(Index a, Index b, Index c)
  {
    for (const Index v : { a, b, c })
    {
      input_.polygonPoints.push_back(v);
    }
    input_.polygonOffsets.push_back(static_cast<Index>(input_.polygonPoints.size()));
  }

  /// Round the point `sum` / 3 on every axis, counterclockwise as seen from outside.
  std::array<Index, 3> ring(double sum, double size)
  {
    const Vector3 middle = Vector3::Constant(sum / 3);
    return { point(middle + size * Vector3(1, 0, 0)), point(middle + size * Vector3(0, 1, 0)),
      point(middle + size * Vector3(0, 0, 1)) };
  }

  void join(const std::array<Index, 3>& lower, const std::array<Index, 3>& upper)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::size_t j = (i + 1) % 3;
      face(lower[i], lower[j], upper[j]);
      face(lower[i], upper[j], upper[i]);
    }
  }

private:
  SurfaceInput& input_;
};

/// An octahedron, one face of which is open, and the three corners of that face.
std::array<Index, 3> addOctahedron(Tower& tower, const Vector3& middle, double sign)
{
  std::array<Index, 3> up{}, down{};
  for (int axis = 0; axis < 3; ++axis)
  {
    up[static_cast<std::size_t>(axis)] = tower.point(middle + sign * Vector3::Unit(axis));
    down[static_cast<std::size_t>(axis)] = tower.point(middle - sign * Vector3::Unit(axis));
  }
  const auto corner = [&](int axis, int bits)
  {
    return (bits >> axis & 1) != 0 ? down[static_cast<std::size_t>(axis)]
                                   : up[static_cast<std::size_t>(axis)];
  };
  for (int bits = 1; bits < 8; ++bits)
  {
    const bool odd = ((bits >> 2) + (bits >> 1 & 1) + (bits & 1)) % 2 == 1;
    const bool turned = odd != (sign < 0);
    tower.face(corner(0, bits), corner(turned ? 2 : 1, bits), corner(turned ? 1 : 2, bits));
  }
  return up;
}

/// An octahedron with a drop on a stalk in the middle of a face: 15 faces behind the foot of the stalk.
SurfaceInput withDrop()
{
  SurfaceInput input;
  input.polygonOffsets = { 0 };
  Tower tower(input);
  const std::array<Index, 3> open = addOctahedron(tower, Vector3::Zero(), 1);
  const std::array<Index, 3> foot = tower.ring(1 - kRing, kRing);
  const std::array<Index, 3> neck = tower.ring(1.3, kRing);
  const std::array<Index, 3> wide = tower.ring(1.5, 3 * kRing);
  const Index tip = tower.point(Vector3::Constant(0.7));
  const std::array<Index, 3> round = tower.ring(1 - 4 * kRing, 4 * kRing);
  tower.join(open, round); // so that there are more faces outside than behind the foot
  tower.join(round, foot);
  tower.join(foot, neck);
  tower.join(neck, wide);
  for (std::size_t i = 0; i < 3; ++i)
  {
    tower.face(wide[i], wide[(i + 1) % 3], tip);
  }
  return input;
}

/// Two octahedra joined by a bridge of three faces' width.
SurfaceInput bridged()
{
  SurfaceInput input;
  input.polygonOffsets = { 0 };
  Tower tower(input);
  const std::array<Index, 3> one = addOctahedron(tower, Vector3::Zero(), 1);
  const std::array<Index, 3> foot = tower.ring(1 - kRing, kRing);
  const std::array<Index, 3> head = tower.ring(3, kRing);
  const std::array<Index, 3> other = addOctahedron(tower, Vector3::Constant(4.0 / 3), -1);
  tower.join(one, foot);
  tower.join(foot, head);
  // Its corners are half a turn on: one on each side of those of the head.
  tower.join(head, { other[2], other[0], other[1] });
  return input;
}

constexpr double kGirth = 3 * kRing * 1.4142135623730951;

TEST(ThinParts, DropOnAStalkIsFoundAndCutOff)
{
  PreparedSurface surface = test::prepare(withDrop());
  ASSERT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  const std::vector<ThinPart> parts = findThinParts(surface.mesh, { 1.01 * kGirth, 0, 1 });
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_FALSE(parts[0].isLarge);
  EXPECT_NEAR(parts[0].length, kGirth, 1e-7); // places are rounded to the grid of the frame
  EXPECT_GT(parts[0].height, kGirth / 8);
  for (const Index v : parts[0].loop)
  {
    EXPECT_NEAR(surface.mesh.position[v].sum(), 1, 1e-7); // the foot, and not the neck
  }
  const double area = surface.area;
  EXPECT_EQ(cutThinParts(surface, parts, 2, 1), std::vector<std::size_t>{ 0 });
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  EXPECT_EQ(surface.mesh.faceCount(), 7U + 12 + 3); // the octahedron, round the foot, the fan
  // The fan fills the face of the octahedron.
  EXPECT_NEAR(surface.area, 8 * std::sqrt(3.0) / 2, 1e-6);
  EXPECT_NEAR(surface.area, area - parts[0].area + std::sqrt(3.0) / 2 * kRing * kRing, 1e-6);
}

TEST(ThinParts, WhatIsLongerRoundLargerOrFlatterStays)
{
  const PreparedSurface surface = test::prepare(withDrop());
  EXPECT_TRUE(findThinParts(surface.mesh, { 0.99 * kGirth, 0.99 * kGirth, 1 }).empty());
  EXPECT_TRUE(findThinParts(surface.mesh, { 1.01 * kGirth, 0, 1e-3 }).empty());
  EXPECT_TRUE(findThinParts(test::unitCube(3), { 10, 10, 100 }).empty());
}

TEST(ThinParts, WhatWasAskedForStays)
{
  SurfaceInput input = withDrop();
  PreparedSurface surface = test::prepare(input);
  const std::vector<ThinPart> parts = findThinParts(surface.mesh, { 1.01 * kGirth, 0, 1 });
  ASSERT_EQ(parts.size(), 1U);
  surface.valenceRequests = { { parts[0].tip, 3 } };
  const Index faces = surface.mesh.faceCount();
  EXPECT_TRUE(cutThinParts(surface, parts, 2, 1).empty());
  EXPECT_EQ(surface.mesh.faceCount(), faces);
}

TEST(ThinParts, WhatHasMoreAreaOnTheSurfaceStays)
{
  PreparedSurface surface = test::prepare(withDrop());
  const std::vector<ThinPart> parts = findThinParts(surface.mesh, { 1.01 * kGirth, 0, 1 });
  ASSERT_EQ(parts.size(), 1U);
  const Index faces = surface.mesh.faceCount();
  EXPECT_TRUE(cutThinParts(surface, parts, 2, 0.99 * parts[0].area).empty());
  EXPECT_EQ(surface.mesh.faceCount(), faces);
}

TEST(ThinParts, BridgeBetweenLargePartsIsCutInTwo)
{
  PreparedSurface surface = test::prepare(bridged());
  ASSERT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(surface.components, 1U);
  const std::vector<ThinPart> parts = findThinParts(surface.mesh, { 0, 1.01 * kGirth, 1 });
  ASSERT_EQ(parts.size(), 1U); // both ends of the bridge are three edges round
  EXPECT_TRUE(parts[0].isLarge);
  EXPECT_EQ(cutThinParts(surface, parts, 2, 1).size(), 1U);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 4);
  EXPECT_EQ(surface.components, 2U);
}

} // namespace
} // namespace quadrille
