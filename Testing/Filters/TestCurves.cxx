// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleCurves.h"
#include "TestSurfaces.h"

#include "Base/Error.h"

#include <vtkCellData.h>
#include <vtkIntArray.h>

#include <gtest/gtest.h>

namespace quadrille
{
namespace
{

vtkSmartPointer<vtkPolyData> polyline(const std::vector<Vector3>& points)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(points.size()));
  for (const Vector3& p : points)
  {
    lines->InsertCellPoint(coordinates->InsertNextPoint(p.data()));
  }
  data->SetPoints(coordinates);
  data->SetLines(lines);
  return data;
}

/// Marked edges as pairs of points, each seen from every polygon that has it.
std::map<std::pair<Index, Index>, int> markedEdges(const ConvertedSurface& surface)
{
  std::map<std::pair<Index, Index>, int> edges;
  for (std::size_t p = 0; p < surface.input.featureEdges.size(); ++p)
  {
    for (Index i = 0; i < 3; ++i)
    {
      if ((surface.input.featureEdges[p] >> i) & 1)
      {
        const Index a = surface.input.polygonPoints[3 * p + i];
        const Index b = surface.input.polygonPoints[3 * p + (i + 1) % 3];
        ++edges[{ std::min(a, b), std::max(a, b) }];
      }
    }
  }
  return edges;
}

TEST(Curves, FollowsAGridLineFromBothSides)
{
  const Mesh mesh = test::gridPlane(8, 8);
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(mesh);
  ConvertedSurface surface = convertSurface(data, "");
  double bounds[6];
  data->GetBounds(bounds);
  const double y = 0.5 * (bounds[2] + bounds[3]);
  // Slightly off the grid line and off the plane: it is projected.
  const auto notices = applyCurves(
    surface, data, polyline({ { bounds[0], y + 0.01, 0.02 }, { bounds[1], y - 0.01, 0.02 } }));
  EXPECT_TRUE(notices.empty());
  const auto edges = markedEdges(surface);
  EXPECT_EQ(edges.size(), 8u);
  for (const auto& [edge, uses] : edges)
  {
    EXPECT_EQ(uses, 2);
    EXPECT_NEAR(mesh.position[edge.first].y(), y, 1e-12);
    EXPECT_NEAR(mesh.position[edge.second].y(), y, 1e-12);
  }
  EXPECT_EQ(surface.curveMarks.size(), 16u);
}

TEST(Curves, OtherTypesAreRefused)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  const vtkSmartPointer<vtkPolyData> curve = polyline({ { 0, 0, 0 }, { 1, 0, 0 } });
  vtkNew<vtkIntArray> type;
  type->SetName("ConstraintType");
  type->InsertNextValue(0);
  curve->GetCellData()->AddArray(type);
  ConvertedSurface surface = convertSurface(data, "");
  EXPECT_NO_THROW(applyCurves(surface, data, curve));
  type->SetValue(0, 3);
  EXPECT_THROW(applyCurves(surface, data, curve), InvalidInput);
}

TEST(Curves, StrokesGuideThePolygonsTheyRunOver)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(8, 8));
  const vtkSmartPointer<vtkPolyData> curve = polyline({ { 0, 4, 0 }, { 4, 4, 0 }, { 8, 4, 0 } });
  vtkNew<vtkIntArray> type;
  type->SetName("ConstraintType");
  type->InsertNextValue(1);
  curve->GetCellData()->AddArray(type);
  ConvertedSurface surface = convertSurface(data, "");
  applyCurves(surface, data, curve);
  EXPECT_TRUE(surface.curveMarks.empty());
  EXPECT_TRUE(surface.input.featureEdges.empty());
  ASSERT_EQ(surface.input.guideDirections.size(), 128u);
  std::size_t guided = 0;
  for (std::size_t i = 0; i < 128; ++i)
  {
    bool touches = false; // two corners on the line
    int onLine = 0;
    for (int k = 0; k < 3; ++k)
    {
      onLine += surface.input.points[surface.input.polygonPoints[3 * i + k]].y() == 4;
    }
    touches = onLine == 2;
    guided += touches;
    EXPECT_EQ(surface.input.guideDirections[i], touches ? Vector3(1, 0, 0) : Vector3(0, 0, 0));
  }
  EXPECT_EQ(guided, 16u);
}

TEST(Curves, NoPathBetweenComponentsIsAnError)
{
  const Mesh mesh =
    test::disjointUnion(test::gridPlane(2, 2), test::gridPlane(2, 2), Vector3(0, 0, 5));
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(mesh);
  ConvertedSurface surface = convertSurface(data, "");
  EXPECT_THROW(applyCurves(surface, data, polyline({ { 0, 0, 0 }, { 0, 0, 5 } })), InvalidInput);
}

TEST(Curves, FarFromTheSurfaceIsTold)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  ConvertedSurface surface = convertSurface(data, "");
  const auto notices = applyCurves(surface, data, polyline({ { 0, 0, 50 }, { 1, 1, 50 } }));
  EXPECT_EQ(notices.size(), 1u);
}

} // namespace
} // namespace quadrille
