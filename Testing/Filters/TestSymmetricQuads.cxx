// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestSurfaces.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkQuadRemesh.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace quadrille
{
namespace
{

using Corners = std::array<vtkIdType, 4>;

/// A torus with x as a point array, and the cell's own id as a cell array.
vtkSmartPointer<vtkPolyData> ringWithArrays()
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::torus(48, 24));
  vtkNew<vtkDoubleArray> place;
  place->SetName("Place");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    place->InsertNextValue(data->GetPoint(i)[0]);
  }
  data->GetPointData()->AddArray(place);
  vtkNew<vtkDoubleArray> side;
  side->SetName("Side");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    side->InsertNextValue(test::cellCentre(data, i).x() > 0 ? 1 : -1);
  }
  data->GetCellData()->AddArray(side);
  return data;
}

vtkSmartPointer<vtkQuadRemesh> symmetricRun(vtkPolyData* data)
{
  auto remesh = vtkSmartPointer<vtkQuadRemesh>::New();
  remesh->SetInputData(data);
  remesh->SetNumberOfQuads(600);
  remesh->SetNumberOfThreads(2);
  remesh->SetSymmetryToPlane();
  return remesh;
}

Corners cornersOfCell(vtkPolyData* quads, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  quads->GetCellPoints(cell, ids);
  return { ids->GetId(0), ids->GetId(1), ids->GetId(2), ids->GetId(3) };
}

Corners lowestFirst(Corners quad)
{
  std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  return quad;
}

void expectMirrorPoints(vtkPolyData* quads)
{
  vtkDataArray* image = quads->GetPointData()->GetArray("MirrorPoint");
  ASSERT_NE(image, nullptr);
  const auto imageOf = [image](vtkIdType p) { return static_cast<vtkIdType>(image->GetTuple1(p)); };
  std::set<Corners> all;
  for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
  {
    all.insert(lowestFirst(cornersOfCell(quads, i)));
  }
  for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
  {
    const Corners q = cornersOfCell(quads, i);
    EXPECT_EQ(
      all.count(lowestFirst({ imageOf(q[0]), imageOf(q[3]), imageOf(q[2]), imageOf(q[1]) })), 1U);
  }
  const double* normal = quads->GetFieldData()->GetArray("SymmetryNormal")->GetTuple3(0);
  const Vector3 n(normal);
  const Vector3 o(quads->GetFieldData()->GetArray("SymmetryOrigin")->GetTuple3(0));
  for (vtkIdType p = 0; p < quads->GetNumberOfPoints(); ++p)
  {
    EXPECT_EQ(imageOf(imageOf(p)), p);
    const Vector3 a(quads->GetPoint(p));
    const Vector3 b(quads->GetPoint(imageOf(p)));
    // The torus is 2.8 wide; 1e-12 of its diagonal.
    EXPECT_LE((a - 2 * n.dot(a - o) * n - b).norm(), 4e-12);
  }
}

TEST(SymmetricQuads, LieAcrossThePlaneWithAMidLine)
{
  const auto data = ringWithArrays();
  const auto remesh = symmetricRun(data);
  remesh->SetPlaneCurveToMidLine();
  remesh->Update();
  ASSERT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << remesh->GetOutcomeText();
  vtkPolyData* quads = remesh->GetOutput();
  expectMirrorPoints(quads);
  vtkDataArray* image = quads->GetPointData()->GetArray("MirrorPoint");
  vtkDataArray* place = quads->GetPointData()->GetArray("Place");
  for (vtkIdType p = 0; p < quads->GetNumberOfPoints(); ++p)
  {
    EXPECT_NE(static_cast<vtkIdType>(image->GetTuple1(p)), p);
    EXPECT_NEAR(place->GetTuple1(p), quads->GetPoint(p)[0], 1e-9);
  }
  std::size_t across = 0;
  for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
  {
    const Corners q = cornersOfCell(quads, i);
    const auto front =
      std::count_if(q.begin(), q.end(), [&](vtkIdType p) { return quads->GetPoint(p)[0] > 0; });
    EXPECT_EQ(front % 2, 0);
    across += front == 2 ? 1 : 0;
  }
  // The lines of the output Constraints are the middles of these quads.
  vtkPolyData* lines = remesh->GetConstraints();
  ASSERT_NE(lines, nullptr);
  std::size_t inPlane = 0;
  for (vtkIdType i = 0; i < lines->GetNumberOfCells(); ++i)
  {
    const bool isMirror = lines->GetCellData()->GetArray("Constraint")->GetTuple1(i) == 10;
    inPlane += isMirror ? 1 : 0;
    EXPECT_TRUE(!isMirror || std::abs(test::cellCentre(lines, i).x()) < 1e-12);
  }
  EXPECT_EQ(inPlane, across);
  EXPECT_GT(across, 0U);
  const auto quiet = [](vtkObject*, unsigned long, void*, void*) {};
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(quiet);
  remesh->AddObserver(vtkCommand::ErrorEvent, observer);
  remesh->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  remesh->SetSymmetryToAxis();
  remesh->Update();
  EXPECT_NE(
    std::string(remesh->GetOutcomeText()).find("a mid-line of quads belongs to a mirror plane"),
    std::string::npos);
}

TEST(SymmetricQuads, HaveThePermutationAndArraysOfBothSides)
{
  const auto data = ringWithArrays();
  const auto remesh = symmetricRun(data);
  remesh->Update();
  ASSERT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << remesh->GetOutcomeText();
  vtkPolyData* quads = remesh->GetOutput();
  expectMirrorPoints(quads);
  vtkDataArray* place = quads->GetPointData()->GetArray("Place");
  for (vtkIdType p = 0; p < quads->GetNumberOfPoints(); ++p)
  {
    // A linear function is carried exactly, on the image's side from the input there.
    EXPECT_NEAR(place->GetTuple1(p), quads->GetPoint(p)[0], 1e-9);
  }
  vtkDataArray* side = quads->GetCellData()->GetArray("Side");
  for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
  {
    EXPECT_EQ(side->GetTuple1(i), test::cellCentre(quads, i).x() > 0 ? 1 : -1);
  }
  EXPECT_EQ(remesh->GetHandles(), 1);
  EXPECT_NE(std::string(remesh->GetNoticesText()).find("mirror plane given"), std::string::npos);
}

TEST(SymmetricQuads, MappedSurfaceIsWhole)
{
  const auto data = ringWithArrays();
  const auto remesh = symmetricRun(data);
  remesh->Update();
  vtkPolyData* mapped = remesh->GetMappedSurface();
  vtkPolyData* quads = remesh->GetOutput();
  double box[6], quadBox[6];
  mapped->GetBounds(box);
  quads->GetBounds(quadBox);
  EXPECT_NEAR(box[0], -box[1], 1e-12);
  EXPECT_NEAR(box[0], quadBox[0], 0.1);
  EXPECT_EQ(quads->GetFieldData()->GetArray("CertificateValid")->GetTuple1(0), 1);
  vtkDataArray* determinant = mapped->GetCellData()->GetArray("Determinant");
  double area = 0;
  for (vtkIdType i = 0; i < mapped->GetNumberOfCells(); ++i)
  {
    EXPECT_GT(determinant->GetTuple1(i), 0);
    area += determinant->GetTuple1(i) / 2;
  }
  EXPECT_NEAR(area, static_cast<double>(quads->GetNumberOfCells()), 1e-6);
}

TEST(SymmetricQuads, HaveARowInTheConstraintTable)
{
  const auto remesh = symmetricRun(ringWithArrays());
  remesh->SetSymmetryToFound();
  remesh->Update();
  vtkTable* table = remesh->GetConstraintTable();
  ASSERT_EQ(table->GetNumberOfRows(), 1);
  EXPECT_EQ(table->GetValueByName(0, "Kind").ToString(), "symmetry");
  EXPECT_EQ(table->GetValueByName(0, "Met").ToInt(), 1);
  EXPECT_LT(table->GetValueByName(0, "Deviation").ToDouble(), 1e-9);
}

TEST(SymmetricQuads, EditsReuseTheStages)
{
  const auto remesh = symmetricRun(ringWithArrays());
  remesh->Update();
  remesh->SetSmoothingSteps(2);
  remesh->Update();
  const std::string reused = remesh->GetReusedStagesText();
  for (const char* stage : { "whole", "plane", "phase1", "embed", "replay" })
  {
    EXPECT_NE(reused.find(stage), std::string::npos) << stage << " in\n" << reused;
  }
  expectMirrorPoints(remesh->GetOutput());
  remesh->SetSmoothingSteps(5);
  remesh->Update();
  EXPECT_EQ(std::string(remesh->GetReusedStagesText()), "all");
  remesh->SetSymmetryToNone();
  remesh->Update();
  EXPECT_EQ(remesh->GetOutput()->GetPointData()->GetArray("MirrorPoint"), nullptr);
}

TEST(SymmetricQuads, RefuseAPlaneWithoutNormal)
{
  const auto remesh = symmetricRun(ringWithArrays());
  remesh->SetSymmetryNormal(0, 0, 0);
  const auto quiet = [](vtkObject*, unsigned long, void*, void*) {};
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(quiet);
  remesh->AddObserver(vtkCommand::ErrorEvent, observer);
  remesh->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  remesh->Update();
  EXPECT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(remesh->GetOutcomeText()).find("normal"), std::string::npos);
}

} // namespace
} // namespace quadrille
