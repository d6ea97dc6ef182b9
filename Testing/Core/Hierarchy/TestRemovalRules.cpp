// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Rules of the removal of a vertex [Ebke et al. 2016, Section 5.2] that whole decimations seldom put to the test.
#include "Hierarchy/FreeStar.h"
#include "Hierarchy/VertexRemoval.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Guards that leave the decision to the rules of topology and of curves.
RemovalGuards looseGuards()
{
  RemovalGuards guards;
  guards.minimumQuality = 1e-3;
  guards.minimumNormalDot = -1;
  guards.minimumValence = 3;
  guards.maximumValence = kMaximumRing;
  guards.curveTolerance = 1e300;
  return guards;
}

Index vertexAt(const Mesh& mesh, const Vector3& p)
{
  const auto found = std::find(mesh.position.begin(), mesh.position.end(), p);
  EXPECT_NE(found, mesh.position.end());
  return static_cast<Index>(found - mesh.position.begin());
}

/// Marks the edges whose both ends satisfy the condition.
template <typename Condition>
Mesh markEdges(Mesh mesh, const Condition& on)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (on(mesh.position[mesh.origin[h]]) && on(mesh.position[mesh.target(h)]))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  return mesh;
}

bool canGo(DecimationMesh& work, Index v, const RemovalGuards& guards)
{
  VertexRemoval removal(work);
  return removal.gather(v) && removal.plan(guards);
}

bool canGo(const Mesh& mesh, Index v, const RemovalGuards& guards)
{
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  return canGo(work, v, guards);
}

FreeStar::Outcome planFast(DecimationMesh& work, Index v, const RemovalGuards& guards)
{
  FreeStar star(work, guards);
  star.gather(v);
  star.shortestEdge(1);
  return star.plan();
}

/// A plane with one face cut into three at its middle, which is the last vertex.
Mesh planeWithCutFace(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const Mesh grid = gridPlane(6, 6);
  const auto isCorner = [&](Index v)
  { return grid.position[v] == a || grid.position[v] == b || grid.position[v] == c; };
  std::vector<Vector3> points = grid.position;
  points.push_back((a + b + c) / 3);
  std::vector<Triangle> triangles;
  for (Index f = 0; f < grid.faceCount(); ++f)
  {
    const Index p = grid.origin[3 * f], q = grid.origin[3 * f + 1], r = grid.origin[3 * f + 2];
    if (isCorner(p) && isCorner(q) && isCorner(r))
    {
      const Index middle = static_cast<Index>(points.size() - 1);
      triangles.insert(triangles.end(), { { p, q, middle }, { q, r, middle }, { r, p, middle } });
    }
    else
    {
      triangles.push_back({ p, q, r });
    }
  }
  EXPECT_EQ(triangles.size(), grid.faceCount() + 2U);
  return makeMesh(points, triangles);
}

/// A double pyramid over a hexagon; vertices 6 and 7 are the tips.
Mesh doublePyramid()
{
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  for (Index i = 0; i < 6; ++i)
  {
    points.emplace_back(std::cos(i * kPi / 3), std::sin(i * kPi / 3), 0);
    triangles.push_back({ i, (i + 1) % 6, 6 });
    triangles.push_back({ (i + 1) % 6, i, 7 });
  }
  points.emplace_back(0, 0, 0.5);
  points.emplace_back(0, 0, -0.5);
  return makeMesh(points, triangles);
}

} // namespace

TEST(RemovalRules, ARemovedVertexDividesItsCurveAsItsEdgesWere)
{
  // Edges of lengths 3 and 1: its place on the isoline is three quarters of the way, to the log's 2^-32.
  Mesh mesh = gridPlane(8, 8);
  mesh = markEdges(std::move(mesh), [](const Vector3& p) { return p.y() == 4; });
  const Index v = vertexAt(mesh, Vector3(4, 4, 0));
  mesh.position.edit()[v].x() = 4.5;
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  VertexRemoval removal(work);
  ASSERT_TRUE(removal.gather(v));
  ASSERT_TRUE(removal.plan(looseGuards()));
  RecordWriter log;
  removal.apply(log);
  // The collapse is the first record; flips follow.
  CollapseRecord record;
  const int faces = 6;
  readCollapse(log.bytes().data() + collapseBytes(faces), record);
  ASSERT_EQ(record.faces, faces);
  EXPECT_TRUE(record.onCurve);
  EXPECT_NEAR(record.weight[0] / 4294967296.0, 0.25, 1e-9);
  EXPECT_EQ(record.weight[1], 0U);
}

TEST(RemovalRules, TheTwoFacesOfAClosedTetrahedronStay)
{
  // Every vertex of a tetrahedron has a free star of three faces; without it two faces would lie on each other.
  const Mesh tetrahedron =
    makeMesh({ Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1) },
      { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } });
  RemovalGuards guards = looseGuards();
  guards.minimumValence = 2; // that of the corners of two faces
  for (Index v = 0; v < 4; ++v)
  {
    EXPECT_FALSE(canGo(tetrahedron, v, guards));
    DecimationMesh work(tetrahedron, traceFeatureCurves(tetrahedron, 0.01));
    EXPECT_EQ(planFast(work, v, guards), FreeStar::Outcome::Refused);
  }
}

TEST(RemovalRules, AnEdgeThatExistsIsNotMadeAgain)
{
  const Mesh octahedron = makeMesh({ Vector3(0.8, 0, 0), Vector3(0, 1, 0), Vector3(-0.8, 0, 0),
                                     Vector3(0, -1, 0), Vector3(0, 0, 1), Vector3(0, 0, -1) },
    { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 }, { 1, 0, 5 }, { 2, 1, 5 }, { 3, 2, 5 },
      { 0, 3, 5 } });
  ASSERT_TRUE(canGo(octahedron, 4, looseGuards()));
  DecimationMesh work(octahedron, traceFeatureCurves(octahedron, 0.01));
  RemovalGuards guards = looseGuards();
  guards.minimumValence = 2; // that of the corners beside a diagonal
  // With vertex 4 gone the square is cut by one diagonal; vertex 5 may only use the other one.
  VertexRemoval removal(work);
  RecordWriter log;
  ASSERT_TRUE(removal.gather(4));
  ASSERT_TRUE(removal.plan(looseGuards()));
  removal.apply(log);
  ASSERT_TRUE(work.hasEdge(0, 2)) << "the shorter one";
  ASSERT_TRUE(removal.gather(5));
  ASSERT_TRUE(removal.plan(guards));
  removal.apply(log);
  EXPECT_TRUE(work.hasEdge(1, 3));
  EXPECT_EQ(validate(work.extract().mesh), "") << "a tetrahedron";
}

TEST(RemovalRules, ACurveMayNotCloseATriangle)
{
  // Three features round one face that is cut into three at its middle [Hoppe 1996]: without a corner its two edges
  // would become one with the third.
  const Vector3 a(2, 2, 0), b(3, 2, 0), c(3, 3, 0);
  const auto isCorner = [&](const Vector3& p) { return p == a || p == b || p == c; };
  const Mesh mesh = markEdges(planeWithCutFace(a, b, c), isCorner);
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  VertexRemoval removal(work);
  for (const Vector3& p : { a, b, c })
  {
    const Index v = vertexAt(mesh, p);
    work.curves.kind[v] = VertexKind::Curve; // as if it were no corner
    work.curves.curve[v] = 0;
    ASSERT_TRUE(removal.gather(v));
    EXPECT_FALSE(removal.surroundingsFit(looseGuards()));
  }
}

TEST(RemovalRules, DeviationsOfACurveAddUp)
{
  // Each vertex of a feature may go by itself, but one that took another's deviation over may not.
  Mesh mesh = gridPlane(10, 10);
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() = p.y() == 5 ? 0.02 * std::pow(p.x() - 5, 2) : 0;
  }
  mesh = markEdges(std::move(mesh), [](const Vector3& p) { return p.y() == 5; });
  const auto at = [&](double x)
  { return vertexAt(mesh, Vector3(x, 5, 0.02 * std::pow(x - 5, 2))); };
  RemovalGuards guards = looseGuards();
  guards.curveTolerance = 0.05; // the first vertex is off by 0.02, the next one by 0.04
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  VertexRemoval removal(work);
  RecordWriter log;
  ASSERT_TRUE(removal.gather(at(5)));
  ASSERT_TRUE(removal.plan(guards));
  removal.apply(log);
  ASSERT_TRUE(removal.gather(at(6)));
  EXPECT_FALSE(removal.surroundingsFit(guards));
  work.curveError[at(6)] = 0;
  EXPECT_TRUE(removal.surroundingsFit(guards)) << "its own distance alone would do";
}

TEST(RemovalRules, AStarThatMeetsAVertexTwiceStays)
{
  // As at an edge of four faces, whose two sheets share both of its ends.
  Mesh mesh = doublePyramid();
  DecimationMesh apart(mesh, traceFeatureCurves(mesh, 0.01));
  ASSERT_TRUE(canGo(apart, 6, looseGuards()));
  ASSERT_EQ(planFast(apart, 6, looseGuards()), FreeStar::Outcome::Planned);
  for (Index& v : mesh.origin.editAll())
  {
    v = v == 3 ? 0 : v;
  }
  DecimationMesh joined(mesh, traceFeatureCurves(mesh, 0.01));
  EXPECT_FALSE(canGo(joined, 6, looseGuards()));
  EXPECT_EQ(planFast(joined, 6, looseGuards()), FreeStar::Outcome::Unsuited);
}

TEST(RemovalRules, ACurveIsStraightInThePlanarMap)
{
  // The neighbour inside a bend lies short of the chord that takes the bend's place. On the surface its triangle would
  // turn round, in the map, where each side of a curve has half a turn, there is room for it.
  Mesh mesh = markEdges(gridPlane(8, 8),
    [](const Vector3& p) { return (p.y() == 4 && p.x() >= 4) || (p.x() == 4 && p.y() >= 4); });
  const Index v = vertexAt(mesh, Vector3(4, 4, 0));
  mesh.position.edit()[vertexAt(mesh, Vector3(5, 5, 0))] = Vector3(4.4, 4.4, 0);
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  work.curves.kind[v] = VertexKind::Curve; // as if it were no corner
  EXPECT_TRUE(canGo(work, v, looseGuards()));
}

TEST(RemovalRules, ChordsMoveAlongACurveOnlyToAnotherOne)
{
  // Two features with a row of chords between them.
  const Mesh grid = gridPlane(8, 8);
  Mesh mesh = grid;
  for (const double y : { 4.0, 5.0 })
  {
    mesh = markEdges(std::move(mesh), [y](const Vector3& p) { return p.y() == y; });
  }
  const Index v = vertexAt(mesh, Vector3(4, 4, 0));
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  EXPECT_TRUE(canGo(work, v, looseGuards()));
  for (Index w = 0; w < mesh.vertexCount(); ++w)
  {
    if (mesh.position[w].y() == 5)
    {
      work.curves.curve[w] = work.curves.curve[v]; // as if they met beyond
    }
  }
  EXPECT_FALSE(canGo(work, v, looseGuards()));
}

TEST(RemovalRules, AFaceHasOneConstrainedEdge)
{
  const Vector3 a(2, 2, 0), b(3, 2, 0), c(3, 3, 0);
  const Mesh mesh = planeWithCutFace(a, b, c);
  const Index middle = mesh.vertexCount() - 1;
  const Mesh one = markEdges(mesh, [&](const Vector3& p) { return p == a || p == b; });
  EXPECT_TRUE(canGo(one, middle, looseGuards()));
  const Mesh two = markEdges(one, [&](const Vector3& p) { return p == b || p == c; });
  EXPECT_FALSE(canGo(two, middle, looseGuards()));
}

TEST(RemovalRules, NoFaceHasThreeCurveVertices)
{
  const Vector3 a(2, 2, 0), b(3, 2, 0), c(3, 3, 0);
  const Mesh mesh = planeWithCutFace(a, b, c);
  DecimationMesh work(mesh, traceFeatureCurves(mesh, 0.01));
  for (const Vector3& p : { a, b, c })
  {
    work.curves.kind[vertexAt(mesh, p)] = VertexKind::Protected; // ends of features outside
  }
  EXPECT_FALSE(canGo(work, mesh.vertexCount() - 1, looseGuards()));
}
