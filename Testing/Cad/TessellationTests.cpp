// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
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

} // namespace quadrille
