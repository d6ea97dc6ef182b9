// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadQuality.h"

#include "Base/Error.h"
#include "Quads/QuadShape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille::test
{
namespace
{

using Quads = std::vector<std::array<Index, 4>>;

std::vector<Vector3> cubePoints()
{
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i)
  {
    points.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  }
  return points;
}

Quads cubeQuads()
{
  return { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
    { 1, 3, 7, 5 } };
}

} // namespace

TEST(QuadQuality, Cube)
{
  const QuadQuality q = evaluateQuads(cubePoints(), cubeQuads());
  EXPECT_EQ(q.quads, 6u);
  EXPECT_EQ(q.vertices, 8u);
  EXPECT_EQ(q.edges, 12u);
  EXPECT_EQ(q.components, 1u);
  EXPECT_EQ(q.boundaryLoops, 0u);
  EXPECT_EQ(q.eulerCharacteristic, 2);
  EXPECT_TRUE(q.manifold);
  EXPECT_TRUE(q.closed);
  EXPECT_EQ(q.irregularVertices, 8u);
  EXPECT_EQ(q.interiorValences.at(3), 8u);
  EXPECT_DOUBLE_EQ(q.scaledJacobian.minimum, 1);
  EXPECT_DOUBLE_EQ(q.edgeLength.mean, 1);
  EXPECT_DOUBLE_EQ(q.area.maximum, 1);
}

TEST(QuadQuality, OpenCubeHasABoundary)
{
  Quads quads = cubeQuads();
  quads.pop_back();
  const QuadQuality q = evaluateQuads(cubePoints(), quads);
  EXPECT_TRUE(q.manifold);
  EXPECT_FALSE(q.closed);
  EXPECT_EQ(q.boundaryLoops, 1u);
  EXPECT_EQ(q.eulerCharacteristic, 1);
  EXPECT_EQ(q.interiorValences.at(3), 4u);
  quads.pop_back(); // opposite to the first: a tube
  const QuadQuality tube = evaluateQuads(cubePoints(), quads);
  EXPECT_EQ(tube.boundaryLoops, 2u);
}

TEST(QuadQuality, SeesWhatIsNoManifold)
{
  const std::vector<Vector3> points = cubePoints();
  Quads twice = cubeQuads();
  twice.push_back(twice[0]);
  EXPECT_FALSE(evaluateQuads(points, twice).manifold);

  Quads turned = cubeQuads();
  std::swap(turned[0][1], turned[0][3]);
  EXPECT_FALSE(evaluateQuads(points, turned).manifold);

  Quads repeated = cubeQuads();
  repeated[0][1] = repeated[0][0];
  EXPECT_FALSE(evaluateQuads(points, repeated).manifold);

  // Two quads that touch in one point only.
  std::vector<Vector3> bow = points;
  bow.insert(bow.end(), { Vector3(2, 2, 0), Vector3(2, 1, 0), Vector3(1, 2, 0) });
  EXPECT_FALSE(evaluateQuads(bow, { { 0, 1, 3, 2 }, { 3, 9, 8, 10 } }).manifold);

  EXPECT_THROW(evaluateQuads(points, { { 0, 1, 2, 8 } }), InvalidInput);
}

TEST(QuadQuality, ScaledJacobianOfKnownShapes)
{
  // The determinant of two unit vectors at 60 and 120 degrees is sin 60 at every corner.
  const double s = std::sqrt(3.0) / 2;
  const Vector3 o(0, 0, 0), x(1, 0, 0);
  const Vector3 d(0.5, s, 0);
  EXPECT_NEAR(scaledJacobian({ o, x, x + d, d }), s, 1e-15);
  // Orientation does not matter: the normal follows the quad.
  EXPECT_NEAR(scaledJacobian({ o, d, x + d, x }), s, 1e-15);
  // A dart is not convex; a repeated point has no angle; a straight corner has none either.
  EXPECT_LT(scaledJacobian({ o, Vector3(2, 0, 0), Vector3(0.2, 0.2, 0), Vector3(0, 2, 0) }), 0);
  EXPECT_EQ(scaledJacobian({ o, x, x, d }), 0);
  EXPECT_NEAR(scaledJacobian({ o, x, Vector3(2, 0, 0), Vector3(1, 1, 0) }), 0, 1e-15);
}

} // namespace quadrille::test
