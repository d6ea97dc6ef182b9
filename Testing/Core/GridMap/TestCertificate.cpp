// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "GridMap/Certificate.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

using namespace quadrille;

namespace
{

/// A flat grid whose map is the identity, in quads; every face in a chart of its own.
struct FlatMap
{
  Mesh mesh;
  std::vector<FixedVec2> uv;
  std::vector<int> turns;
  std::vector<std::uint8_t> integer;

  explicit FlatMap(int columns, int rows)
    : mesh(test::gridPlane(columns, rows)), turns(mesh.vertexCount(), 4),
      integer(mesh.vertexCount(), 0)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& p = mesh.position[mesh.origin[h]];
      uv.push_back(rotate(toFixed(Vector2(p.x(), p.y())), static_cast<int>(h / 3)) +
        FixedVec2{ kOne * (h / 3), 0 });
    }
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      const Vector3& p = mesh.position[v];
      const bool sideX = p.x() == 0 || p.x() == columns;
      const bool sideY = p.y() == 0 || p.y() == rows;
      turns[v] = sideX && sideY ? 1 : (sideX || sideY ? 2 : 4);
      integer[v] = sideX && sideY;
    }
  }

  Certificate check() const { return certify(mesh, uv, turns, integer); }

  /// Moves all images of vertex v by a vector given in the chart of face 0 (turned by face id).
  void move(Index v, FixedVec2 by)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.origin[h] == v)
      {
        uv[h] = uv[h] + rotate(by, static_cast<int>(h / 3));
      }
    }
  }

  Index vertexAt(double x, double y) const
  {
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      if (mesh.position[v].x() == x && mesh.position[v].y() == y)
      {
        return v;
      }
    }
    return kInvalidIndex;
  }
};

} // namespace

TEST(Certificate, AcceptsTheIdentityInRotatedCharts)
{
  const FlatMap map(4, 3);
  const Certificate c = map.check();
  EXPECT_TRUE(c.valid()) << c.text();
  EXPECT_EQ(c.triangles, 24u);
  EXPECT_EQ(c.area, 12);
  EXPECT_EQ(c.minimumDeterminant, 1);
  EXPECT_EQ(c.worstFaces.size(), 16u);
}

TEST(Certificate, CountsInvertedAndDegenerateTriangles)
{
  FlatMap map(4, 3);
  map.move(map.vertexAt(2, 1), { 3 * kOne / 2, 0 });
  EXPECT_GT(map.check().notPositive, 0u);
  EXPECT_LT(map.check().minimumDeterminant, 0);
  EXPECT_EQ(map.check().seamResiduals, 0u);
  map = FlatMap(4, 3);
  map.move(map.vertexAt(2, 1), { kOne, 0 });
  EXPECT_GT(map.check().notPositive, 0u);
  EXPECT_EQ(map.check().minimumDeterminant, 0);
}

TEST(Certificate, CountsOneUnitOfSeamResidual)
{
  FlatMap map(4, 3);
  const Index inner = map.vertexAt(2, 1);
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    if (map.mesh.origin[h] == inner)
    {
      map.uv[h].u += 1; // 2^-24 quads in a single corner
      break;
    }
  }
  const Certificate c = map.check();
  EXPECT_EQ(c.seamResiduals, 2u); // the two edges of that face at the vertex
  EXPECT_EQ(c.notPositive, 0u);
  EXPECT_FALSE(c.seamless());
}

TEST(Certificate, CountsFractionalTransitions)
{
  FlatMap map(4, 3);
  for (int i = 0; i < 3; ++i)
  {
    map.uv[i].u += kOne / 2;
  }
  const Certificate c = map.check();
  EXPECT_EQ(c.seamResiduals, 0u);
  EXPECT_EQ(c.fractionalTransitions, 2u); // face 0 has one boundary edge
  EXPECT_TRUE(c.seamless());
  EXPECT_FALSE(c.valid());
}

TEST(Certificate, CountsConstrainedEdgesOffTheirIsolines)
{
  FlatMap map(4, 3);
  for (double x = 0; x <= 4; ++x)
  {
    map.move(map.vertexAt(x, 0), { 0, kOne / 4 });
  }
  EXPECT_EQ(map.check().offIsolines, 4u);
  EXPECT_EQ(map.check().offAxes, 0u);
  EXPECT_TRUE(map.check().seamless());
  map.move(map.vertexAt(2, 0), { 0, 1 });
  EXPECT_EQ(map.check().offAxes, 2u);
  EXPECT_FALSE(map.check().seamless());
}

TEST(Certificate, CountsIntegerVerticesOncePerVertex)
{
  FlatMap map(4, 3);
  map.integer[map.vertexAt(2, 1)] = 1;
  EXPECT_TRUE(map.check().valid());
  map.move(map.vertexAt(2, 1), { 5, 0 });
  EXPECT_EQ(map.check().offIntegers, 1u);
  EXPECT_EQ(map.check().seamResiduals, 0u);
}

TEST(Certificate, CountsWrongExpectedTurns)
{
  FlatMap map(4, 3);
  map.turns[map.vertexAt(2, 1)] = 3;
  map.turns[map.vertexAt(0, 0)] = 2;
  EXPECT_EQ(map.check().wrongTurns, 2u);
}

TEST(Certificate, FindsAVertexThatWindsTwiceThoughEveryTriangleIsPositive)
{
  // A fan of nine triangles whose centre turns by eight quarters: all positive, seams exact.
  const int n = 9;
  std::vector<Vector3> points{ Vector3(0, 0, 0) };
  std::vector<test::Triangle> triangles;
  for (int i = 0; i < n; ++i)
  {
    points.emplace_back(std::cos(2 * test::kPi * i / n), std::sin(2 * test::kPi * i / n), 0);
    triangles.push_back({ 0, Index(1 + i), Index(1 + (i + 1) % n) });
  }
  const Mesh mesh = test::makeMesh(points, triangles);
  std::vector<FixedVec2> uv;
  for (const Index v : mesh.origin)
  {
    const double angle = v == 0 ? 0 : 4 * test::kPi * (v - 1) / n;
    uv.push_back(v == 0 ? FixedVec2{} : toFixed(Vector2(std::cos(angle), std::sin(angle))));
  }
  std::vector<int> turns(mesh.vertexCount(), 0);
  const std::vector<std::uint8_t> integer(mesh.vertexCount(), 0);
  turns[0] = 4;
  const std::size_t wrong = certify(mesh, uv, turns, integer).wrongTurns;
  turns[0] = 8;
  const Certificate c = certify(mesh, uv, turns, integer);
  EXPECT_EQ(c.notPositive, 0u);
  EXPECT_EQ(c.seamResiduals, 0u);
  EXPECT_EQ(c.wrongTurns + 1, wrong);
}

TEST(Certificate, TransitionsComposeToTheIdentityRoundARegularVertex)
{
  const FlatMap map(4, 4);
  const Index inner = map.vertexAt(2, 2);
  const Index start = outgoingHalfEdges(map.mesh)[inner];
  Transition around;
  Index h = start;
  do
  {
    bool residual = true;
    around = transitionOf(map.mesh, map.uv, Mesh::previous(h), 0, &residual).after(around);
    EXPECT_FALSE(residual);
    h = map.mesh.rotateCounterclockwise(h);
  } while (h != start);
  EXPECT_TRUE(around.isIdentity());
}

TEST(Certificate, TransitionOfAPointEdgeTakesTheFallback)
{
  FlatMap map(2, 2);
  const Index h = map.mesh.twin[0] == kInvalidIndex ? 1 : 0;
  const Index g = map.mesh.twin[h];
  map.uv[Mesh::next(h)] = map.uv[h];
  map.uv[Mesh::next(g)] = map.uv[g];
  bool residual = true;
  EXPECT_EQ(transitionOf(map.mesh, map.uv, h, 3, &residual).rotation, 3);
  EXPECT_FALSE(residual);
}

TEST(Certificate, RefusesArraysOfAnotherSize)
{
  FlatMap map(2, 2);
  map.turns.pop_back();
  EXPECT_THROW(map.check(), InvalidInput);
}

TEST(Certificate, AnEdgeWithAPointForImageMayTurnByAnything)
{
  const Mesh mesh = test::gridPlane(1, 1);
  Index h = 0;
  while (mesh.isBoundary(h))
  {
    ++h;
  }
  const Index g = mesh.twin[h];
  std::vector<FixedVec2> uv(mesh.halfEdgeCount(), toFixed(Vector2(3, 7)));
  const FixedVec2 p = toFixed(Vector2(0.5, 0.25));
  uv[h] = uv[Mesh::next(h)] = p;
  uv[g] = uv[Mesh::next(g)] = rotate(p, 1) + FixedVec2{ kOne, 0 };
  const std::vector<int> turns(mesh.vertexCount(), 0);
  const std::vector<std::uint8_t> free(mesh.vertexCount(), 0);
  EXPECT_EQ(certify(mesh, uv, turns, free).fractionalTransitions, 0u);
  uv[g].u += kOne / 4;
  uv[Mesh::next(g)].u += kOne / 4;
  EXPECT_EQ(certify(mesh, uv, turns, free).fractionalTransitions, 1u);
}
