// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Cad/Curvatures.h"
#include "Cad/ShapeData.h"
#include "Cad/Tessellation.h"
#include "Shapes.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
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

void expectClosed(const CadSurface& surface)
{
  const MeshEdges edges = meshEdges(surface);
  EXPECT_EQ(edges.open, 0U);
  EXPECT_EQ(edges.crowded, 0U);
  EXPECT_EQ(edges.reversed, 0U);
}

} // namespace

TEST(Tessellation, EdgesOfABoxAreSharpAndTheSeamOfItsHoleIsNot)
{
  const CadSurface surface = tessellate(shapeOf(boxWithHole()));
  expectClosed(surface);
  EXPECT_EQ(count(surface, CadEdgeKind::Sharp), 14U);
  EXPECT_EQ(count(surface, CadEdgeKind::Seam), 1U);
  for (const CadEdge& edge : surface.edges)
  {
    EXPECT_NEAR(edge.angle, edge.kind == CadEdgeKind::Sharp ? std::acos(-1.0) / 2 : 0, 1e-9);
  }
  EXPECT_EQ(
    std::count(surface.surfaceKinds.begin(), surface.surfaceKinds.end(), CadSurfaceKind::Cylinder),
    1);
}

TEST(Tessellation, AFilletMeetsItsNeighboursTangentially)
{
  const CadSurface surface = tessellate(shapeOf(roundedCylinder()));
  expectClosed(surface);
  EXPECT_EQ(count(surface, CadEdgeKind::Tangent), 2U);
  EXPECT_EQ(count(surface, CadEdgeKind::Sharp), 1U); // round the bottom
  EXPECT_EQ(count(surface, CadEdgeKind::Seam), 2U);
}

TEST(Tessellation, PolesArePointsAndNoFeatures)
{
  const CadSurface ball = tessellate(shapeOf(BRepPrimAPI_MakeSphere(2).Shape()));
  expectClosed(ball);
  EXPECT_EQ(count(ball, CadEdgeKind::Pole), 2U);
  EXPECT_EQ(count(ball, CadEdgeKind::Sharp), 0U);
  const CadSurface cone = tessellate(shapeOf(BRepPrimAPI_MakeCone(1, 0, 2).Shape()));
  expectClosed(cone);
  EXPECT_EQ(count(cone, CadEdgeKind::Pole), 1U);
  EXPECT_EQ(count(cone, CadEdgeKind::Sharp), 1U);
  const CadSurface ring = tessellate(shapeOf(BRepPrimAPI_MakeTorus(2, 0.5).Shape()));
  expectClosed(ring);
  EXPECT_EQ(count(ring, CadEdgeKind::Seam), 2U);
}

/// The part of the area that triangles lack falls with the chord error, and the triangles are turned outwards.
TEST(Tessellation, AreaAndVolumeComeNearTheExactOnes)
{
  for (const TopoDS_Shape& shape : { boxWithHole(), roundedCylinder() })
  {
    TessellationOptions fine;
    fine.chordError = 1e-5;
    fine.angle = 0.05;
    const CadSurface surface = tessellate(shapeOf(shape), fine);
    EXPECT_NEAR(area(surface) / exactArea(shape), 1, 1e-3);
    EXPECT_NEAR(volume(surface) / exactVolume(shape), 1, 1e-3);
  }
}

TEST(Tessellation, MirroredShapesAreTurnedOutwards)
{
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
  const TopoDS_Shape shape = BRepBuilderAPI_Transform(boxWithHole(), mirror).Shape();
  const CadSurface surface = tessellate(shapeOf(shape));
  expectClosed(surface);
  EXPECT_NEAR(volume(surface), exactVolume(boxWithHole()), 0.02);
}

TEST(Tessellation, PolylinesOfEdgesAreEdgesOfTriangles)
{
  const CadSurface surface = tessellate(shapeOf(roundedCylinder()));
  std::vector<std::pair<Index, Index>> sides;
  for (const std::array<Index, 3>& t : surface.triangles)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      sides.emplace_back(std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3]));
    }
  }
  std::sort(sides.begin(), sides.end());
  for (const CadEdge& edge : surface.edges)
  {
    for (std::size_t i = 0; i + 1 < edge.points.size(); ++i)
    {
      const std::pair<Index, Index> side(
        std::min(edge.points[i], edge.points[i + 1]), std::max(edge.points[i], edge.points[i + 1]));
      EXPECT_TRUE(std::binary_search(sides.begin(), sides.end(), side));
      EXPECT_LT(edge.parameters[i], edge.parameters[i + 1]);
    }
  }
}

TEST(Tessellation, OptionsOutOfTheirRangeAreRefused)
{
  const CadShape shape = shapeOf(boxWithHole());
  TessellationOptions options;
  options.chordError = 0;
  EXPECT_THROW(tessellate(shape, options), InvalidInput);
  options = {};
  options.angle = 2;
  EXPECT_THROW(tessellate(shape, options), InvalidInput);
  EXPECT_THROW(tessellate(CadShape()), InvalidInput);
}

/// Of each face the least and the largest curvature at corners of its triangles.
std::vector<std::array<float, 2>> curvatureRanges(const CadShape& shape, CadSurface& surface)
{
  addCurvatures(shape, surface);
  std::vector<std::array<float, 2>> ranges(shape.faceCount(), { 1e30F, 0 });
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    for (const float curvature : surface.curvatures[t])
    {
      auto& [least, most] = ranges[surface.faceOf[t]];
      least = std::min(least, curvature);
      most = std::max(most, curvature);
    }
  }
  return ranges;
}

void expectCurvature(const TopoDS_Shape& of, CadSurfaceKind kind, double least, double most)
{
  const CadShape shape = shapeOf(of);
  CadSurface surface = tessellate(shape);
  const auto ranges = curvatureRanges(shape, surface);
  std::size_t faces = 0;
  for (std::size_t f = 0; f < ranges.size(); ++f)
  {
    if (surface.surfaceKinds[f] == kind)
    {
      ++faces;
      EXPECT_NEAR(ranges[f][0], least, 1e-6 * most);
      EXPECT_NEAR(ranges[f][1], most, 1e-6 * most);
    }
  }
  EXPECT_GT(faces, 0U);
}

TEST(Tessellation, CurvaturesAreThoseOfRadii)
{
  expectCurvature(boxWithHole(), CadSurfaceKind::Cylinder, 2, 2);
  expectCurvature(boxWithHole(), CadSurfaceKind::Plane, 0, 0);
  expectCurvature(roundedCylinder(), CadSurfaceKind::Torus, 4, 4);
  expectCurvature(BRepPrimAPI_MakeTorus(2, 0.5).Shape(), CadSurfaceKind::Torus, 2, 2);
  expectCurvature(
    BRepPrimAPI_MakeSphere(4).Shape(), CadSurfaceKind::Sphere, 0.25, 0.25); // at poles, too
  // From radius 1 to 0.5 over a height of 1: over the distance from the axis along the normal.
  const double slope = std::hypot(1, 0.5);
  expectCurvature(
    BRepPrimAPI_MakeCone(1, 0.5, 1).Shape(), CadSurfaceKind::Cone, 1 / slope, 2 / slope);
}

TEST(Tessellation, CurvaturesOfEdgesAreThoseOfTheirCurves)
{
  const CadShape shape = shapeOf(boxWithHole());
  CadSurface surface = tessellate(shape);
  addCurvatures(shape, surface);
  std::size_t round = 0;
  for (const CadEdge& edge : surface.edges)
  {
    ASSERT_EQ(edge.curvatures.size() + 1, edge.points.size());
    const bool isRim = edge.points.size() > 2 && edge.kind == CadEdgeKind::Sharp;
    round += isRim ? 1 : 0;
    for (const float curvature : edge.curvatures)
    {
      EXPECT_NEAR(curvature, isRim ? 2 : 0, 1e-6);
    }
  }
  EXPECT_EQ(round, 2U);
}

} // namespace quadrille
