// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Placement.h"
#include "Cad/ShapeData.h"
#include "Cad/VertexNodes.h"
#include "Shapes.h"

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

CadShape shapeOf(const TopoDS_Shape& shape)
{
  return CadShape(std::make_shared<const CadShape::Data>(shape));
}

/// Measured by Open CASCADE's own search, which knows nothing of triangles.
double distance(const TopoDS_Shape& shape, const Vector3& p)
{
  const BRepExtrema_DistShapeShape search(
    BRepBuilderAPI_MakeVertex(gp_Pnt(p.x(), p.y(), p.z())).Vertex(), shape);
  return search.Value();
}

/// Middles of the edges and centres of the triangles, and their corners.
std::vector<Vector3> samples(const CadSurface& surface)
{
  std::vector<Vector3> points = surface.points;
  for (const auto& [a, b, c] : surface.triangles)
  {
    const std::vector<Vector3>& p = surface.points;
    points.push_back((p[a] + p[b] + p[c]) / 3);
    points.push_back((p[a] + p[b]) / 2);
  }
  return points;
}

} // namespace

TEST(Placement, PointsComeOntoTheExactShape)
{
  for (const TopoDS_Shape& exact : { boxWithHole(), roundedCylinder(),
         BRepPrimAPI_MakeSphere(2).Shape(), BRepPrimAPI_MakeTorus(2, 0.5).Shape() })
  {
    const CadShape shape = shapeOf(exact);
    const CadSurface surface = tessellate(shape);
    const std::vector<Vector3> points = samples(surface);
    const std::vector<CadPlace> places = placeOnShape(shape, surface, points);
    double before = 0;
    for (std::size_t i = 0; i < points.size(); i += 7) // the search is slow
    {
      ASSERT_NE(places[i].kind, CadPlaceKind::None);
      before = std::max(before, distance(exact, points[i]));
      EXPECT_LT(distance(exact, places[i].point), 1e-9 * shape.diagonal());
    }
    EXPECT_GT(before, 1e-5 * shape.diagonal()); // else nothing was to be done
  }
}

TEST(Placement, PointsOfEdgesStayOnTheirCurvesAndCornersOnVertices)
{
  const CadShape shape = shapeOf(boxWithHole());
  const CadSurface surface = tessellate(shape);
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    const CadEdge& edge = surface.edges[e];
    if (edge.kind != CadEdgeKind::Sharp)
    {
      continue;
    }
    const Vector3 middle = (surface.points[edge.points[0]] + surface.points[edge.points[1]]) / 2;
    const CadPlace place = placeOnShape(shape, surface, { middle }).front();
    EXPECT_EQ(place.kind, CadPlaceKind::Edge);
    EXPECT_EQ(place.id, e);
    EXPECT_LT(distance(shape.data()->edges(static_cast<int>(e) + 1), place.point), 1e-12);
    const CadPlace end = placeOnShape(shape, surface, { surface.points[edge.points[0]] }).front();
    EXPECT_EQ(end.kind, CadPlaceKind::Vertex);
    EXPECT_EQ(end.point, surface.points[edge.points[0]]);
  }
}

/// Chords of a hole cut into it: what lies beyond the border of the plane goes onto the circle.
TEST(Placement, NoPointLeavesItsFace)
{
  const CadShape shape = shapeOf(boxWithHole());
  TessellationOptions coarse;
  coarse.chordError = 0.02;
  coarse.angle = 1;
  const CadSurface surface = tessellate(shape, coarse);
  std::size_t onCircle = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    if (surface.surfaceKinds[surface.faceOf[t]] != CadSurfaceKind::Plane)
    {
      continue;
    }
    const std::array<Index, 3>& c = surface.triangles[t];
    for (std::size_t i = 0; i < 3; ++i)
    {
      // Just beside the middle of a side, within the triangle.
      const Vector3& a = surface.points[c[i]];
      const Vector3& b = surface.points[c[(i + 1) % 3]];
      const Vector3 p = 0.999 * (a + b) / 2 + 0.001 * surface.points[c[(i + 2) % 3]];
      const CadPlace place = placeOnShape(shape, surface, { p }).front();
      ASSERT_NE(place.kind, CadPlaceKind::None);
      const double radius = std::hypot(place.point.x() - 2, place.point.y() - 1.5);
      EXPECT_GT(radius, 0.5 - 1e-6);
      onCircle += place.kind == CadPlaceKind::Edge ? 1 : 0;
    }
  }
  EXPECT_GT(onCircle, 0U);
}

TEST(Placement, NormalsAndCurvaturesAreThoseOfTheShape)
{
  const CadShape ball = shapeOf(BRepPrimAPI_MakeSphere(2).Shape());
  const CadSurface surface = tessellate(ball);
  for (const CadPlace& place : placeOnShape(ball, surface, samples(surface)))
  {
    if (place.normal.isZero())
    {
      EXPECT_NEAR(std::abs(place.point.z()), 2, 1e-6); // the poles alone have none
      continue;
    }
    EXPECT_LT((place.normal - place.point / 2).norm(), 1e-6);
    // 1 / radius, away from the normal; the root of the difference of both loses half the digits.
    EXPECT_NEAR(place.curvatures[0], -0.5, 1e-5);
    EXPECT_NEAR(place.curvatures[1], -0.5, 1e-5);
  }
}

/// Side by side: they have edges that are divided where nothing bends.
CadShape twoBoxes()
{
  return shapeOf(BRepAlgoAPI_Fuse(BRepPrimAPI_MakeBox(1, 1, 1).Shape(),
    BRepPrimAPI_MakeBox(gp_Pnt(1, 0, 0), gp_Pnt(2, 1, 1)).Shape())
                   .Shape());
}

/// Where parts touch a point goes onto the one that it is of.
TEST(Placement, PointsOfPartsThatTouchStayOnTheirPart)
{
  BRep_Builder builder;
  TopoDS_Compound both;
  builder.MakeCompound(both);
  builder.Add(both, BRepPrimAPI_MakeBox(1, 1, 1).Shape());
  builder.Add(both, BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 1), gp_Pnt(1, 1, 2)).Shape());
  const CadShape shape = shapeOf(both);
  const CadSurface surface = tessellate(shape);
  const std::vector<Vector3> points{ { 0, 0, 1 }, { 0.3, 0, 1 }, { 0.3, 0.4, 1 } };
  const std::array<std::size_t, 3> ofOneBox{ 8, 12, 6 }; // vertices, edges, faces
  for (const Index part : { 0, 1 })
  {
    const Index face = 6 * part; // of either box one
    const std::vector<CadPlace> places =
      placeOnShape(shape, surface, points, {}, std::vector<Index>(3, face));
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_EQ(places[i].kind, static_cast<CadPlaceKind>(3 - i));
      EXPECT_EQ(places[i].id / ofOneBox[i], part);
      EXPECT_EQ(places[i].face / 6, part);
      EXPECT_EQ(places[i].point, points[i]);
    }
    EXPECT_EQ(places[2].normal, Vector3(0, 0, part == 0 ? 1 : -1));
  }
  // A face that the shape does not have, or none, leaves the choice open.
  for (const Index face : { Index{ 99 }, kInvalidIndex })
  {
    EXPECT_EQ(placeOnShape(shape, surface, { points[0] }, {}, { face }).front().point, points[0]);
  }
}

TEST(Placement, VerticesWithinStraightLinesGetNodes)
{
  const CadShape shape = twoBoxes();
  const CadSurface surface = tessellate(shape);
  const std::vector<Vector3> points{ { 0, 0, 0 }, { 0.8, 0, 0 }, { 1.5, 0, 0 }, { 2, 0, 0 },
    { 0, 0, 0.5 }, { 0.8, 0, 0.5 }, { 1.5, 0, 0.5 }, { 2, 0, 0.5 } };
  const std::vector<std::array<Index, 4>> quads{ { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 } };
  std::vector<CadPlace> places = placeOnShape(shape, surface, points);
  EXPECT_EQ(places[1].kind, CadPlaceKind::Edge);
  // Nodes 4 and 7, on upright edges, go to the upper ends of these, for which this strip has no others.
  const TakenVertices taken = takeVertices(shape, surface, quads, places);
  EXPECT_EQ(taken.taken, 3U);
  EXPECT_TRUE(taken.beside.empty());
  EXPECT_EQ(places[1].kind, CadPlaceKind::Vertex);
  EXPECT_EQ(places[1].point, Vector3(1, 0, 0));
  EXPECT_EQ(places[2].point, points[2]);
  EXPECT_EQ(takeVertices(shape, surface, quads, places).taken, 0U);
}

/// Quads so flat that one node alone would shear those beside it go along, up to the third row.
TEST(Placement, NodesBesideAVertexMakeRoom)
{
  const CadShape shape = twoBoxes();
  const CadSurface surface = tessellate(shape);
  constexpr Index kColumns = 9, kRows = 4;
  std::vector<Vector3> points;
  std::vector<std::array<Index, 4>> quads;
  for (Index j = 0; j <= kRows; ++j)
  {
    for (Index i = 0; i <= kColumns; ++i)
    {
      points.emplace_back(2.0 * i / kColumns, 0, 0.05 * j);
      if (i < kColumns && j < kRows)
      {
        const Index at = j * (kColumns + 1) + i;
        quads.push_back({ at, at + 1, at + kColumns + 2, at + kColumns + 1 });
      }
    }
  }
  std::vector<CadPlace> places = placeOnShape(shape, surface, points);
  const TakenVertices taken = takeVertices(shape, surface, quads, places);
  EXPECT_EQ(taken.taken, 1U);
  EXPECT_GT(taken.beside.size(), 6U);
  const auto atVertex = std::find_if(places.begin(), places.end(),
    [](const CadPlace& place) { return place.point == Vector3(1, 0, 0); });
  ASSERT_NE(atVertex, places.end());
  EXPECT_EQ(atVertex->kind, CadPlaceKind::Vertex);
  for (Index i = 0; i <= kColumns; ++i) // the first row keeps its order, the last one its places
  {
    EXPECT_TRUE(i == 0 || places[i - 1].point.x() < places[i].point.x() - 0.1);
    EXPECT_EQ(places[i].point.tail<2>(), Eigen::Vector2d(0, 0));
    const Index last = kRows * (kColumns + 1) + i;
    EXPECT_EQ(places[last].point, points[last]);
  }
  // All others of the boxes are too far away for this strip.
  EXPECT_EQ(taken.without.size(), 9U);
}

TEST(Placement, QuadsThatWouldBeTurnedOverStay)
{
  const std::vector<Vector3> before{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  std::vector<CadPlace> places(4);
  for (Index i = 0; i < 4; ++i)
  {
    places[i].kind = CadPlaceKind::Face;
    places[i].id = 0;
    places[i].point = before[i];
  }
  std::vector<CadPlace> good = places;
  good[0].point = { 0.1, 0.1, 0 };
  keepQuads({ { 0, 1, 2, 3 } }, before, good);
  EXPECT_EQ(good[0].kind, CadPlaceKind::Face);
  places[0].point = { 0.8, 0.9, 0 };
  keepQuads({ { 0, 1, 2, 3 } }, before, places);
  EXPECT_EQ(places[0].kind, CadPlaceKind::None);
  EXPECT_EQ(places[0].point, before[0]);
}

TEST(Placement, WhatIsFarStaysAndIsMarked)
{
  const CadShape shape = shapeOf(boxWithHole());
  const CadSurface surface = tessellate(shape);
  const Vector3 far(2, 1.5, 5);
  const CadPlace place = placeOnShape(shape, surface, { far }).front();
  EXPECT_EQ(place.kind, CadPlaceKind::None);
  EXPECT_EQ(place.point, far);
}

} // namespace quadrille
