// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/InPieces.h"

#include "TestSurfaces.h"

#include "vtkQuadRemesh.h"

#include <vtkCellArray.h>
#include <vtkCellCenters.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace quadrille
{
namespace
{

/// A fine sphere with the height at its points and the number of each cell.
vtkSmartPointer<vtkPolyData> sphereWithArrays(int type)
{
  vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::sphere(5));
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  points->DeepCopy(data->GetPoints());
  data->SetPoints(points);
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    height->InsertNextValue(data->GetPoint(i)[2]);
  }
  data->GetPointData()->AddArray(height);
  vtkNew<vtkIdTypeArray> number;
  number->SetName("Number");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    number->InsertNextValue(i);
  }
  data->GetCellData()->AddArray(number);
  return data;
}

void setUp(vtkQuadRemesh* filter, vtkPolyData* input)
{
  filter->SetInputData(input);
  filter->SetTargetType(vtkQuadRemesh::TARGET_NUMBER_OF_QUADS);
  filter->SetNumberOfQuads(300);
  filter->ComputeMappedSurfaceOff();
  filter->SetPieces(vtkQuadRemesh::PIECES_ALWAYS);
}

TEST(InPieces, QuadsHaveTheArraysOfTheSurface)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    const vtkSmartPointer<vtkPolyData> input = sphereWithArrays(type);
    vtkNew<vtkQuadRemesh> filter;
    setUp(filter, input);
    filter->Update();
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    vtkPolyData* quads = filter->GetOutput();
    EXPECT_GT(quads->GetNumberOfPolys(), 200);
    vtkDataArray* height = quads->GetPointData()->GetArray("Height");
    ASSERT_NE(height, nullptr);
    for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
    {
      // Heights are linear, so what is interpolated is the point's own.
      EXPECT_NEAR(height->GetTuple1(i), quads->GetPoint(i)[2], 1e-6);
      const double* p = quads->GetPoint(i);
      EXPECT_NEAR(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 1, 2e-3);
    }
    vtkDataArray* number = quads->GetCellData()->GetArray("Number");
    vtkDataArray* source = quads->GetCellData()->GetArray("SourceCellId");
    ASSERT_NE(number, nullptr);
    ASSERT_NE(source, nullptr);
    vtkNew<vtkCellCenters> ofInput, ofQuads;
    ofInput->SetInputData(input);
    ofInput->Update();
    ofQuads->SetInputData(quads);
    ofQuads->Update();
    for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
    {
      EXPECT_EQ(number->GetTuple1(i), source->GetTuple1(i));
      double a[3], b[3];
      ofInput->GetOutput()->GetPoint(static_cast<vtkIdType>(source->GetTuple1(i)), a);
      ofQuads->GetOutput()->GetPoint(i, b);
      // Within the triangle's size, and the sagitta of a quad.
      EXPECT_LT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 0.1);
    }
  }
}

TEST(InPieces, VerticesAndLinesShiftTheCells)
{
  const vtkSmartPointer<vtkPolyData> input = sphereWithArrays(VTK_FLOAT);
  input->GetCellData()->Initialize();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1 });
  lines->InsertNextCell({ 1, 2 });
  input->SetLines(lines);
  vtkNew<vtkQuadRemesh> filter;
  setUp(filter, input);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_NE(
    std::string(filter->GetNoticesText()).find("2 vertex and line cells"), std::string::npos);
  vtkDataArray* source = filter->GetOutput()->GetCellData()->GetArray("SourceCellId");
  for (vtkIdType i = 0; i < source->GetNumberOfTuples(); ++i)
  {
    EXPECT_GE(source->GetTuple1(i), 2);
    EXPECT_LT(source->GetTuple1(i), input->GetNumberOfCells());
  }
}

std::string failureOfPieces(vtkQuadRemesh* filter)
{
  filter->SetGlobalWarningDisplay(0);
  filter->Update();
  filter->SetGlobalWarningDisplay(1);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  return filter->GetOutcomeText();
}

TEST(InPieces, SaysWhatNeedsTheWholeSurface)
{
  const vtkSmartPointer<vtkPolyData> input = sphereWithArrays(VTK_FLOAT);
  const auto reason = [&](const auto& change)
  {
    vtkNew<vtkQuadRemesh> filter;
    setUp(filter, input);
    change(filter.Get());
    return failureOfPieces(filter);
  };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(
    has(reason([](vtkQuadRemesh* filter) { filter->ComputeMappedSurfaceOn(); }), "mapped surface"));
  EXPECT_TRUE(
    has(reason([](vtkQuadRemesh* filter) { filter->SetSymmetry(vtkQuadRemesh::SYMMETRY_FOUND); }),
      "symmetric quads"));
  EXPECT_TRUE(has(reason([](vtkQuadRemesh* filter)
                    { filter->SetCellDataFrom(vtkQuadRemesh::CELL_DATA_FROM_AREA); }),
    "by area"));
  EXPECT_TRUE(has(reason([&](vtkQuadRemesh* filter) { filter->SetStrokesData(input); }),
    "constraints are drawn"));
  EXPECT_TRUE(has(reason(
                    [&](vtkQuadRemesh* filter)
                    {
                      vtkNew<vtkPolyData> sized;
                      sized->ShallowCopy(input);
                      vtkNew<vtkDoubleArray> sizing;
                      sizing->SetName("Sizing");
                      sizing->SetNumberOfTuples(sized->GetNumberOfPoints());
                      sizing->Fill(1);
                      sized->GetPointData()->AddArray(sizing);
                      filter->SetInputData(sized);
                    }),
    "Sizing"));
  EXPECT_TRUE(has(reason(
                    [&](vtkQuadRemesh* filter)
                    {
                      vtkNew<vtkPolyData> patched;
                      patched->ShallowCopy(input);
                      vtkNew<vtkIntArray> material;
                      material->SetName("Material");
                      material->SetNumberOfTuples(patched->GetNumberOfCells());
                      material->Fill(1);
                      patched->GetCellData()->AddArray(material);
                      filter->SetPatchArrayName("Material");
                      filter->SetInputData(patched);
                    }),
    "Material"));
  // Automatic leaves a surface of this size whole.
  vtkNew<vtkQuadRemesh> filter;
  setUp(filter, input);
  filter->SetPieces(vtkQuadRemesh::PIECES_AUTOMATIC);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(std::string(filter->GetNoticesText()).find("pieces"), std::string::npos);
}

/// Surfaces that are put into an order of their own read all ids first.
TEST(InPieces, AnIdOutOfRangeIsAnError)
{
  for (const int pieces : { vtkQuadRemesh::PIECES_ALWAYS, vtkQuadRemesh::PIECES_NEVER })
  {
    for (const vtkIdType id : { vtkIdType{ -1 }, vtkIdType{ 1000000 } })
    {
      const vtkSmartPointer<vtkPolyData> input = sphereWithArrays(VTK_FLOAT);
      input->GetPolys()->ReplaceCellAtId(7, 3, std::array<vtkIdType, 3>{ 0, 1, id }.data());
      vtkNew<vtkQuadRemesh> filter;
      setUp(filter, input);
      filter->SetPieces(pieces);
      filter->SetRankIndependent(
        pieces == vtkQuadRemesh::PIECES_NEVER ? vtkQuadRemesh::Always : vtkQuadRemesh::Never);
      EXPECT_NE(failureOfPieces(filter).find(" 7 "), std::string::npos) << filter->GetOutcomeText();
    }
  }
}

TEST(InPieces, OnlyTrianglesAreSources)
{
  const vtkSmartPointer<vtkPolyData> input = sphereWithArrays(VTK_FLOAT);
  EXPECT_NE(trianglesOf(input), nullptr);
  input->GetPolys()->ConvertTo32BitStorage();
  const auto triangles = trianglesOf(input);
  ASSERT_NE(triangles, nullptr);
  EXPECT_EQ(triangles->triangleCount(), static_cast<std::size_t>(input->GetNumberOfPolys()));
  input->GetPolys()->InsertNextCell({ 0, 1, 2, 3 });
  EXPECT_EQ(trianglesOf(input), nullptr);
  vtkNew<vtkPolyData> empty;
  EXPECT_EQ(trianglesOf(empty), nullptr);
}

} // namespace
} // namespace quadrille
