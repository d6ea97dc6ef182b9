// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"
#include "Stages/Log.h"
#include "TestSurfaces.h"

#include "Base/Error.h"
#include "Base/Progress.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

namespace quadrille
{
namespace
{

/// A pentagon, a triangle and a strip of three triangles behind a vertex and a line.
vtkSmartPointer<vtkPolyData> mixedCells()
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 12; ++i)
  {
    points->InsertNextPoint(i % 4, i / 4, 0.25 * i);
  }
  vtkNew<vtkCellArray> verts, lines, polys, strips;
  verts->InsertNextCell({ 0 });
  lines->InsertNextCell({ 0, 1 });
  polys->InsertNextCell({ 0, 1, 2, 6, 5 });
  polys->InsertNextCell({ 0, 5, 4 });
  strips->InsertNextCell({ 4, 8, 5, 9, 6 });
  data->SetPoints(points);
  data->SetVerts(verts);
  data->SetLines(lines);
  data->SetPolys(polys);
  data->SetStrips(strips);
  return data;
}

TEST(Convert, PolygonsAndStripsKeepTheirCells)
{
  const ConvertedSurface surface = convertSurface(mixedCells(), "PatchId");
  EXPECT_EQ(surface.ignoredCells, 2u);
  const std::vector<Index> offsets{ 0, 5, 8, 11, 14, 17 };
  EXPECT_EQ(surface.input.polygonOffsets, offsets);
  // Every second triangle of a strip is turned round, so that all of them see the same side.
  const std::vector<Index> strip{ 4, 8, 5, 8, 9, 5, 5, 9, 6 };
  EXPECT_TRUE(std::equal(strip.begin(), strip.end(), surface.input.polygonPoints.begin() + 8));
  const std::vector<vtkIdType> cells{ 2, 3, 4, 4, 4 };
  for (Index p = 0; p < 5; ++p)
  {
    EXPECT_EQ(surface.cell(p), cells[p]);
  }
}

TEST(Convert, CornersOfTrianglesAreFoundWithoutTheInput)
{
  const vtkSmartPointer<vtkPolyData> data = mixedCells();
  ConvertedSurface surface = convertSurface(data, "");
  surface.input = {};
  using Corners = std::optional<std::array<Index, 3>>;
  EXPECT_EQ(surface.triangle(data, 0), Corners()) << "a pentagon";
  EXPECT_EQ(surface.triangle(data, 1), Corners({ 0, 5, 4 }));
  EXPECT_EQ(surface.triangle(data, 2), Corners({ 4, 8, 5 }));
  EXPECT_EQ(surface.triangle(data, 3), Corners({ 8, 9, 5 }));
  EXPECT_EQ(surface.triangle(data, 4), Corners({ 5, 9, 6 }));
}

TEST(Convert, StopsOnRequest)
{
  PollScope scope([](double, const std::string&) { return false; });
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(convertSurface(mixedCells(), ""), Cancelled);
}

TEST(Convert, PointsKeepEveryBit)
{
  vtkSmartPointer<vtkPolyData> data = mixedCells();
  const double value = 1.0 / 3;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->DeepCopy(data->GetPoints());
  points->SetDataTypeToDouble();
  vtkNew<vtkPoints> exact;
  exact->SetDataTypeToDouble();
  for (int i = 0; i < 12; ++i)
  {
    exact->InsertNextPoint(i * value, -i * value, value);
  }
  data->SetPoints(exact);
  const ConvertedSurface surface = convertSurface(data, "");
  EXPECT_EQ(surface.input.points[5], Vector3(5 * value, -5 * value, value));
}

template <class Value>
vtkSmartPointer<vtkDataArray> inColumns(vtkDataArray* array)
{
  auto columns = vtkSmartPointer<vtkSOADataArrayTemplate<Value>>::New();
  columns->SetNumberOfComponents(array->GetNumberOfComponents());
  columns->SetName(array->GetName());
  columns->DeepCopy(array);
  return columns;
}

/// An array has the type of its values, but not the class that goes with the type: columns here, computed arrays of
/// later versions of VTK.
TEST(Convert, ArraysOfAnotherLayoutAreReadAlike)
{
  const vtkSmartPointer<vtkPolyData> plain = mixedCells();
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  vtkNew<vtkUnsignedCharArray> features;
  features->SetName("FeatureEdges");
  for (int i = 0; i < 5; ++i)
  {
    patches->InsertNextValue(10 + i);
    features->InsertNextValue(i == 2 ? 17 : 0);
  }
  plain->GetCellData()->AddArray(patches);
  plain->GetCellData()->AddArray(features);
  vtkNew<vtkPolyData> apart;
  apart->ShallowCopy(plain);
  vtkNew<vtkPoints> points;
  points->SetData(inColumns<float>(plain->GetPoints()->GetData()));
  apart->SetPoints(points);
  apart->GetCellData()->AddArray(inColumns<int>(patches));
  apart->GetCellData()->AddArray(inColumns<unsigned char>(features));
  ASSERT_FALSE(apart->GetCellData()->GetArray("PatchId")->HasStandardMemoryLayout());
  const ConvertedSurface one = convertSurface(plain, "PatchId");
  const ConvertedSurface other = convertSurface(apart, "PatchId");
  EXPECT_EQ(one.input.points, other.input.points);
  EXPECT_EQ(one.input.patchIds, other.input.patchIds);
  EXPECT_EQ(one.input.featureEdges, other.input.featureEdges);
}

TEST(Convert, PatchIdsAndFeaturesComeByCell)
{
  vtkSmartPointer<vtkPolyData> data = mixedCells();
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  vtkNew<vtkUnsignedCharArray> features;
  features->SetName("FeatureEdges");
  for (int i = 0; i < 5; ++i)
  {
    patches->InsertNextValue(10 + i);
    features->InsertNextValue(i == 2 ? 17 : 0);
  }
  data->GetCellData()->AddArray(patches);
  data->GetCellData()->AddArray(features);
  const ConvertedSurface surface = convertSurface(data, "PatchId");
  const std::vector<std::int64_t> expected{ 12, 13, 14, 14, 14 };
  EXPECT_EQ(surface.input.patchIds, expected);
  EXPECT_EQ(surface.patchArray, "PatchId");
  const std::vector<std::uint8_t> bits{ 17, 0, 0, 0, 0 };
  EXPECT_EQ(surface.input.featureEdges, bits);
}

TEST(Convert, RefusesWhatItCannotTake)
{
  vtkSmartPointer<vtkPolyData> data = mixedCells();
  EXPECT_NO_THROW(convertSurface(data, "PatchId")); // the default may be missing
  EXPECT_THROW(convertSurface(data, "Other"), InvalidInput);
  vtkNew<vtkFloatArray> reals;
  reals->SetName("Reals");
  reals->SetNumberOfTuples(5);
  data->GetCellData()->AddArray(reals);
  EXPECT_THROW(convertSurface(data, "Reals"), InvalidInput);
  vtkNew<vtkCellArray> broken;
  broken->InsertNextCell({ 0, 1, 99 });
  data->SetPolys(broken);
  try
  {
    convertSurface(data, "");
    FAIL() << "a corner without a point must be refused";
  }
  catch (const InvalidInput& error)
  {
    EXPECT_NE(std::string(error.what()).find("cell 2"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("99"), std::string::npos) << error.what();
  }
}

TEST(Convert, GuidesAndValencesComeByCellAndPoint)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  vtkNew<vtkDoubleArray> directions;
  directions->SetName("GuidingDirection");
  directions->SetNumberOfComponents(3);
  directions->SetNumberOfTuples(data->GetNumberOfCells());
  directions->Fill(0);
  directions->SetTuple3(5, 0, 2, 0);
  vtkNew<vtkFloatArray> weights;
  weights->SetName("GuidingWeight");
  weights->SetNumberOfTuples(data->GetNumberOfCells());
  weights->Fill(0); // says nothing where there is no direction
  weights->SetValue(5, 0.5F);
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  valences->SetNumberOfTuples(data->GetNumberOfPoints());
  valences->Fill(0);
  valences->SetValue(4, 5);
  data->GetCellData()->AddArray(directions);
  data->GetCellData()->AddArray(weights);
  data->GetPointData()->AddArray(valences);
  const ConvertedSurface surface = convertSurface(data, "");
  ASSERT_EQ(surface.input.guideDirections.size(), 8u);
  EXPECT_EQ(surface.input.guideDirections[5], Vector3(0, 2, 0));
  EXPECT_EQ(surface.input.guideWeights[5], 0.5);
  EXPECT_EQ(surface.input.targetValences[4], 5);

  const auto messageOf = [&]
  {
    try
    {
      convertSurface(data, "");
    }
    catch (const InvalidInput& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  weights->SetValue(5, 1.5F);
  EXPECT_NE(messageOf().find("cell 5"), std::string::npos);
  weights->SetValue(5, 1);
  directions->SetComponent(6, 1, std::nan(""));
  EXPECT_NE(messageOf().find("cell 6"), std::string::npos);
  directions->SetComponent(6, 1, 0);
  valences->SetValue(4, 9);
  EXPECT_NE(messageOf().find("point 4"), std::string::npos);
  valences->SetValue(4, 0);
  EXPECT_EQ(messageOf(), "");
  vtkNew<vtkDoubleArray> real;
  real->SetName("TargetValence");
  real->SetNumberOfTuples(data->GetNumberOfPoints());
  real->Fill(0);
  data->GetPointData()->AddArray(real);
  EXPECT_EQ(messageOf(), ""); // whole numbers, as a Calculator makes them
  real->SetValue(3, 3.5);
  EXPECT_NE(messageOf().find("point 3"), std::string::npos);
  vtkNew<vtkStringArray> words;
  words->SetName("TargetValence");
  words->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(words);
  EXPECT_NE(messageOf().find("TargetValence"), std::string::npos);
}

TEST(Convert, SizesAreReadOrRefusedByName)
{
  const vtkSmartPointer<vtkPolyData> data = mixedCells();
  EXPECT_TRUE(convertSurface(data, "").input.sizing.empty());
  const auto messageOf = [&]() -> std::string
  {
    try
    {
      convertSurface(data, "");
    }
    catch (const InvalidInput& error)
    {
      return error.what();
    }
    return {};
  };
  vtkNew<vtkDoubleArray> sizes;
  sizes->SetName("Sizing");
  sizes->SetNumberOfTuples(data->GetNumberOfPoints());
  sizes->Fill(1);
  sizes->SetValue(3, 0.25);
  data->GetPointData()->AddArray(sizes);
  std::vector<float> expected(12, 1.0F);
  expected[3] = 0.25F;
  EXPECT_EQ(convertSurface(data, "").input.sizing, expected);
  // The last two are no positive finite numbers as floats.
  for (const double wrong :
    { 0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-60, 1e60 })
  {
    sizes->SetValue(5, wrong);
    EXPECT_NE(messageOf().find("point 5 has the Sizing"), std::string::npos) << messageOf();
  }
  vtkNew<vtkIntArray> whole;
  whole->SetName("Sizing");
  whole->SetNumberOfTuples(data->GetNumberOfPoints());
  whole->Fill(1);
  data->GetPointData()->AddArray(whole);
  EXPECT_NE(messageOf().find("point array 'Sizing'"), std::string::npos);
}

TEST(Convert, SizesOfALevelComeBack)
{
  Level level;
  level.mesh = test::sphere(1);
  level.fineVertex.resize(level.mesh.vertexCount());
  level.fineFace.resize(level.mesh.faceCount());
  EXPECT_TRUE(readMesh(writeLevel(level, {})).sizing.empty());
  for (Index v = 0; v < level.mesh.vertexCount(); ++v)
  {
    level.mesh.sizing.push_back(0.1F + 0.01F * static_cast<float>(v));
  }
  EXPECT_EQ(readMesh(writeLevel(level, {})).sizing, level.mesh.sizing);
}

TEST(Convert, GuidesAndValencesOfALevelComeBack)
{
  Level level;
  level.mesh = test::sphere(1);
  level.fineVertex.resize(level.mesh.vertexCount());
  level.fineFace.resize(level.mesh.faceCount());
  EXPECT_TRUE(readGuides(writeLevel(level, {}), level.mesh).empty());
  EXPECT_TRUE(readTargetValences(writeLevel(level, {}), level.mesh).empty());
  level.guides.resize(level.mesh.faceCount());
  level.guides[7] = { level.mesh.edgeVector(21).normalized(), 0.25F };
  std::vector<int> valences(level.mesh.vertexCount(), 0);
  valences[3] = 5;
  const vtkSmartPointer<vtkPolyData> data = writeLevel(level, valences);
  EXPECT_EQ(readTargetValences(data, level.mesh), valences);
  const std::vector<Guide> guides = readGuides(data, level.mesh);
  ASSERT_EQ(guides.size(), level.guides.size());
  for (std::size_t f = 0; f < guides.size(); ++f)
  {
    EXPECT_EQ(guides[f].weight, level.guides[f].weight);
    EXPECT_EQ(guides[f].direction, level.guides[f].direction);
  }
}

TEST(Convert, MeshRoundTripIsExact)
{
  const Mesh mesh = test::markFeatures(test::unitCube(3), 0.5);
  const Mesh back = readMesh(writeMesh(mesh));
  EXPECT_EQ(back.origin, mesh.origin);
  EXPECT_EQ(back.twin, mesh.twin);
  EXPECT_EQ(back.flags, mesh.flags);
  EXPECT_EQ(back.position, mesh.position);
}

/// Two sheets that meet in a whole edge, both ends shared: the corners alone do not tell the twins.
TEST(Convert, TwinsSurviveWhereCornersDoNotTellThem)
{
  Mesh mesh;
  for (int i = 0; i < 6; ++i)
  {
    mesh.position.push_back(Vector3(i, i * i, 0.5 * i));
  }
  mesh.origin = { 0, 1, 2, 1, 0, 3, 0, 1, 4, 1, 0, 5 };
  mesh.twin.assign(12, kInvalidIndex);
  mesh.flags.assign(12, 0);
  mesh.twin.edit()[0] = 3;
  mesh.twin.edit()[3] = 0;
  mesh.twin.edit()[6] = 9;
  mesh.twin.edit()[9] = 6;
  const vtkSmartPointer<vtkPolyData> data = writeMesh(mesh);
  EXPECT_TRUE(data->GetCellData()->HasArray("Twin"));
  EXPECT_EQ(readMesh(data).twin, mesh.twin);
  EXPECT_FALSE(writeMesh(test::unitCube(2))->GetCellData()->HasArray("Twin"));
}

TEST(Convert, MapRoundTripIsExact)
{
  const Mesh mesh = test::gridPlane(3, 3);
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  std::uint64_t state = 12345; // any bits below 2^52 in magnitude
  const auto next = [&state]
  {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::int64_t>(state >> 12) - (std::int64_t{ 1 } << 51);
  };
  for (FixedVec2& p : uv)
  {
    p = { next(), next() };
  }
  uv[0] = { (std::int64_t{ 1 } << 52) - 1, 1 - (std::int64_t{ 1 } << 52) };
  const vtkSmartPointer<vtkPolyData> data = writeMesh(mesh);
  addMap(data, uv);
  EXPECT_EQ(readMap(data), uv);
}

TEST(Convert, MapBeyondDoublesIsRefused)
{
  const Mesh mesh = test::gridPlane(1, 1);
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  uv[4].v = std::int64_t{ 1 } << 52;
  EXPECT_THROW(addMap(writeMesh(mesh), uv), InvalidInput);
  const vtkSmartPointer<vtkPolyData> data = writeMesh(mesh);
  EXPECT_THROW(readMap(data), InvalidInput);
  uv[4].v = 0;
  addMap(data, uv);
  data->GetCellData()->GetArray("IGM")->SetComponent(1, 3, std::nan(""));
  EXPECT_THROW(readMap(data), InvalidInput);
}

TEST(Convert, DeterminantIsTwiceTheArea)
{
  const Mesh mesh = test::gridPlane(1, 1);
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  uv[1] = { 3 * kOne, 0 };
  uv[2] = { 0, 2 * kOne };
  const vtkSmartPointer<vtkPolyData> data = writeMesh(mesh);
  addMap(data, uv);
  EXPECT_EQ(data->GetCellData()->GetArray("Determinant")->GetTuple1(0), 6);
  EXPECT_EQ(data->GetCellData()->GetArray("Determinant")->GetTuple1(1), 0);
}

TEST(Convert, LogRecipeRoundTrip)
{
  SurfaceRecipe recipe;
  recipe.featureAngle = 40 * test::kPi / 180;
  recipe.featureCriterion = FeatureCriterion::Creases;
  recipe.edgeLength = 0.1;
  recipe.patchArray = "Body";
  recipe.drawn.features = { { { { 0, 0, 1 }, { 0.1, 0.2, 1.0 / 3 } } },
    { { { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 } } } };
  recipe.drawn.valences = { { { 1, 2, 3 }, 5 } };
  recipe.drawn.sizes = { { { 4, 5, 6 }, 0.1, 0.5, 3 } };
  DecimationLog log;
  log.fineHash = 0xfedcba9876543210u;
  vtkNew<vtkTable> table;
  writeLog(log, recipe, table);
  const SurfaceRecipe back = readRecipe(table);
  EXPECT_EQ(back.featureAngle, recipe.featureAngle);
  EXPECT_EQ(back.featureCriterion, FeatureCriterion::Creases);
  EXPECT_EQ(back.edgeLength, recipe.edgeLength);
  EXPECT_EQ(back.patchArray, recipe.patchArray);
  EXPECT_EQ(back.drawn.features, recipe.drawn.features);
  EXPECT_EQ(back.drawn.valences, recipe.drawn.valences);
  EXPECT_EQ(back.drawn.sizes, recipe.drawn.sizes);
  EXPECT_EQ(readLog(table, log.fineHash).fineHash, log.fineHash);
  EXPECT_THROW(readLog(table, 1), InvalidInput);

  // A log of an earlier version has no criterion: there was the angle alone.
  table->GetFieldData()->RemoveArray("RecipeFeatureCriterion");
  EXPECT_EQ(readRecipe(table).featureCriterion, FeatureCriterion::Angle);

  recipe.featureAngle.reset();
  recipe.featureCriterion = FeatureCriterion::Angle;
  vtkNew<vtkTable> off;
  writeLog(log, recipe, off);
  EXPECT_FALSE(readRecipe(off).featureAngle.has_value());
  EXPECT_EQ(readRecipe(off).featureCriterion, FeatureCriterion::Angle);
  vtkNew<vtkTable> nothing;
  EXPECT_THROW(readRecipe(nothing), InvalidInput);
}

} // namespace
} // namespace quadrille
