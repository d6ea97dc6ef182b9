// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestSurfaces.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntegerGridMapComparison.h>
#include <vtkIntegerGridMapQuality.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkQuadRemesh.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille
{
namespace
{

vtkSmartPointer<vtkPolyData> mapOf(vtkPolyData* surface, int quads)
{
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(surface);
  remesh->SetTargetTypeToNumberOfQuads();
  remesh->SetNumberOfQuads(quads);
  remesh->Update();
  auto mapped = vtkSmartPointer<vtkPolyData>::New();
  mapped->DeepCopy(remesh->GetMappedSurface());
  return mapped;
}

/// A plate of n by n unit cells with the map (u, v) = (x / s, k y / s) in texture coordinates.
vtkSmartPointer<vtkPolyData> plateWithMap(int n, double s, double k)
{
  vtkSmartPointer<vtkPolyData> plate = test::toPolyData(test::gridPlane(n, n));
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("TextureCoordinates");
  uv->SetNumberOfComponents(2);
  for (vtkIdType i = 0; i < plate->GetNumberOfPoints(); ++i)
  {
    const double* p = plate->GetPoint(i);
    uv->InsertNextTuple2(p[0] / s, k * p[1] / s);
  }
  plate->GetPointData()->SetTCoords(uv);
  return plate;
}

double entry(vtkTable* table, const char* measure, const char* column)
{
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    if (table->GetValueByName(row, "Measure").ToString() == measure)
    {
      return table->GetValueByName(row, column).ToDouble();
    }
  }
  ADD_FAILURE() << "no row " << measure;
  return 0;
}

double sumOf(vtkTable* table, const char* column)
{
  double sum = 0;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    sum += table->GetValueByName(row, column).ToDouble();
  }
  return sum;
}

} // namespace

TEST(MapQualityFilter, MeasuresAnAnalyticMap)
{
  vtkNew<vtkIntegerGridMapQuality> quality;
  quality->SetInputData(plateWithMap(8, 0.5, 2));
  quality->SetEdgeLength(0.5);
  quality->Update();
  ASSERT_EQ(quality->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << quality->GetOutcomeText();
  EXPECT_NEAR(entry(quality->GetSummary(), "Sizing", "Mean"), 0.5, kRounding);
  EXPECT_NEAR(entry(quality->GetSummary(), "Anisotropy", "Maximum"), 2, kRounding);
  EXPECT_NEAR(entry(quality->GetSummary(), "Shear", "Minimum"), 90, kRounding);
  EXPECT_EQ(quality->GetValences()->GetNumberOfRows(), 0);
  vtkCellData* cells = quality->GetOutput()->GetCellData();
  ASSERT_EQ(quality->GetOutput()->GetNumberOfCells(), 128);
  for (vtkIdType f = 0; f < 128; ++f)
  {
    EXPECT_NEAR(cells->GetArray("Sizing")->GetTuple1(f), 0.5, kRounding);
    EXPECT_NEAR(cells->GetArray("Anisotropy")->GetTuple1(f), 2, kRounding);
    EXPECT_NEAR(cells->GetArray("Shear")->GetTuple1(f), 90, kRounding);
  }
}

TEST(MapQualityFilter, TakesTheEdgeLengthFromTheMapWhereNoneIsGiven)
{
  vtkNew<vtkIntegerGridMapQuality> quality;
  quality->SetInputData(plateWithMap(8, 0.25, 1));
  quality->Update();
  EXPECT_NEAR(
    quality->GetOutput()->GetFieldData()->GetArray("EdgeLength")->GetTuple1(0), 0.25, kRounding);
  EXPECT_NEAR(entry(quality->GetSummary(), "Sizing", "Mean"), 1, kRounding);
}

TEST(MapQualityFilter, HistogramsHoldAllOfTheAreaAndValencesAllIrregularVertices)
{
  vtkNew<vtkIntegerGridMapQuality> quality;
  quality->SetInputData(mapOf(test::toPolyData(test::sphere(4)), 400));
  quality->Update();
  ASSERT_EQ(quality->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << quality->GetOutcomeText();
  for (const char* share : { "SizingShare", "AnisotropyShare", "ShearShare" })
  {
    EXPECT_NEAR(sumOf(quality->GetHistograms(), share), 100, 1e-9) << share;
  }
  double index = 0; // of a sphere: 8 quarter turns in all
  vtkTable* valences = quality->GetValences();
  for (vtkIdType row = 0; row < valences->GetNumberOfRows(); ++row)
  {
    index += (4 - valences->GetValueByName(row, "Valence").ToDouble()) *
      valences->GetValueByName(row, "Count").ToDouble();
  }
  EXPECT_EQ(index, 8);
}

TEST(MapQualityFilter, RefusesASurfaceWithoutAMap)
{
  vtkNew<vtkIntegerGridMapQuality> quality;
  quality->SetInputData(test::toPolyData(test::sphere(1)));
  test::Messages messages(quality);
  quality->Update();
  EXPECT_EQ(quality->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

TEST(MapComparisonFilter, OfAMapWithItselfIsZero)
{
  const vtkSmartPointer<vtkPolyData> map = mapOf(test::toPolyData(test::sphere(3)), 300);
  vtkNew<vtkIntegerGridMapComparison> comparison;
  comparison->SetInputData(map);
  comparison->SetReferenceData(map);
  comparison->Update();
  ASSERT_EQ(comparison->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << comparison->GetOutcomeText();
  vtkTable* measures = comparison->GetMeasures();
  for (vtkIdType row = 0; row < measures->GetNumberOfRows(); ++row)
  {
    EXPECT_EQ(measures->GetValueByName(row, "Distance").ToDouble(), 0);
    EXPECT_EQ(measures->GetValueByName(row, "Map"), measures->GetValueByName(row, "Reference"));
  }
  EXPECT_EQ(comparison->GetOutput()->GetNumberOfCells(), 0);
}

TEST(MapComparisonFilter, FindsHowFarTwoMapsAreApart)
{
  // Fine enough that neither number of quads splits its triangles.
  vtkSmartPointer<vtkPolyData> sphere = test::toPolyData(test::sphere(5));
  const vtkSmartPointer<vtkPolyData> reference = mapOf(sphere, 300);
  const vtkSmartPointer<vtkPolyData> map = mapOf(sphere, 2000);
  double distance[2];
  for (int turned = 0; turned < 2; ++turned)
  {
    vtkNew<vtkIntegerGridMapComparison> comparison;
    comparison->SetInputData(turned == 0 ? map : reference);
    comparison->SetReferenceData(turned == 0 ? reference : map);
    comparison->SetEdgeLength(0.1);
    comparison->Update();
    ASSERT_EQ(comparison->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << comparison->GetOutcomeText();
    vtkTable* measures = comparison->GetMeasures();
    distance[turned] = entry(measures, "Irregular vertices", "Distance");
    // Each quarter turn goes along one line; what they cost together is the distance.
    vtkCellData* moves = comparison->GetOutput()->GetCellData();
    double work = 0;
    for (vtkIdType i = 0; i < comparison->GetOutput()->GetNumberOfCells(); ++i)
    {
      work +=
        moves->GetArray("Turns")->GetTuple1(i) * moves->GetArray("Length")->GetTuple1(i) / 0.1;
    }
    EXPECT_NEAR(work, distance[turned], 1e-6);
    // A quad of one map covers 20 / 3 of those of the other.
    const double ratio = entry(measures, "Sizing", "Map") / entry(measures, "Sizing", "Reference");
    EXPECT_NEAR(std::log(ratio) * (turned == 0 ? -1 : 1), std::log(2000.0 / 300), 0.3);
    EXPECT_GT(entry(measures, "Sizing", "Distance"), 0);
    EXPECT_EQ(
      sumOf(comparison->GetValences(), "Map"), entry(measures, "Irregular vertices", "Map"));
  }
  EXPECT_NEAR(distance[0], distance[1], 1e-4 * distance[0]); // lengths are in single precision
}

TEST(MapComparisonFilter, RefusesTwoSurfaces)
{
  vtkNew<vtkIntegerGridMapComparison> comparison;
  comparison->SetInputData(plateWithMap(4, 1, 1));
  comparison->SetReferenceData(plateWithMap(5, 1, 1));
  test::Messages messages(comparison);
  comparison->Update();
  EXPECT_EQ(comparison->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(
    std::string(comparison->GetOutcomeText()).find("not the same surface"), std::string::npos);
}

TEST(MapComparisonFilter, GoesBlockByBlock)
{
  const auto blocks = [](double k)
  {
    vtkNew<vtkMultiBlockDataSet> both;
    both->SetBlock(0, plateWithMap(4, 1, 1));
    both->SetBlock(1, plateWithMap(4, 1, k));
    vtkSmartPointer<vtkMultiBlockDataSet> result = both.Get();
    return result;
  };
  vtkNew<vtkIntegerGridMapComparison> comparison;
  comparison->SetInputDataObject(0, blocks(2));
  comparison->SetReferenceData(blocks(1));
  comparison->Update();
  ASSERT_EQ(comparison->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << comparison->GetOutcomeText();
  auto* tables = vtkMultiBlockDataSet::SafeDownCast(comparison->GetOutputDataObject(1));
  ASSERT_NE(tables, nullptr);
  EXPECT_NEAR(
    entry(vtkTable::SafeDownCast(tables->GetBlock(0)), "Anisotropy", "Distance"), 0, kRounding);
  EXPECT_NEAR(
    entry(vtkTable::SafeDownCast(tables->GetBlock(1)), "Anisotropy", "Distance"), 1, kRounding);
}

} // namespace quadrille
