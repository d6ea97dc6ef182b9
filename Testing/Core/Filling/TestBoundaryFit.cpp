// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FillFaces.h"
#include "QuadChecks.h"

#include "Filling/BoundaryFit.h"
#include "Filling/FaceFilling.h"
#include "Filling/FaceGround.h"
#include "Mesh/Topology.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

namespace quadrille::test
{
namespace
{

/// columns x rows quads; closed: the first column is beside the last one.
QuadMesh grid(
  Index columns, Index rows, bool closed, const std::function<Vector3(double x, double y)>& place)
{
  QuadMesh mesh;
  const Index across = closed ? columns : columns + 1;
  for (Index y = 0; y <= rows; ++y)
  {
    for (Index x = 0; x < across; ++x)
    {
      mesh.points.push_back(place(double(x) / columns, double(y) / rows));
      mesh.sourceFace.push_back(0);
      mesh.sourceWeights.push_back({ 1, 0, 0 });
    }
  }
  for (Index y = 0; y < rows; ++y)
  {
    for (Index x = 0; x < columns; ++x)
    {
      const Index a = y * across + x, b = y * across + (x + 1) % across;
      mesh.quads.push_back({ a, b, b + across, a + across });
      mesh.quadSourceFace.push_back(0);
      mesh.quadSourceWeights.push_back({ 0, 0, 0 });
    }
  }
  return mesh;
}

QuadMesh rectangleGrid(Index columns, Index rows, double width, double height)
{
  return grid(
    columns, rows, false, [&](double x, double y) { return Vector3(width * x, height * y, 0); });
}

/// So many pins on the lower, right, upper and left side, without the corner at the end of each.
FillCase rectanglePins(double width, double height, const std::array<int, 4>& edges)
{
  const std::array<Vector2, 4> corners{ Vector2(0, 0), { width, 0 }, { width, height },
    { 0, height } };
  PinLoop loop;
  for (std::size_t side = 0; side < 4; ++side)
  {
    const Vector2 &a = corners[side], &b = corners[(side + 1) % 4];
    for (int i = 0; i < edges[side]; ++i)
    {
      loop.add(a + (b - a) * i / edges[side], true);
    }
  }
  return planeCase({ loop });
}

struct Fit
{
  std::size_t quads = 0;
  int irregular = 0; ///< points inside with another number of quads than 4
};

/// Checks that the boundary is that of the pins, edge for edge.
std::optional<Fit> fit(const FillCase& c, QuadMesh own)
{
  const FaceGround ground(c.mesh, c.isPin, 1);
  const std::vector<Index> pins =
    idsWhere(c.mesh.vertexCount(), [&](Index v) { return c.isPin[v] != 0; });
  const std::optional<FaceQuads> fitted = fitBoundary(std::move(own), c.mesh, ground, pins);
  if (!fitted)
  {
    return std::nullopt;
  }
  EXPECT_EQ(fitted->pinCount, pins.size());
  const QuadTopology topology = analyzeQuads(fitted->quads, fitted->points.size());
  EXPECT_TRUE(topology.manifold()) << topology.text();
  EXPECT_EQ(topology.eulerCharacteristic, summarizeTopology(c.mesh).eulerCharacteristic);
  EXPECT_EQ(topology.boundaryEdges, pins.size());
  Fit result;
  result.quads = fitted->quads.size();
  for (Index p = 0; p < fitted->points.size(); ++p)
  {
    result.irregular += topology.onBoundary[p] == 0 && topology.valence[p] != 4 ? 1 : 0;
    EXPECT_EQ(topology.onBoundary[p] != 0, p < pins.size());
  }
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    const Index a = fitted->quads[h / 4][h % 4], b = fitted->quads[h / 4][(h + 1) % 4];
    if (topology.twin[h] == kInvalidIndex && a < pins.size() && b < pins.size())
    {
      EXPECT_EQ(ground.nextPin(pins[a]), pins[b]);
      EXPECT_EQ(fitted->points[a], Vector3(c.mesh.position[pins[a]]));
    }
  }
  return result;
}

} // namespace

TEST(BoundaryFit, StripsArePutInBetweenSidesThatLackEdges)
{
  const auto made = fit(rectanglePins(9, 6, { 9, 6, 9, 6 }), rectangleGrid(7, 5, 9, 6));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->quads, 54u);
  EXPECT_EQ(made->irregular, 0);
}

TEST(BoundaryFit, StripsAreTakenOutBetweenSidesThatHaveTooMany)
{
  const auto made = fit(rectanglePins(9, 6, { 9, 6, 9, 6 }), rectangleGrid(11, 7, 9, 6));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->quads, 54u);
  EXPECT_EQ(made->irregular, 0);
}

TEST(BoundaryFit, AStripTurnsOnceBetweenSidesBesideEachOther)
{
  const auto made = fit(rectanglePins(9, 6, { 10, 7, 9, 6 }), rectangleGrid(9, 6, 9, 6));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->irregular, 2);
}

TEST(BoundaryFit, WhatIsTakenFromASideThatHasEnoughIsPutInAgain)
{
  // One too many below, and one lacks on the right.
  const auto made = fit(rectanglePins(9, 6, { 8, 7, 9, 6 }), rectangleGrid(9, 6, 9, 6));
  ASSERT_TRUE(made);
  EXPECT_LE(made->irregular, 2);
}

TEST(BoundaryFit, LoopsWithoutCorners)
{
  const auto ring = [](Index columns)
  {
    return grid(columns, 4, true,
      [](double x, double y)
      {
        const double angle = -2 * kPi * x, radius = 2 + 2 * y;
        return Vector3(radius * std::cos(angle), radius * std::sin(angle), 0);
      });
  };
  // Fine, so that all points of the quads lie on their boundary; 24 pins outside, and 20 inside.
  FillCase c = planeCase({ circleLoop({ 0, 0 }, 4, 24, 9), circleLoop({ 0, 0 }, 2, 20, 11, true) });
  const auto made = fit(c, ring(24));
  ASSERT_TRUE(made);
  EXPECT_TRUE(fit(c, ring(16)));
  EXPECT_TRUE(fit(c, ring(30)));
}

TEST(BoundaryFit, TheLastQuadStays)
{
  // Between two of its corners it has an edge too many on one side, and lacks one on the other.
  PinLoop loop;
  loop.add({ 0, 0 }, true);
  loop.add({ 2, 0 }, false);
  loop.add({ 2, 2 }, true);
  loop.add({ 1, 2 }, true);
  loop.add({ 0, 2 }, false);
  loop.add({ 0, 1 }, true);
  EXPECT_FALSE(fit(planeCase({ loop }), rectangleGrid(1, 1, 2, 2)));
}

TEST(BoundaryFit, NoneOfAnotherFace)
{
  // A hole more.
  const FillCase c = rectanglePins(9, 6, { 9, 6, 9, 6 });
  QuadMesh own = rectangleGrid(9, 6, 9, 6);
  own.quads.erase(own.quads.begin() + 30);
  own.quadSourceFace.pop_back();
  own.quadSourceWeights.pop_back();
  EXPECT_FALSE(fit(c, own));
  EXPECT_FALSE(fit(c, QuadMesh()));
}

TEST(BoundaryFit, AFaceIsFilledByItsOwnQuadsWhereTheyAreBetter)
{
  const FillCase c = rectanglePins(9, 6, { 9, 6, 9, 6 });
  std::size_t asked = 0;
  const auto fill = fillFace(c.mesh, c.isPin, 1,
    [&](const Mesh& face)
    {
      ++asked;
      EXPECT_EQ(face.sizing.size(), face.vertexCount());
      return rectangleGrid(8, 6, 9, 6);
    });
  ASSERT_TRUE(fill);
  EXPECT_EQ(asked, 1u);
  EXPECT_EQ(fill->quads.size(), 54u);
  // Those that do not fit are left.
  EXPECT_TRUE(fillFace(c.mesh, c.isPin, 1, [](const Mesh&) { return QuadMesh(); }));
}

} // namespace quadrille::test
