// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FilledFaces.h"

#include "QuadChecks.h"
#include "TestMeshes.h"

#include "Filling/FaceCurves.h"
#include "Mesh/CutOpen.h"
#include "Quads/QuadShape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace quadrille;

namespace
{

constexpr double kThirtyDegrees = 0.5235987755982988;

std::vector<std::uint8_t> none(const Mesh& mesh)
{
  return std::vector<std::uint8_t>(mesh.halfEdgeCount(), 0);
}

Mesh tetrahedron()
{
  return test::markFeatures(
    test::makeMesh({ { 1, 1, 1 }, { -1, -1, 1 }, { -1, 1, -1 }, { 1, -1, -1 } },
      { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } }),
    kThirtyDegrees);
}

/// Quads of all faces of a mesh.
FilledFaces fillAll(const Mesh& mesh, double edgeLength)
{
  FaceCurves curves(mesh, none(mesh), edgeLength);
  EXPECT_TRUE(curves.chooseNumbers().empty());
  FilledFaces filled = fillFaces(mesh, curves, edgeLength);
  EXPECT_TRUE(filled.failedAt.empty());
  return filled;
}

void expectOnFaces(const Mesh& mesh, const QuadMesh& quads)
{
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    Vector3 onFace = Vector3::Zero();
    for (Index k = 0; k < 3; ++k)
    {
      onFace += quads.sourceWeights[p][k] * mesh.position[mesh.origin[3 * quads.sourceFace[p] + k]];
    }
    EXPECT_LT((onFace - quads.points[p]).norm(), 1e-9);
  }
}

} // namespace

TEST(CutOpen, PartsVerticesWhoseFacesHangTogetherNoMore)
{
  Mesh mesh = test::markFeatures(test::unitCube(2), kThirtyDegrees);
  const Mesh before = mesh;
  std::vector<std::uint8_t> isFeature = none(mesh);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    isFeature[h] = mesh.isFeature(h) ? 1 : 0;
  }
  const std::vector<Index> copied = cutOpen(mesh, isFeature);
  // Six sides of nine vertices.
  EXPECT_EQ(mesh.vertexCount(), 54U);
  EXPECT_EQ(copied.size(), 54U - before.vertexCount());
  for (Index i = 0; i < copied.size(); ++i)
  {
    EXPECT_EQ(mesh.position[before.vertexCount() + i], before.position[copied[i]]);
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_EQ(mesh.isBoundary(h), before.isFeature(h));
    EXPECT_EQ(mesh.position[mesh.origin[h]], before.position[before.origin[h]]);
  }
}

TEST(FaceCurves, SidesOfACubeAreFacesBetweenTwelveCurves)
{
  const Mesh mesh = test::markFeatures(test::unitCube(4), kThirtyDegrees);
  const FaceCurves curves(mesh, none(mesh), 0.25);
  EXPECT_EQ(curves.faceCount(), 6U);
  ASSERT_EQ(curves.curves().size(), 12U);
  for (const FaceCurve& curve : curves.curves())
  {
    EXPECT_FALSE(curve.closed);
    EXPECT_NEAR(curve.length, 4, 1e-12);
    EXPECT_NE(curve.faces[0], curve.faces[1]);
  }
}

TEST(FaceCurves, OddFacesPassAnEdgeOn)
{
  const Mesh mesh = tetrahedron();
  // Three times three edges round each of four faces.
  FaceCurves curves(mesh, none(mesh), std::sqrt(8.0) / 3);
  EXPECT_TRUE(curves.chooseNumbers().empty());
  std::vector<std::size_t> around(4, 0);
  std::size_t all = 0;
  for (const FaceCurve& curve : curves.curves())
  {
    around[curve.faces[0]] += curve.edges;
    around[curve.faces[1]] += curve.edges;
    all += curve.edges;
  }
  for (const std::size_t edges : around)
  {
    EXPECT_EQ(edges % 2, 0U);
  }
  EXPECT_NEAR(static_cast<double>(all), 18, 3); // at most one for each face but one
}

TEST(FaceCurves, GivenPointsMakeAFaceOdd)
{
  const Mesh mesh = test::gridPlane(3, 3);
  std::vector<std::uint8_t> isGiven = none(mesh);
  std::vector<CurvePoint> points;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      isGiven[h] = 1;
      points.push_back({ h, 0 });
    }
  }
  ASSERT_EQ(points.size(), 12U);
  FaceCurves curves(mesh, isGiven, 1);
  curves.setGiven(points);
  EXPECT_TRUE(curves.chooseNumbers().empty());
  points.push_back({ points.front().h, 0.5 });
  curves.setGiven(points);
  EXPECT_EQ(curves.chooseNumbers(), std::vector<Index>{ 0 });
}

// One quad with a given point in the middle of a straight side would have a flat corner there.
TEST(FaceCurves, NoSingleQuadHasAFlatCornerAtAGivenPoint)
{
  const Mesh mesh = test::makeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } }, { { 0, 1, 2 } });
  FaceCurves curves(mesh, { 1, 0, 0 }, 5);
  curves.setGiven({ { 0, 0 }, { 0, 0.5 }, { 1, 0 } });
  EXPECT_TRUE(curves.chooseNumbers().empty());
  std::size_t around = 2;
  for (const FaceCurve& curve : curves.curves())
  {
    around += curve.edges;
  }
  EXPECT_EQ(around, 6U);
}

TEST(FaceCurves, ThreeEdgesGoRoundASlit)
{
  Mesh mesh = test::gridPlane(8, 8);
  Index slit = 0;
  while (mesh.isBoundary(slit) || (mesh.position[mesh.origin[slit]] - Vector3(4, 4, 0)).norm() > 0)
  {
    ++slit;
  }
  mesh.flags.edit()[slit] |= kFeatureEdge;
  mesh.flags.edit()[mesh.twin[slit]] |= kFeatureEdge;
  FaceCurves curves(mesh, none(mesh), 1);
  EXPECT_TRUE(curves.chooseNumbers().empty());
  const auto isInside = [](const FaceCurve& curve) { return curve.faces[1] != kInvalidIndex; };
  const auto found = std::find_if(curves.curves().begin(), curves.curves().end(), isInside);
  ASSERT_NE(found, curves.curves().end());
  EXPECT_NEAR(found->length, 1, 0.5);
  EXPECT_EQ(found->loops[0], found->loops[1]);
  EXPECT_GE(2 * found->edges, 3U);
  const FilledFaces filled = fillFaces(mesh, curves, 1);
  EXPECT_TRUE(filled.failedAt.empty());
  EXPECT_FALSE(filled.quads.quads.empty());
}

/// At the tip of a slender cone a curve ends, with a single quad round it: the points on both sides of the curve are
/// corners of this quad, and one point.
TEST(FilledFaces, QuadsRoundTheEndOfACurveHaveFourPoints)
{
  constexpr Index around = 12, rings = 12;
  std::vector<Vector3> points{ { 0, 0, rings } };
  std::vector<std::array<Index, 3>> triangles;
  for (Index ring = 1; ring <= rings; ++ring)
  {
    for (Index i = 0; i < around; ++i)
    {
      const double angle = 2 * kPi * i / around, radius = 0.12 * ring;
      points.emplace_back(
        radius * std::cos(angle), radius * std::sin(angle), double{ rings } - ring);
      const Index a = 1 + (ring - 1) * around + i, b = 1 + (ring - 1) * around + (i + 1) % around;
      const Index above = a - around, beside = b - around;
      triangles.push_back({ ring == 1 ? 0 : above, a, b });
      if (ring > 1)
      {
        triangles.push_back({ above, b, beside });
      }
    }
  }
  const Mesh cone = test::makeMesh(points, triangles);
  for (Index length = 2; length < rings; ++length)
  {
    for (const double edgeLength : { 1.0, 1.5 })
    {
      Mesh mesh = cone;
      const auto isOnLine = [&](Index v)
      { return v == 0 || (v % around == 1 && v < 1 + length * around); };
      for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
      {
        if (!mesh.isBoundary(h) && isOnLine(mesh.origin[h]) && isOnLine(mesh.target(h)))
        {
          mesh.flags.edit()[h] |= kFeatureEdge;
        }
      }
      FaceCurves curves(mesh, none(mesh), edgeLength);
      ASSERT_TRUE(curves.chooseNumbers().empty());
      const FilledFaces filled = fillFaces(mesh, curves, edgeLength);
      ASSERT_TRUE(filled.failedAt.empty());
      const QuadTopology topology = analyzeQuads(filled.quads.quads, filled.quads.points.size());
      EXPECT_TRUE(topology.manifold()) << length << ", " << edgeLength << ": " << topology.text();
    }
  }
}

/// Two plates that lie on each other, each with a curve between points of its boundary.
TEST(FaceCurves, CurvesEndAtPointsOfTheirOwnLoop)
{
  const Mesh plane = test::gridPlane(2, 2);
  Mesh mesh = test::disjointUnion(plane, plane, Vector3::Zero());
  std::vector<std::uint8_t> isGiven = none(mesh);
  std::vector<CurvePoint> points;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 from = mesh.position[mesh.origin[h]], to = mesh.position[mesh.target(h)];
    if (mesh.isBoundary(h))
    {
      isGiven[h] = 1;
      // Those of the first plate are nearer to the end of both curves.
      points.push_back({ h, Mesh::face(h) < plane.faceCount() ? 0.1 : 0.2 });
    }
    else if (from.x() == 1 && to.x() == 1)
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  FaceCurves curves(mesh, isGiven, 1);
  curves.setGiven(points);
  int atVertices = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const CurvePoint& point = curves.given()[i];
    EXPECT_EQ(Mesh::face(point.h) < plane.faceCount(), Mesh::face(points[i].h) < plane.faceCount());
    atVertices += point.t == 0 ? 1 : 0;
  }
  EXPECT_EQ(atVertices, 4);
}

/// Both curves end nearest to the same point, and the next one is on the same side.
TEST(FaceCurves, PointsThatAreLedToEndsStayInTheirOrder)
{
  Mesh mesh = test::gridPlane(4, 4);
  std::vector<std::uint8_t> isGiven = none(mesh);
  const std::vector<Vector3> places{ Vector3(2.4, 0, 0), Vector3(2.6, 0, 0), Vector3(3.5, 0, 0),
    Vector3(4, 2.5, 0), Vector3(3.5, 4, 0), Vector3(2, 4, 0), Vector3(1, 4, 0),
    Vector3(0, 2.5, 0) };
  std::vector<CurvePoint> points(places.size());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 from = mesh.position[mesh.origin[h]], way = mesh.edgeVector(h);
    const double x = from.x();
    if (!mesh.isBoundary(h))
    {
      mesh.flags.edit()[h] |= (x == 1 || x == 2) && way.x() == 0 ? kFeatureEdge : 0;
      continue;
    }
    isGiven[h] = 1;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const double t = (places[i] - from).dot(way) / way.squaredNorm();
      const bool isOn = t >= 0 && t < 1 && (from + t * way - places[i]).norm() < 1e-12;
      points[i] = isOn ? CurvePoint{ h, t } : points[i];
    }
  }
  FaceCurves curves(mesh, isGiven, 1);
  curves.setGiven(points);
  const auto placeOf = [&](std::size_t i) -> Vector3
  { return positionOf(mesh, curves.given()[i].onSurface()); };
  EXPECT_EQ(placeOf(0), Vector3(1, 0, 0));
  EXPECT_EQ(placeOf(1), Vector3(2, 0, 0));
  for (std::size_t i = 2; i < places.size(); ++i)
  {
    EXPECT_LT((placeOf(i) - places[i]).norm(), 1e-12);
  }
}

TEST(FilledFaces, ACubeIsClosedAndSharp)
{
  const Mesh mesh = test::markFeatures(test::unitCube(5), kThirtyDegrees);
  const FilledFaces filled = fillAll(mesh, 0.25);
  const test::IndependentCheck check(filled.quads);
  EXPECT_EQ(check.boundaryEdges, 0U);
  EXPECT_EQ(check.components, 1U);
  EXPECT_TRUE(check.oriented);
  EXPECT_TRUE(check.vertexManifold);
  EXPECT_EQ(static_cast<long long>(filled.quads.points.size() + filled.quads.quads.size()) -
      static_cast<long long>(check.edges),
    2);
  EXPECT_NEAR(static_cast<double>(filled.quads.quads.size()), 96, 10);
  EXPECT_EQ(filled.quads.lines.size(), 48U);
  EXPECT_TRUE(invertedQuads(filled.quads.points, filled.quads.quads).empty());
  expectOnFaces(mesh, filled.quads);
}

TEST(FilledFaces, ATetrahedronIsClosedWithOddNumbers)
{
  const Mesh mesh = tetrahedron();
  const FilledFaces filled = fillAll(mesh, std::sqrt(8.0) / 3);
  const test::IndependentCheck check(filled.quads);
  EXPECT_EQ(check.boundaryEdges, 0U);
  EXPECT_TRUE(check.oriented);
  EXPECT_TRUE(check.vertexManifold);
  EXPECT_TRUE(invertedQuads(filled.quads.points, filled.quads.quads).empty());
  expectOnFaces(mesh, filled.quads);
}

TEST(FilledFaces, GivenPointsComeFirstAndStay)
{
  const Mesh mesh = test::gridPlane(6, 6);
  std::vector<std::uint8_t> isGiven = none(mesh);
  std::vector<CurvePoint> points;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      isGiven[h] = 1;
      points.push_back({ h, 0.25 });
    }
  }
  FaceCurves curves(mesh, isGiven, 1);
  curves.setGiven(points);
  ASSERT_TRUE(curves.chooseNumbers().empty());
  const FilledFaces filled = fillFaces(mesh, curves, 1);
  ASSERT_TRUE(filled.failedAt.empty());
  const test::IndependentCheck check(filled.quads);
  EXPECT_EQ(check.boundaryEdges, points.size());
  EXPECT_EQ(check.boundaryLoops, 1U);
  ASSERT_EQ(filled.quads.lines.size(), points.size());
  for (const QuadLine& line : filled.quads.lines)
  {
    EXPECT_LT(std::max(line.a, line.b), points.size());
    EXPECT_FALSE(line.boundary); // there are quads beside
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    EXPECT_LT((filled.quads.points[i] - positionOf(mesh, points[i].onSurface())).norm(), 1e-12);
  }
  expectOnFaces(mesh, filled.quads);
}
