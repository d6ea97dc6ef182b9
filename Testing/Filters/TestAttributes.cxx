// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Attributes.h"

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVariantArray.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

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

/// The values of a one-component array by the points 0, 1, 2.
template <class Array, class Value>
vtkSmartPointer<Array> arrayOf(const char* name, std::initializer_list<Value> values)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  for (const Value& value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

TEST(Attributes, VectorsAndTensorsStayAsTheyAre)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkFloatArray> vectors;
  vtkNew<vtkDoubleArray> tensors;
  vectors->SetName("Velocity");
  vectors->SetNumberOfComponents(3);
  tensors->SetName("Stress");
  tensors->SetNumberOfComponents(9);
  for (int i = 0; i < 3; ++i)
  {
    vectors->InsertNextTuple3(8 * i, 1, -8 * i);
    double t[9];
    for (int c = 0; c < 9; ++c)
    {
      t[c] = 8 * i + c;
    }
    tensors->InsertNextTuple(t);
  }
  source->SetVectors(vectors);
  source->SetTensors(tensors);
  carryPointArrays(source, 3, target, { kBetween }, 1);
  ASSERT_NE(target->GetVectors(), nullptr);
  ASSERT_NE(target->GetTensors(), nullptr);
  // 0.25 * 16 + 0.125 * 8; a length other than 1 shows that vectors are not taken for normals.
  EXPECT_EQ(target->GetVectors()->GetComponent(0, 0), 5);
  EXPECT_EQ(target->GetVectors()->GetComponent(0, 1), 1);
  EXPECT_EQ(target->GetVectors()->GetComponent(0, 2), -5);
  for (int c = 0; c < 9; ++c)
  {
    EXPECT_EQ(target->GetTensors()->GetComponent(0, c), 5 + c);
  }
}

TEST(Attributes, WholeNumbersOfAllWidthsAreExact)
{
  const long long large = (1LL << 60) + 1; // no double has it
  vtkNew<vtkPointData> source, target;
  source->AddArray(
    arrayOf<vtkIdTypeArray>("Large", { vtkIdType{ large }, vtkIdType{ 1 }, vtkIdType{ 2 } }));
  source->AddArray(arrayOf<vtkBitArray>("Bits", { 1, 0, 0 }));
  vtkNew<vtkVariantArray> variants;
  variants->SetName("Variants");
  for (const char* text : { "a", "b", "c" })
  {
    variants->InsertNextValue(vtkVariant(text));
  }
  source->AddArray(variants);
  carryPointArrays(source, 3, target, { kBetween, { { 1, 2, 0 }, { 0.5, 0.5, 0 } } }, 2);
  auto* carried = vtkIdTypeArray::SafeDownCast(target->GetArray("Large"));
  EXPECT_EQ(carried->GetValue(0), large);
  EXPECT_EQ(carried->GetValue(1), 1); // the first of several largest weights
  EXPECT_EQ(vtkBitArray::SafeDownCast(target->GetArray("Bits"))->GetValue(0), 1);
  EXPECT_EQ(vtkBitArray::SafeDownCast(target->GetArray("Bits"))->GetValue(1), 0);
  EXPECT_EQ(target->GetAbstractArray("Variants")->GetVariantValue(0).ToString(), "a");
}

/// Also on a point of an edge, where the third point has no weight.
TEST(Attributes, APointWithoutWeightHasNoInfluence)
{
  vtkNew<vtkPointData> source, target;
  source->AddArray(arrayOf<vtkDoubleArray>("Gap", { std::nan(""), 4.0, 8.0 }));
  source->AddArray(arrayOf<vtkDoubleArray>("Constant", { 0.1, 0.1, 0.1 }));
  const std::vector<PointOrigin> origins{ { { 0, 1, 2 }, { 0, 0.5, 0.5 } },
    { { 2, 0, 1 }, { 1, 0, 0 } }, { { 0, 1, 2 }, { 0.3, 0.3, 0.4 } } };
  carryPointArrays(source, 3, target, origins, 1);
  EXPECT_EQ(target->GetArray("Gap")->GetTuple1(0), 6);
  EXPECT_EQ(target->GetArray("Gap")->GetTuple1(1), 8);
  EXPECT_TRUE(std::isnan(target->GetArray("Gap")->GetTuple1(2)));
  EXPECT_EQ(target->GetArray("Constant")->GetTuple1(2), 0.1);
}

TEST(Attributes, NormalsThatCancelOutComeFromTheNearest)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkDoubleArray> normals;
  normals->SetName("N");
  normals->SetNumberOfComponents(3);
  normals->InsertNextTuple3(0, 0, 1);
  normals->InsertNextTuple3(0, 0, -1);
  normals->InsertNextTuple3(1, 0, 0);
  source->SetNormals(normals);
  carryPointArrays(source, 3, target, { { { 1, 0, 2 }, { 0.5, 0.5, 0 } } }, 1);
  EXPECT_EQ(target->GetNormals()->GetComponent(0, 2), -1);
}

TEST(Attributes, ArraysWithoutNameAndOtherLayoutsAreCarried)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkDoubleArray> unnamed;
  for (const double value : { 0.0, 8.0, 16.0 })
  {
    unnamed->InsertNextValue(value);
  }
  source->SetScalars(unnamed);
  vtkNew<vtkSOADataArrayTemplate<double>> columns;
  columns->SetName("Columns");
  columns->SetNumberOfComponents(2);
  columns->SetNumberOfTuples(3);
  for (int i = 0; i < 3; ++i)
  {
    columns->SetTypedComponent(i, 0, 8 * i);
    columns->SetTypedComponent(i, 1, -8 * i);
  }
  source->AddArray(columns);
  EXPECT_TRUE(carryPointArrays(source, 3, target, { kBetween }, 1).empty());
  ASSERT_EQ(target->GetNumberOfArrays(), 2);
  ASSERT_NE(target->GetScalars(), nullptr);
  EXPECT_EQ(target->GetScalars()->GetTuple1(0), 5);
  EXPECT_EQ(target->GetArray("Columns")->GetComponent(0, 0), 5);
  EXPECT_EQ(target->GetArray("Columns")->GetComponent(0, 1), -5);
}

TEST(Attributes, ArraysThatAreTooShortAreNamed)
{
  vtkNew<vtkPointData> source, target;
  vtkNew<vtkDoubleArray> none;
  none->SetName("None");
  source->AddArray(none);
  source->AddArray(arrayOf<vtkDoubleArray>("Two", { 1.0, 2.0 }));
  source->AddArray(arrayOf<vtkDoubleArray>("Three", { 1.0, 2.0, 3.0 }));
  const std::vector<std::string> left = carryPointArrays(source, 3, target, { kBetween }, 1);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0], "array 'None' has 0 tuples for 3 points and is not carried over");
  EXPECT_NE(left[1].find("'Two' has 2 tuples"), std::string::npos);
  EXPECT_EQ(target->GetNumberOfArrays(), 1);
  // Nothing is made of an empty result, either.
  vtkNew<vtkPointData> empty;
  EXPECT_EQ(carryPointArrays(source, 3, empty, {}, 1).size(), 2u);
  EXPECT_EQ(empty->GetArray("Three")->GetNumberOfTuples(), 0);
}

/// Two cells of the result: mostly of cell 2, and of cells 0 and 1 alike with the centre in 1.
CellOrigins twoCells()
{
  return { { 0, 3, 5 }, { { 0, 0.25 }, { 1, 0.25 }, { 2, 0.5 }, { 1, 0.5 }, { 0, 0.5 } } };
}

TEST(Attributes, CellsByAreaAverageRealNumbers)
{
  vtkNew<vtkCellData> source, target;
  source->AddArray(arrayOf<vtkDoubleArray>("Thickness", { 4.0, 8.0, 16.0 }));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("Colours");
  colours->SetNumberOfComponents(3);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (int i = 0; i < 3; ++i)
  {
    colours->InsertNextTuple3(255, 100 * i, 10 * i);
    normals->InsertNextTuple3(i == 0, i == 1, i == 2);
  }
  source->AddArray(colours);
  source->SetNormals(normals);
  carryCellArrays(source, 3, target, twoCells(), 1);
  EXPECT_EQ(target->GetArray("Thickness")->GetTuple1(0), 0.25 * 4 + 0.25 * 8 + 0.5 * 16);
  EXPECT_EQ(target->GetArray("Thickness")->GetTuple1(1), 6);
  EXPECT_EQ(target->GetArray("Colours")->GetComponent(0, 0), 255);
  EXPECT_EQ(target->GetArray("Colours")->GetComponent(0, 1), 125);
  EXPECT_EQ(target->GetArray("Colours")->GetComponent(0, 2), 13);                // 12.5
  EXPECT_NEAR(target->GetNormals()->GetComponent(0, 2), 2 / std::sqrt(6), 1e-6); // float
}

TEST(Attributes, CellsByAreaTakeTheLargestPartOfLabels)
{
  vtkNew<vtkCellData> source, target;
  // Cells 0 and 1 together have as much of the first result as cell 2, whose centre is in 0.
  source->AddArray(arrayOf<vtkIntArray>("Same", { 7, 7, 5 }));
  source->AddArray(arrayOf<vtkIntArray>("Different", { 7, 6, 5 }));
  source->AddArray(arrayOf<vtkStringArray>("Names", { "bow", "stern", "bow" }));
  source->AddArray(arrayOf<vtkBitArray>("Bits", { 0, 1, 1 }));
  vtkNew<vtkIntArray> pairs;
  pairs->SetName("Pairs");
  pairs->SetNumberOfComponents(2);
  pairs->InsertNextTuple2(1, 1);
  pairs->InsertNextTuple2(1, 2);
  pairs->InsertNextTuple2(1, 2);
  source->AddArray(pairs);
  carryCellArrays(source, 3, target, twoCells(), 1);
  EXPECT_EQ(target->GetArray("Same")->GetTuple1(0), 7);
  EXPECT_EQ(target->GetArray("Different")->GetTuple1(0), 5);
  EXPECT_EQ(target->GetArray("Different")->GetTuple1(1), 6); // a tie goes to the centre
  auto* names = vtkStringArray::SafeDownCast(target->GetAbstractArray("Names"));
  EXPECT_EQ(names->GetValue(0), "bow");
  EXPECT_EQ(names->GetValue(1), "stern");
  EXPECT_EQ(vtkBitArray::SafeDownCast(target->GetArray("Bits"))->GetValue(0), 1);
  EXPECT_EQ(target->GetArray("Pairs")->GetComponent(0, 1), 2); // compared as a whole
}

/// Without the centre among them the lowest cell wins a tie, not the lowest value.
TEST(Attributes, TiesBesideTheCentreGoToTheLowestCell)
{
  vtkNew<vtkCellData> source, target;
  source->AddArray(arrayOf<vtkIntArray>("Labels", { 9, 5, 1 }));
  const CellOrigins origins{ { 0, 3 }, { { 2, 0.2 }, { 1, 0.4 }, { 0, 0.4 } } };
  carryCellArrays(source, 3, target, origins, 1);
  EXPECT_EQ(target->GetArray("Labels")->GetTuple1(0), 9);
}

/// In doubles 0.1 + 0.2 is more than 0.3; the centre still wins.
TEST(Attributes, PartsWithinRoundingAreATie)
{
  vtkNew<vtkCellData> source, target;
  source->AddArray(arrayOf<vtkIntArray>("Labels", { 1, 1, 2, 3, 4 }));
  const CellOrigins origins{ { 0, 5 },
    { { 2, 0.3 }, { 0, 0.1 }, { 1, 0.2 }, { 3, 0.2 }, { 4, 0.2 } } };
  carryCellArrays(source, 5, target, origins, 1);
  EXPECT_EQ(target->GetArray("Labels")->GetTuple1(0), 2);
}

TEST(Attributes, SameBytesForAnyNumberOfThreads)
{
  const vtkIdType count = 1000;
  vtkNew<vtkPointData> source;
  vtkNew<vtkDoubleArray> values;
  values->SetName("Values");
  values->SetNumberOfComponents(3);
  vtkNew<vtkIntArray> labels;
  labels->SetName("Labels");
  for (vtkIdType i = 0; i < count; ++i)
  {
    values->InsertNextTuple3(std::sin(i), 1.0 / (1 + i), i);
    labels->InsertNextValue(static_cast<int>(i * i % 7));
  }
  source->AddArray(values);
  source->AddArray(labels);
  std::vector<PointOrigin> points(50000);
  CellOrigins cells;
  cells.first.push_back(0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    const double t = 1.0 / static_cast<double>(2 + i % 11);
    points[i] = { { id % count, 7 * id % count, 13 * id % count }, { t, t / 2, 1 - 1.5 * t } };
    cells.shares.push_back({ id % count, t });
    cells.shares.push_back({ 3 * id % count, 1 - t });
    cells.first.push_back(cells.shares.size());
  }
  for (const bool ofCells : { false, true })
  {
    vtkNew<vtkPointData> one, three;
    for (const auto& [target, threads] : { std::pair(one.Get(), 1), std::pair(three.Get(), 3) })
    {
      ofCells ? carryCellArrays(source, count, target, cells, threads)
              : carryPointArrays(source, count, target, points, threads);
    }
    for (const char* name : { "Values", "Labels" })
    {
      vtkDataArray* a = one->GetArray(name);
      vtkDataArray* b = three->GetArray(name);
      ASSERT_EQ(a->GetNumberOfTuples(), 50000);
      EXPECT_EQ(std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
                  static_cast<std::size_t>(a->GetNumberOfValues() * a->GetDataTypeSize())),
        0);
    }
  }
}

} // namespace
} // namespace quadrille
