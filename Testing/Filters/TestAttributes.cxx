// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleAttributes.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille
{
namespace
{

/// One target point between three source points.
const PointOrigin kBetween{ { 2, 0, 1 }, { 0.25, 0.625, 0.125 } };

TEST(Attributes, RealNumbersAreInterpolated)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkDoubleArray> values;
  values->SetName("Temperature");
  values->SetNumberOfComponents(2);
  for (int i = 0; i < 3; ++i)
  {
    values->InsertNextTuple2(8 * i, -16 * i);
  }
  source->AddArray(values);
  carryPointArrays(source, 3, target, { kBetween }, 1);
  vtkDataArray* result = target->GetArray("Temperature");
  ASSERT_NE(result, nullptr);
  // 0.25 * 16 + 0.125 * 8; exact in binary.
  EXPECT_EQ(result->GetComponent(0, 0), 5);
  EXPECT_EQ(result->GetComponent(0, 1), -10);
}

TEST(Attributes, WholeNumbersAndStringsComeFromTheNearest)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  for (int i = 0; i < 3; ++i)
  {
    ids->InsertNextValue(100 + i);
    names->InsertNextValue("point " + std::to_string(i));
  }
  source->SetGlobalIds(ids);
  source->AddArray(names);
  carryPointArrays(source, 3, target, { kBetween }, 1);
  EXPECT_EQ(target->GetArray("Ids")->GetTuple1(0), 100);
  EXPECT_EQ(
    vtkStringArray::SafeDownCast(target->GetAbstractArray("Names"))->GetValue(0), "point 0");
  // They are no longer unique, so they must not pass for global ids.
  EXPECT_EQ(target->GetGlobalIds(), nullptr);
}

TEST(Attributes, ColoursAreMixedAndNormalsStayUnit)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("Colours");
  colours->SetNumberOfComponents(3);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (int i = 0; i < 3; ++i)
  {
    colours->InsertNextTuple3(80 * i, 0, 255);
    normals->InsertNextTuple3(i == 0, i == 1, i == 2);
  }
  source->SetScalars(colours);
  source->SetNormals(normals);
  carryPointArrays(source, 3, target, { kBetween }, 1);
  EXPECT_EQ(target->GetScalars()->GetComponent(0, 0), 50);
  EXPECT_EQ(target->GetScalars()->GetComponent(0, 2), 255);
  double n[3];
  target->GetNormals()->GetTuple(0, n);
  EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-6); // float
  EXPECT_NEAR(n[1] / n[0], 0.125 / 0.625, 1e-6);
}

TEST(Attributes, CellsTakeTheirSourceAndOwnArraysStayBehind)
{
  vtkNew<vtkCellData> source, target;
  vtkNew<vtkIdTypeArray> patch, features;
  patch->SetName("PatchId");
  features->SetName("FeatureEdges");
  for (int i = 0; i < 4; ++i)
  {
    patch->InsertNextValue(10 * i);
    features->InsertNextValue(i);
  }
  source->AddArray(patch);
  source->AddArray(features);
  carryCellArrays(source, 4, target, std::vector<vtkIdType>{ 3, 2 }, 1);
  EXPECT_EQ(target->GetArray("PatchId")->GetTuple1(0), 30);
  EXPECT_EQ(target->GetArray("PatchId")->GetTuple1(1), 20);
  EXPECT_EQ(target->GetArray("FeatureEdges"), nullptr);
}

} // namespace
} // namespace quadrille
