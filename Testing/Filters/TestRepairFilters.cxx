// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestSurfaces.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkSurfaceRepair.h>
#include <vtkSurfaceWrap.h>

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille
{
namespace
{

/// Two unit spheres whose centres are 1 apart, with the cell array Ball (0 or 1) and the point array X.
vtkSmartPointer<vtkPolyData> twoBalls()
{
  const Mesh mesh = test::disjointUnion(test::sphere(3), test::sphere(3), { 1, 0.01, 0.02 });
  auto data = test::toPolyData(mesh);
  vtkNew<vtkIntArray> ball;
  ball->SetName("Ball");
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    ball->InsertNextValue(2 * f < mesh.faceCount() ? 0 : 1);
  }
  data->GetCellData()->AddArray(ball);
  vtkNew<vtkFloatArray> x;
  x->SetName("X");
  for (const Vector3& p : mesh.position)
  {
    x->InsertNextValue(static_cast<float>(p.x()));
  }
  data->GetPointData()->AddArray(x);
  return data;
}

double fieldValue(vtkPolyData* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array ? array->GetTuple1(0) : std::nan("");
}

TEST(SurfaceWrapFilter, CarriesArraysFromTheNearestPlace)
{
  vtkNew<vtkSurfaceWrap> filter;
  filter->SetInputData(twoBalls());
  filter->SetAlpha(0.2);
  filter->SetOffset(0.02);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkPolyData* wrap = filter->GetOutput();
  EXPECT_EQ(fieldValue(wrap, "WrapAlpha"), 0.2);
  EXPECT_EQ(fieldValue(wrap, "WrapOffset"), 0.02);
  vtkDataArray* x = wrap->GetPointData()->GetArray("X");
  vtkDataArray* ball = wrap->GetCellData()->GetArray("Ball");
  ASSERT_TRUE(x && ball);
  for (vtkIdType i = 0; i < wrap->GetNumberOfPoints(); ++i)
  {
    // Points lie at the offset, to a hundredth; the nearest place is no farther away along x.
    EXPECT_NEAR(x->GetTuple1(i), wrap->GetPoint(i)[0], 1.02 * 0.02);
  }
  for (vtkIdType i = 0; i < wrap->GetNumberOfCells(); ++i)
  {
    const double* bounds = wrap->GetCell(i)->GetBounds();
    // The balls meet in a circle at x = 1/2, where triangles of the size alpha join both.
    if (bounds[1] < 0.2 || bounds[0] > 0.8)
    {
      EXPECT_EQ(ball->GetTuple1(i), bounds[1] < 0.2 ? 0 : 1);
    }
  }
  EXPECT_NE(std::string(filter->GetResultText()).find("triangles"), std::string::npos);
}

TEST(SurfaceWrapFilter, RefusesASmallAlphaAndKeepsThePreviousResult)
{
  vtkNew<vtkSurfaceWrap> filter;
  filter->SetInputData(twoBalls());
  filter->SetAlpha(0.3);
  filter->Update();
  const vtkIdType before = filter->GetOutput()->GetNumberOfPolys();
  ASSERT_GT(before, 0);
  const test::Messages messages(filter);
  filter->SetAlpha(1e-8);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(filter->GetOutcomeText()).find("alpha"), std::string::npos);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), before);
}

TEST(SurfaceWrapFilter, TakesComposites)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetNumberOfBlocks(2);
  blocks->SetBlock(0, twoBalls());
  blocks->SetBlock(1, test::toPolyData(test::torus(20, 10)));
  vtkNew<vtkSurfaceWrap> filter;
  filter->SetInputData(blocks);
  filter->SetAlpha(0.3);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  auto* result = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(result);
  for (const unsigned block : { 0u, 1u })
  {
    auto* wrap = vtkPolyData::SafeDownCast(result->GetBlock(block));
    ASSERT_TRUE(wrap);
    EXPECT_EQ(wrap->GetNumberOfPoints() - wrap->GetNumberOfPolys() / 2, block == 0 ? 2 : 0);
  }
}

TEST(SurfaceRepairFilter, MarksWhatCrosses)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputData(twoBalls());
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkPolyData* surface = filter->GetOutput();
  EXPECT_EQ(fieldValue(surface, "Components"), 2);
  EXPECT_GT(fieldValue(surface, "SelfIntersections"), 0);
  vtkDataArray* marks = surface->GetCellData()->GetArray("SelfIntersecting");
  vtkDataArray* ball = surface->GetCellData()->GetArray("Ball");
  ASSERT_TRUE(marks && ball);
  EXPECT_EQ(marks->GetRange()[1], 1);
  for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i)
  {
    EXPECT_EQ(ball->GetTuple1(i), 2 * i < surface->GetNumberOfCells() ? 0 : 1);
  }
  EXPECT_NE(std::string(filter->GetNoticesText()).find("cross each other"), std::string::npos);
  filter->FindSelfIntersectionsOff();
  filter->Update();
  EXPECT_EQ(fieldValue(filter->GetOutput(), "SelfIntersections"), -1);
  EXPECT_FALSE(filter->GetOutput()->GetCellData()->HasArray("SelfIntersecting"));
}

TEST(SurfaceRepairFilter, FillsHoles)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputData(test::toPolyData(test::openCylinder(16, 4)));
  filter->Update();
  EXPECT_EQ(fieldValue(filter->GetOutput(), "OpenBoundaries"), 2);
  filter->SetFillHolesBelow(7); // the circles have length 2 pi
  filter->Update();
  EXPECT_EQ(fieldValue(filter->GetOutput(), "FilledHoles"), 2);
  EXPECT_EQ(fieldValue(filter->GetOutput(), "OpenBoundaries"), 0);
  EXPECT_EQ(filter->GetOutput()->GetCellData()->GetArray("Filling")->GetRange()[1], 1);
}

} // namespace
} // namespace quadrille
