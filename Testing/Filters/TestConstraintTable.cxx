// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Constraints/ConstraintTable.h"
#include "Constraints/Constraints.h"
#include "TestSurfaces.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkQuadRemesh.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{
namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;

/// n by n unit quads around the origin, turned by an angle.
QuadMesh turnedGrid(int n, double degrees)
{
  QuadMesh mesh;
  const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const double x = i - 0.5 * n, y = j - 0.5 * n;
      const int sides = (i == 0 || i == n) + (j == 0 || j == n);
      mesh.points.emplace_back(c * x - s * y, s * x + c * y, 0);
      mesh.valence.push_back(4 - sides);
      mesh.onBoundary.push_back(sides > 0 ? 1 : 0);
    }
  }
  const auto id = [n](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      mesh.quads.push_back({ id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1) });
    }
  }
  return mesh;
}

/// turnedGrid(20, 0) with a feature along each of these rows.
QuadMesh gridWithFeatures(const std::vector<Index>& rows)
{
  QuadMesh mesh = turnedGrid(20, 0);
  for (const Index row : rows)
  {
    for (Index i = 21 * row; i < 21 * row + 20; ++i)
    {
      mesh.lines.push_back({ i, i + 1, kInvalidIndex, false });
    }
  }
  return mesh;
}

/// A plate of triangles from -4 to 4, well inside of turnedGrid(20, ...).
vtkSmartPointer<vtkPolyData> plate()
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(16, 16));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double p[3];
    data->GetPoint(i, p);
    data->GetPoints()->SetPoint(i, 0.5 * p[0] - 4, 0.5 * p[1] - 4, 0);
  }
  return data;
}

/// Directions at an angle on the cells whose centre `where` says yes to.
template <class Where>
void guide(vtkPolyData* data, double degrees, const Where& where)
{
  vtkNew<vtkDoubleArray> directions;
  directions->SetName("GuidingDirection");
  directions->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    const Vector3 centre = test::cellCentre(data, i);
    const double length = where(centre) ? 3 : 0;
    directions->InsertNextTuple3(
      length * std::cos(degrees * kDegree), length * std::sin(degrees * kDegree), 0);
  }
  data->GetCellData()->AddArray(directions);
}

AskedConstraints ask(vtkPolyData* data, const ConstraintInputs& inputs = {})
{
  ConvertedSurface surface = convertSurface(data, "");
  AskedConstraints asked;
  asked.arrays = arrayConstraints(surface.input);
  asked.placed = applyConstraints(surface, inputs).placed;
  return asked;
}

bool everywhere(const Vector3&)
{
  return true;
}

//------------------------------------------------------------------------------
// Quads of which the answer is known

TEST(ConstraintTable, GuidesAreAsFarOffAsTheQuadsAreTurned)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  // Quads at 20 degrees have edges along 20 and 110; the nearer family counts.
  for (const auto& [degrees, off] : { std::pair{ 0.0, 20.0 }, { 20.0, 0.0 }, { 110.0, 0.0 },
         { 70.0, 40.0 }, { 16.0, 4.0 }, { 14.0, 6.0 } })
  {
    guide(data, degrees, everywhere);
    const auto words = judgeConstraints(ask(data), turnedGrid(20, 20), {});
    ASSERT_EQ(words.size(), 1u);
    EXPECT_STREQ(words[0].kind, "guide array");
    EXPECT_STREQ(words[0].unit, "degrees");
    EXPECT_NEAR(words[0].deviation, off, 1e-9);
    EXPECT_NEAR(words[0].deviation95, off, 1e-9);
    EXPECT_EQ(words[0].isMet, off <= 5);
    EXPECT_EQ(words[0].reason.empty(), words[0].isMet) << words[0].reason;
  }
}

TEST(ConstraintTable, MeanAndPercentileAreByArea)
{
  // Nine tenths of the area along the edges, one tenth across them at 30 degrees: two triangles.
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 1));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double p[3];
    data->GetPoint(i, p);
    data->GetPoints()->SetPoint(i, p[0] == 1 ? 1.8 : p[0], p[1], p[2]);
  }
  guide(data, 0, everywhere);
  vtkDataArray* directions = data->GetCellData()->GetArray("GuidingDirection");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    if (test::cellCentre(data, i).x() > 1.8)
    {
      directions->SetTuple3(i, std::cos(30 * kDegree), std::sin(30 * kDegree), 0);
    }
  }
  const auto words = judgeConstraints(ask(data), turnedGrid(8, 0), {});
  ASSERT_EQ(words.size(), 1u);
  EXPECT_NEAR(words[0].deviation, 3, 1e-9);
  EXPECT_NEAR(words[0].deviation95, 30, 1e-9);
  EXPECT_TRUE(words[0].isMet);
  EXPECT_GT(words[0].place.x(), 1.8); // where it deviates most
}

TEST(ConstraintTable, EachConnectedRegionHasItsRow)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  guide(data, 0, [](const Vector3& p) { return std::abs(p.x()) > 2; });
  const AskedConstraints asked = ask(data);
  const auto words = judgeConstraints(asked, turnedGrid(20, 0), {});
  ASSERT_EQ(words.size(), 2u);
  EXPECT_NE(words[0].source, words[1].source);
  EXPECT_EQ(asked.arrays.guides[0].polygons.size() + asked.arrays.guides[1].polygons.size(), 256u);
}

TEST(ConstraintTable, AStrokeThatRunsOverARegionIsNamed)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  guide(data, 45, everywhere);
  const vtkSmartPointer<vtkPolyData> stroke = test::polyline({ { -4, 0.1, 0 }, { 4, 0.1, 0 } });
  ConstraintInputs inputs;
  inputs.strokes = stroke;
  const auto words = judgeConstraints(ask(data, inputs), turnedGrid(20, 0), {});
  ASSERT_EQ(words.size(), 2u);
  EXPECT_NEAR(words[0].deviation, 45, 1e-9);
  // One of sixteen rows is nearer to it than a quarter of a quad.
  EXPECT_NE(words[0].reason.find("6 % of it is under guiding stroke 0"), std::string::npos)
    << words[0].reason;
  EXPECT_STREQ(words[1].kind, "guide stroke");
  EXPECT_NEAR(words[1].deviation, 0, 1e-9);
  EXPECT_TRUE(words[1].isMet);
}

TEST(ConstraintTable, PointsFartherThanHalfAnEdgeLengthOffTheSurfaceAreTold)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  for (const auto& [height, isTold] : { std::pair{ 0.4, false }, { 0.6, true }, { -3.0, true } })
  {
    const vtkSmartPointer<vtkPolyData> stroke =
      test::polyline({ { -4, 0, 0 }, { 2, 0, height }, { 4, 0, 0 } });
    ConstraintInputs inputs;
    inputs.strokes = stroke;
    const auto words = judgeConstraints(ask(data, inputs), turnedGrid(20, 0), {});
    ASSERT_EQ(words.size(), 1u);
    EXPECT_TRUE(words[0].isMet);
    EXPECT_EQ(words[0].isOffSurface, isTold) << height;
    EXPECT_EQ(words[0].reason, "");
    EXPECT_EQ(words[0].remark.empty(), !isTold) << words[0].remark;
    const std::vector<std::string> notices = offSurfaceNotices(words);
    ASSERT_EQ(notices.size(), isTold ? 1u : 0u);
    EXPECT_TRUE(!isTold || notices[0].find("nearest place is (2, 0, 0)") != std::string::npos)
      << notices[0];
  }
}

TEST(ConstraintTable, CurvesAreAsFarAsTheNearestFeatures)
{
  const vtkSmartPointer<vtkPolyData> data = plate(); // its lines are half a quad apart
  const QuadMesh mesh = gridWithFeatures({ 11 });    // at y = 1
  for (const auto& [y, off] : { std::pair{ 1.0, 0.0 }, { 1.5, 0.5 } })
  {
    const vtkSmartPointer<vtkPolyData> curve = test::polyline({ { -4, y, 0 }, { 4, y, 0 } });
    ConstraintInputs inputs;
    inputs.curves = curve;
    const auto words = judgeConstraints(ask(data, inputs), mesh, {});
    ASSERT_EQ(words.size(), 1u);
    EXPECT_STREQ(words[0].kind, "feature curve");
    EXPECT_STREQ(words[0].unit, "edge lengths");
    EXPECT_NEAR(words[0].deviation, off, 1e-9);
    EXPECT_TRUE(std::isnan(words[0].deviation95));
    EXPECT_EQ(words[0].isMet, off == 0);
    EXPECT_EQ(words[0].place.y(), y);
  }
}

TEST(ConstraintTable, MarkedEdgesAreACurveEach)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  vtkNew<vtkIntArray> bits;
  bits->SetName("FeatureEdges");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    data->GetCellPoints(i, count, ids);
    int marks = 0;
    for (int k = 0; k < 3; ++k)
    {
      const double a = data->GetPoint(ids[k])[1];
      const double b = data->GetPoint(ids[(k + 1) % 3])[1];
      marks |= a == b && (a == -1 || a == 1.5) ? 1 << k : 0;
    }
    bits->InsertNextValue(marks);
  }
  data->GetCellData()->AddArray(bits);
  const AskedConstraints asked = ask(data);
  ASSERT_EQ(asked.arrays.curves.size(), 2u);
  EXPECT_EQ(asked.arrays.curves[0].edges.size(), 16u);
  const auto words = judgeConstraints(asked, gridWithFeatures({ 9, 11 }), {}); // y = -1, y = 1
  EXPECT_TRUE(words[0].isMet);
  EXPECT_NEAR(words[1].deviation, 0.5, 1e-9);
}

TEST(ConstraintTable, ValencesSayWhatIsThere)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  data->GetPoints()->InsertNextPoint(9, 9, 9); // of no face
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  valences->SetNumberOfTuples(data->GetNumberOfPoints());
  valences->Fill(0);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double p[3];
    data->GetPoint(i, p);
    const bool isCorner = std::abs(p[0]) == 4 && std::abs(p[1]) == 4;
    valences->SetValue(i, isCorner && p[0] < 0 ? 2 + (p[1] > 0 ? 1 : 0) : 0);
  }
  valences->SetValue(data->GetNumberOfPoints() - 1, 5);
  data->GetPointData()->AddArray(valences);
  // The corners of eight by eight quads have one quad: valence 3 as it is asked for.
  const auto words = judgeConstraints(ask(data), turnedGrid(8, 0), {});
  ASSERT_EQ(words.size(), 3u);
  EXPECT_FALSE(words[0].isMet);
  EXPECT_TRUE(std::isnan(words[0].deviation));
  EXPECT_EQ(words[0].reason, "asked 2, got 3; the quads have no point of valence 2");
  EXPECT_TRUE(words[1].isMet);
  EXPECT_EQ(words[1].deviation, 0);
  EXPECT_FALSE(words[2].isMet);
  EXPECT_TRUE(std::isnan(words[2].deviation));
  EXPECT_EQ(words[2].reason, "no face uses the point");
}

TEST(ConstraintTable, SizesAreComparedWithEachOther)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  vtkNew<vtkFloatArray> asked;
  asked->SetName("Sizing");
  asked->SetNumberOfTuples(data->GetNumberOfPoints());
  asked->Fill(3); // all alike: the number of quads says how large that is
  data->GetPointData()->AddArray(asked);
  const QuadMesh mesh = turnedGrid(8, 0);
  vtkNew<vtkDoubleArray> there;
  there->SetNumberOfTuples(static_cast<vtkIdType>(mesh.points.size()));
  there->Fill(3);
  auto words = judgeConstraints(ask(data), mesh, valuesOf(there));
  ASSERT_EQ(words.size(), 1u);
  EXPECT_NEAR(words[0].deviation, 1, 1e-12);
  EXPECT_TRUE(words[0].isMet);
  // Twice as large where x is above 2, one and a half times between 1 and 2: of eight columns five are as
  // the median, one is smaller by 1.5 and two by 2.
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    there->SetValue(static_cast<vtkIdType>(i), mesh.points[i].x() > 1.5 ? 2 : 1);
  }
  words = judgeConstraints(ask(data), mesh, valuesOf(there));
  EXPECT_NEAR(words[0].deviation, std::pow(1.5 * 2 * 2, 1.0 / 8), 1e-12);
  EXPECT_NEAR(words[0].deviation95, 2, 1e-12);
}

TEST(ConstraintTable, WhatIsNotFollowedHasARowToo)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  const vtkSmartPointer<vtkPolyData> point = test::polyline({ { 1, 1, 0 }, { 1, 1, 0 } });
  ConstraintInputs inputs;
  inputs.curves = point;
  inputs.strokes = point;
  const AskedConstraints asked = ask(data, inputs);
  const QuadMesh mesh = turnedGrid(20, 0);
  const auto words = judgeConstraints(asked, mesh, {});
  ASSERT_EQ(words.size(), 2u);
  for (const ConstraintWord& word : words)
  {
    EXPECT_FALSE(word.isMet);
    EXPECT_NE(word.reason.find("has no length"), std::string::npos);
    EXPECT_EQ(word.place, Vector3(1, 1, 0));
  }
  // What is not followed is shown where it was drawn.
  const vtkSmartPointer<vtkPolyData> shown =
    writeConstraints(asked.placed, mesh, metOfDrawn(words, asked));
  EXPECT_EQ(shown->GetNumberOfVerts(), 2);
  EXPECT_EQ(shown->GetNumberOfCells(), 2);
  EXPECT_EQ(shown->GetCellData()->GetScalars()->GetRange()[1], 0);
}

TEST(ConstraintTable, WithoutQuadsNothingIsMet)
{
  const vtkSmartPointer<vtkPolyData> data = plate();
  guide(data, 0, everywhere);
  const auto words = judgeConstraints(ask(data), {}, {});
  ASSERT_EQ(words.size(), 1u);
  EXPECT_FALSE(words[0].isMet);
  EXPECT_EQ(words[0].reason, "no quads were made");
}

//------------------------------------------------------------------------------
// Quads that the filter makes, measured in another way

/// The quad that holds a place of the plane, by all of them, and the directions of the edges round it.
double offInPlane(vtkPolyData* quads, const Vector3& place, double degrees)
{
  for (vtkIdType q = 0; q < quads->GetNumberOfCells(); ++q)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    quads->GetCellPoints(q, count, ids);
    std::array<Vector3, 4> p;
    for (std::size_t k = 0; k < 4; ++k)
    {
      quads->GetPoint(ids[k], p[k].data());
    }
    bool isInside = true;
    for (std::size_t k = 0; k < 4; ++k)
    {
      isInside = isInside && (p[(k + 1) % 4] - p[k]).cross(place - p[k]).z() >= 0;
    }
    if (isInside)
    {
      double least = 90;
      for (const Vector3& edge :
        { Vector3(p[1] + p[2] - p[0] - p[3]), Vector3(p[2] + p[3] - p[0] - p[1]) })
      {
        const double angle = std::atan2(edge.y(), edge.x()) / kDegree - degrees;
        const double turned = std::abs(angle - 180 * std::round(angle / 180));
        least = std::min(least, turned);
      }
      return least;
    }
  }
  return std::nan("");
}

TEST(ConstraintTable, OfTwoContradictingValencesTheLaterOneIsLeftOut)
{
  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> coordinates;
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  const double given[4][3] = { { 10, 20, 5 }, { 30, 20, 3 }, { 10.005, 20.005, 3 }, { 0, 20, 2 } };
  for (const double* p : given)
  {
    coordinates->InsertNextPoint(p[0], p[1], 0);
    valences->InsertNextValue(static_cast<int>(p[2]));
  }
  points->SetPoints(coordinates);
  points->GetPointData()->AddArray(valences);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(test::toPolyData(test::gridPlane(40, 40)));
  filter->SetValencePointsData(points);
  filter->SetNumberOfQuads(900);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkTable* table = filter->GetConstraintTable();
  ASSERT_EQ(table->GetNumberOfRows(), 4);
  for (const vtkIdType row : { 0, 1 })
  {
    EXPECT_EQ(table->GetValueByName(row, "Met").ToInt(), 1);
  }
  const std::string contradiction = table->GetValueByName(2, "Reason").ToString();
  EXPECT_EQ(table->GetValueByName(2, "Met").ToInt(), 0);
  EXPECT_NE(contradiction.find("where 5 is asked for already"), std::string::npos) << contradiction;
  // A corner of no quads.
  EXPECT_EQ(table->GetValueByName(3, "Met").ToInt(), 0);
  EXPECT_NE(
    table->GetValueByName(3, "Reason").ToString().find("the least is 3"), std::string::npos);
  EXPECT_NE(messages.warnings.find("is left out"), std::string::npos) << messages.warnings;
}

// What cannot be met together with what comes before it is left out, with the reason, and the rest has quads.
TEST(ConstraintTable, WhatHasNoQuadsIsLeftOut)
{
  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> coordinates;
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  const double given[3][4] = { { 16, 16, 0, 5 }, { 19.98, 19.98, 0, 8 }, { 4, 4, 0, 3 } };
  for (const double* p : given)
  {
    coordinates->InsertNextPoint(p[0], p[1], p[2]);
    valences->InsertNextValue(static_cast<int>(p[3]));
  }
  points->SetPoints(coordinates);
  points->GetPointData()->AddArray(valences);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(test::toPolyData(test::gridPlane(20, 20)));
  filter->SetValencePointsData(points);
  filter->SetNumberOfQuads(40);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
  vtkTable* table = filter->GetConstraintTable();
  ASSERT_EQ(table->GetNumberOfRows(), 3);
  EXPECT_EQ(table->GetValueByName(0, "Met").ToInt(), 1);
  EXPECT_EQ(table->GetValueByName(1, "Met").ToInt(), 0);
  EXPECT_EQ(table->GetValueByName(2, "Met").ToInt(), 1);
  const std::string reason = table->GetValueByName(1, "Reason").ToString();
  EXPECT_EQ(reason.find("it cannot be met together with valence 0: "), 0U) << reason;
  EXPECT_NE(messages.warnings.find("valence 1 is left out: " + reason), std::string::npos)
    << messages.warnings;
}

TEST(ConstraintTable, AgreesWithTheQuadsOfTheFilter)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(40, 40));
  const auto isGuided = [](const Vector3& p) { return (p - Vector3(20, 20, 0)).norm() < 9; };
  guide(data, 30, isGuided);
  const vtkSmartPointer<vtkPolyData> curve = test::polyline({ { 0, 5, 0 }, { 40, 5, 0 } });
  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> coordinates;
  coordinates->InsertNextPoint(10, 32, 0);
  coordinates->InsertNextPoint(30, 32, 0);
  points->SetPoints(coordinates);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(data);
  filter->SetCurvesData(curve);
  filter->SetValencePointsData(points);
  filter->SetPointValence(5);
  filter->SetNumberOfQuads(900);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkPolyData* quads = filter->GetOutput();
  vtkTable* table = filter->GetConstraintTable();
  ASSERT_EQ(table->GetNumberOfRows(), 4);
  const auto value = [table](vtkIdType row, const char* column)
  { return table->GetValueByName(row, column).ToDouble(); };
  const auto text = [table](vtkIdType row, const char* column)
  { return table->GetValueByName(row, column).ToString(); };
  double sum = 0;
  int count = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    const Vector3 centre = test::cellCentre(data, i);
    const double off = isGuided(centre) ? offInPlane(quads, centre, 30) : std::nan("");
    count += std::isnan(off) ? 0 : 1; // the cells are of one size
    sum += std::isnan(off) ? 0 : off;
  }
  ASSERT_GT(count, 400);
  EXPECT_EQ(text(0, "Kind"), "guide array");
  // Here the edges of a quad count as one direction each, in the table they are blended.
  EXPECT_NEAR(value(0, "Deviation"), sum / count, 0.5);
  EXPECT_GE(value(0, "Deviation95"), value(0, "Deviation"));
  EXPECT_EQ(value(0, "Met"), value(0, "Deviation") <= 5 ? 1 : 0);
  EXPECT_EQ(text(1, "Kind"), "feature curve");
  EXPECT_LT(value(1, "Deviation"), 1e-6);
  EXPECT_EQ(value(1, "Met"), 1);
  for (vtkIdType row = 2; row < 4; ++row)
  {
    EXPECT_EQ(text(row, "Kind"), "valence");
    EXPECT_EQ(value(row, "SourceId"), row - 2);
    const Vector3 place(row == 2 ? 10 : 30, 32, 0);
    double least = 1e300;
    for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
    {
      const bool isFive = quads->GetPointData()->GetArray("Valence")->GetTuple1(i) == 5;
      least = isFive ? std::min(least, (Vector3(quads->GetPoint(i)) - place).norm()) : least;
    }
    const double edge = 40 / std::sqrt(900.0);
    EXPECT_NEAR(value(row, "Deviation"), least / edge, 0.5 * least / edge + 1e-9);
    EXPECT_EQ(value(row, "Met"), 1);
    EXPECT_LE(least, 0.3 * edge);
  }
  for (vtkIdType row = 0; row < 4; ++row)
  {
    EXPECT_EQ(value(row, "Id"), static_cast<double>(row));
    EXPECT_EQ(text(row, "Reason").empty(), value(row, "Met") == 1) << text(row, "Reason");
  }
  std::string result = filter->GetResultText(); // wrapped for the panel
  std::replace(result.begin(), result.end(), '\n', ' ');
  result.erase(
    std::unique(result.begin(), result.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
    result.end());
  EXPECT_NE(result.find("of 4 constraints met"), std::string::npos) << result;
}

TEST(ConstraintTable, IsEmptyWhereNothingIsAskedAndBlocksHaveTheirOwn)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  const vtkSmartPointer<vtkPolyData> guided = plate();
  guide(guided, 0, everywhere);
  blocks->SetBlock(0, plate());
  blocks->SetBlock(1, guided);
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(blocks);
  filter->SetNumberOfQuads(200);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  auto* tables = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(6));
  ASSERT_NE(tables, nullptr);
  for (unsigned i = 0; i < 2; ++i)
  {
    auto* table = vtkTable::SafeDownCast(tables->GetBlock(i));
    ASSERT_NE(table, nullptr);
    EXPECT_EQ(table->GetNumberOfRows(), static_cast<vtkIdType>(i));
    EXPECT_EQ(table->GetNumberOfColumns(), 12);
  }
}

} // namespace
} // namespace quadrille
