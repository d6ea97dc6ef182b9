// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"
#include "TestSurfaces.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDecimationHierarchy.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkIntegerGridMap.h>
#include <vtkLogger.h>
#include <vtkMath.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkQuadRemesh.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTrivialProducer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

namespace quadrille
{
namespace
{

void run(vtkQuadRemesh* filter, vtkPolyData* input, vtkIdType quads)
{
  filter->SetInputData(input);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(quads);
  filter->Update();
}

/// Every valid result: only quads, manifold, oriented, the input's Euler characteristic, and for a
/// closed one sum(4 - valence) = 4 chi.
void expectValid(vtkQuadRemesh* filter, long long eulerCharacteristic, bool closed)
{
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkPolyData* quads = filter->GetOutput();
  ASSERT_GT(quads->GetNumberOfPolys(), 0);
  EXPECT_EQ(quads->GetNumberOfCells(), quads->GetNumberOfPolys());
  const test::QuadTally t = test::tally(quads);
  EXPECT_TRUE(t.onlyQuads);
  EXPECT_EQ(t.badEdges, 0u);
  EXPECT_EQ(t.eulerCharacteristic, eulerCharacteristic);
  EXPECT_EQ(t.boundaryEdges == 0, closed);
  vtkDataArray* valence = quads->GetPointData()->GetArray("Valence");
  vtkDataArray* boundary = quads->GetPointData()->GetArray("OnBoundary");
  ASSERT_TRUE(valence && boundary);
  long long index = 0;
  for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
  {
    index += (boundary->GetTuple1(i) != 0 ? 3 : 4) - static_cast<long long>(valence->GetTuple1(i));
  }
  EXPECT_EQ(index, 4 * eulerCharacteristic);
}

TEST(QuadRemesh, TorusIsClosedAndOfGenusOne)
{
  vtkNew<vtkQuadRemesh> filter;
  run(filter, test::toPolyData(test::torus(80, 40)), 600);
  expectValid(filter, 0, true);
  EXPECT_EQ(filter->GetActualQuads(), filter->GetOutput()->GetNumberOfPolys());
  EXPECT_STREQ(filter->GetOutcomeText(), "");
  EXPECT_NE(std::string(filter->GetStageTimesText()).find("extract"), std::string::npos);
}

TEST(QuadRemesh, OpenPlateHasItsBoundary)
{
  vtkNew<vtkQuadRemesh> filter;
  run(filter, test::toPolyData(test::gridPlane(30, 30)), 400);
  expectValid(filter, 1, false);
  vtkPolyData* lines = filter->GetLines();
  EXPECT_EQ(static_cast<std::size_t>(lines->GetNumberOfLines()),
    test::tally(filter->GetOutput()).boundaryEdges);
  vtkDataArray* boundary = lines->GetCellData()->GetArray("Boundary");
  EXPECT_EQ(boundary->GetRange()[0], 1);
}

TEST(QuadRemesh, CubeKeepsItsTwelveEdges)
{
  vtkNew<vtkQuadRemesh> filter;
  const Mesh cube = test::unitCube(12);
  run(filter, test::toPolyData(cube), 600);
  expectValid(filter, 2, true);
  vtkPolyData* lines = filter->GetLines();
  double bounds[6];
  filter->GetOutput()->GetBounds(bounds);
  const double side = bounds[1] - bounds[0];
  double length = 0;
  for (vtkIdType i = 0; i < lines->GetNumberOfLines(); ++i)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCellPoints(i, count, ids);
    Vector3 a, b;
    lines->GetPoint(ids[0], a.data());
    lines->GetPoint(ids[1], b.data());
    length += (b - a).norm();
  }
  EXPECT_NEAR(length, 12 * side, 1e-9 * side); // points on straight edges: only rounding
  // Each feature edge is told by both of its quads.
  vtkDataArray* bits = filter->GetOutput()->GetCellData()->GetArray("FeatureEdges");
  long long marked = 0;
  for (vtkIdType i = 0; i < bits->GetNumberOfTuples(); ++i)
  {
    marked += __builtin_popcount(static_cast<unsigned>(bits->GetTuple1(i)));
  }
  EXPECT_EQ(marked, 2 * lines->GetNumberOfLines());
  // Its corners are irregular, and no move takes them.
  vtkPointData* irregular = filter->GetIrregularVertices()->GetPointData();
  ASSERT_GE(irregular->GetNumberOfTuples(), 8);
  vtkIdType corners = 0;
  for (vtkIdType i = 0; i < irregular->GetNumberOfTuples(); ++i)
  {
    const double movable = irregular->GetArray("MovableValence")->GetTuple1(i);
    corners += movable == 0 ? 1 : 0;
    EXPECT_TRUE(movable == 0 || movable == irregular->GetArray("Valence")->GetTuple1(i));
  }
  EXPECT_EQ(corners, 8);
}

/// An array that is linear in the coordinates is reproduced exactly up to rounding by barycentric
/// interpolation, whatever triangles it goes through.
TEST(QuadRemesh, CarriesArraysThroughTheirSource)
{
  const Mesh mesh = test::unitCube(10);
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(mesh);
  vtkNew<vtkDoubleArray> linear;
  linear->SetName("Linear");
  vtkNew<vtkIdTypeArray> pointId, cellId;
  pointId->SetName("PointId");
  cellId->SetName("CellId");
  const auto f = [](const double* p) { return 3 * p[0] - 2 * p[1] + 0.5 * p[2] + 7; };
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    linear->InsertNextValue(f(input->GetPoint(i)));
    pointId->InsertNextValue(i);
  }
  for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
  {
    cellId->InsertNextValue(i);
  }
  input->GetPointData()->AddArray(linear);
  input->GetPointData()->AddArray(pointId);
  input->GetCellData()->AddArray(cellId);
  vtkNew<vtkQuadRemesh> filter;
  run(filter, input, 500);
  expectValid(filter, 2, true);

  for (vtkPolyData* output : { filter->GetOutput(), filter->GetMappedSurface() })
  {
    vtkDataArray* carried = output->GetPointData()->GetArray("Linear");
    ASSERT_NE(carried, nullptr);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      ASSERT_NEAR(carried->GetTuple1(i), f(output->GetPoint(i)), 1e-12 * 20);
    }
  }
  vtkPolyData* quads = filter->GetOutput();
  auto* sourceCell = vtkIdTypeArray::SafeDownCast(quads->GetPointData()->GetArray("SourceCellId"));
  auto* sourcePoints =
    vtkIdTypeArray::SafeDownCast(quads->GetPointData()->GetArray("SourcePointIds"));
  vtkDataArray* weights = quads->GetPointData()->GetArray("SourceBarycentric");
  vtkDataArray* nearest = quads->GetPointData()->GetArray("PointId");
  for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    input->GetCellPoints(sourceCell->GetValue(i), count, ids);
    Vector3 position = Vector3::Zero();
    bool oneOfThem = false;
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_EQ(sourcePoints->GetTypedComponent(i, k), ids[k]); // the cell's own order
      position += weights->GetComponent(i, k) * Vector3(input->GetPoint(ids[k]));
      oneOfThem = oneOfThem || nearest->GetTuple1(i) == ids[k];
    }
    EXPECT_LT((position - Vector3(quads->GetPoint(i))).norm(), 1e-12);
    EXPECT_TRUE(oneOfThem);
  }
  EXPECT_TRUE(quads->GetCellData()->HasArray("CellId"));
  for (vtkIdType i = 0; i < quads->GetNumberOfCells(); ++i)
  {
    ASSERT_EQ(quads->GetCellData()->GetArray("CellId")->GetTuple1(i),
      quads->GetCellData()->GetArray("SourceCellId")->GetTuple1(i));
  }
}

TEST(QuadRemesh, PatchBordersAreLinesWithTheirPair)
{
  const Mesh mesh = test::gridPlane(24, 24);
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(mesh);
  double bounds[6];
  input->GetBounds(bounds);
  const double middle = 0.5 * (bounds[0] + bounds[1]);
  vtkNew<vtkIntArray> body;
  body->SetName("Body");
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 centre =
      (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
        mesh.position[mesh.origin[3 * f + 2]]) /
      3;
    body->InsertNextValue(centre.x() < middle ? 5 : -3);
  }
  input->GetCellData()->AddArray(body);
  vtkNew<vtkQuadRemesh> filter;
  filter->SetPatchArrayName("Body");
  run(filter, input, 300);
  expectValid(filter, 1, false);
  vtkPolyData* lines = filter->GetLines();
  vtkDataArray* pairs = lines->GetCellData()->GetArray("PatchIds");
  vtkDataArray* boundary = lines->GetCellData()->GetArray("Boundary");
  ASSERT_TRUE(pairs && boundary);
  int inner = 0;
  for (vtkIdType i = 0; i < lines->GetNumberOfLines(); ++i)
  {
    if (boundary->GetTuple1(i) == 0)
    {
      ++inner;
      EXPECT_EQ(pairs->GetComponent(i, 0), -3);
      EXPECT_EQ(pairs->GetComponent(i, 1), 5);
    }
    else
    {
      EXPECT_EQ(pairs->GetComponent(i, 0), pairs->GetComponent(i, 1));
    }
  }
  EXPECT_GT(inner, 0);
}

TEST(QuadRemesh, FieldDataSurvivesAFile)
{
  vtkNew<vtkQuadRemesh> filter;
  run(filter, test::toPolyData(test::torus(40, 20)), 300);
  expectValid(filter, 0, true);
  const std::string path = testing::TempDir() + "quadrille_fields.vtp";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(filter->GetOutput());
  writer->SetFileName(path.c_str());
  writer->SetDataModeToBinary();
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  std::remove(path.c_str());
  vtkFieldData* fields = reader->GetOutput()->GetFieldData();
  ASSERT_TRUE(fields->HasArray("ActualQuads"));
  EXPECT_EQ(fields->GetArray("ActualQuads")->GetTuple1(0), filter->GetActualQuads());
  EXPECT_EQ(fields->GetArray("CertificateValid")->GetTuple1(0), 1);
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("StageNames"));
  ASSERT_NE(names, nullptr);
  EXPECT_EQ(names->GetNumberOfValues(), fields->GetArray("StageSeconds")->GetNumberOfTuples());
}

TEST(QuadRemesh, MappedSurfaceIsAnIntegerGridMap)
{
  vtkNew<vtkQuadRemesh> filter;
  run(filter, test::toPolyData(test::torus(60, 30)), 400);
  expectValid(filter, 0, true);
  vtkPolyData* mapped = filter->GetMappedSurface();
  const Mesh mesh = readMesh(mapped);
  EXPECT_EQ(validate(mesh), "");
  const std::vector<FixedVec2> uv = readMap(mapped);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    bool residual = false;
    if (!mesh.isBoundary(h))
    {
      EXPECT_TRUE(isInteger(transitionOf(mesh, uv, h, 0, &residual).translation));
    }
    EXPECT_FALSE(residual);
  }
  EXPECT_GT(mapped->GetCellData()->GetArray("Determinant")->GetRange()[0], 0);
  // Texture coordinates are the map, at float precision.
  vtkDataArray* texture = mapped->GetPointData()->GetTCoords();
  ASSERT_NE(texture, nullptr);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    mapped->GetCellPoints(f, count, ids);
    for (Index i = 0; i < 3; ++i)
    {
      ASSERT_FLOAT_EQ(static_cast<float>(texture->GetComponent(ids[i], 0)),
        static_cast<float>(toDouble(uv[3 * f + i].u)));
    }
  }
}

TEST(QuadRemesh, SameBytesForAnyNumberOfThreads)
{
  std::vector<std::vector<double>> runs;
  for (const int threads : { 1, 2 })
  {
    vtkNew<vtkQuadRemesh> filter;
    filter->SetNumberOfThreads(threads);
    run(filter, test::toPolyData(test::torus(60, 30)), 400);
    expectValid(filter, 0, true);
    std::vector<double> coordinates;
    for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); ++i)
    {
      const double* p = filter->GetOutput()->GetPoint(i);
      coordinates.insert(coordinates.end(), p, p + 3);
    }
    runs.push_back(coordinates);
  }
  EXPECT_EQ(runs[0], runs[1]);
}

//------------------------------------------------------------------------------
// Failures

TEST(QuadRemeshFailure, NamesThePointThatIsNotFinite)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::gridPlane(4, 4));
  input->GetPoints()->SetPoint(7, 0, std::nan(""), 0);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 100);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(filter->GetOutcomeText()).find("7"), std::string::npos)
    << filter->GetOutcomeText();
  EXPECT_NE(messages.errors.find(filter->GetOutcomeText()), std::string::npos);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(filter->GetMappedSurface()->GetNumberOfCells(), 0);
}

/// Collects what VTK would print.
class Window : public vtkOutputWindow
{
public:
  static Window* New() { VTK_STANDARD_NEW_BODY(Window); }
  vtkTypeMacro(Window, vtkOutputWindow);
  void DisplayText(const char* text) override { lines.emplace_back(text); }
  std::vector<std::string> lines;
};

/// ParaView asks every port in turn: the run is not repeated, and its reason printed once, without the executive's dump
/// of the request.
TEST(QuadRemeshFailure, IsToldOnceForAllPorts)
{
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  vtkNew<Window> window;
  vtkOutputWindow::SetInstance(window);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(test::toPolyData(test::torus(80, 40)));
  filter->SetTargetTypeToEdgeLength();
  filter->SetEdgeLength(-1);
  for (int i = 0; i < 2 * filter->GetNumberOfOutputPorts(); ++i)
  {
    filter->Update(i / 2);
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
    EXPECT_STRNE(filter->GetOutcomeText(), "");
  }
  EXPECT_EQ(window->lines.size(), 1u);
  // A change is a new attempt, and its failure news.
  filter->SetEdgeLength(-2);
  filter->Update();
  EXPECT_EQ(window->lines.size(), 2u);
  filter->SetEdgeLength(0.3);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_EQ(window->lines.size(), 2u);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
  vtkOutputWindow::SetInstance(before);
}

/// A sphere, and one with a tree of features through all its points, which too few quads cannot follow.
vtkSmartPointer<vtkPolyData> sphereAndOneWithoutMap()
{
  const Mesh sphere = test::sphere(3);
  const vtkSmartPointer<vtkPolyData> data =
    test::toPolyData(test::disjointUnion(sphere, sphere, Vector3(3, 0, 0)));
  vtkNew<vtkUnsignedCharArray> edges;
  edges->SetName("FeatureEdges");
  for (Index f = 0; f < sphere.faceCount(); ++f)
  {
    edges->InsertNextValue(0);
  }
  for (const std::uint8_t bits : test::spanningTree(sphere))
  {
    edges->InsertNextValue(bits);
  }
  data->GetCellData()->AddArray(edges);
  return data;
}

std::map<int, vtkIdType> countProblems(vtkQuadRemesh* filter)
{
  std::map<int, vtkIdType> counts;
  auto* data = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(8));
  vtkDataArray* kinds = data->GetCellData()->GetArray("Problem");
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    ++counts[static_cast<int>(kinds->GetTuple1(i))];
  }
  EXPECT_EQ(data->GetNumberOfVerts(), counts[1] + counts[2]);
  return counts;
}

TEST(QuadRemeshFailure, OneComponentDoesNotTakeTheOthersWithIt)
{
  const vtkSmartPointer<vtkPolyData> input = sphereAndOneWithoutMap();
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 40);
  expectValid(filter, 2, true);
  EXPECT_EQ(messages.errors, "");
  EXPECT_EQ(filter->GetComponentsWithoutQuads(), 1);
  const std::string verdict = filter->GetVerdict();
  EXPECT_EQ(verdict.find("1 of 2 connected components, with 50 % of the area, without quads: "), 0u)
    << verdict;
  EXPECT_EQ(std::string(filter->GetCertificateText()).find("1 of 2 connected components"), 0u);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("CertificateValid")->GetTuple1(0), 0);
  std::map<int, vtkIdType> problems = countProblems(filter);
  EXPECT_EQ(problems[0], input->GetNumberOfCells() / 2);
  EXPECT_GT(problems[1], 0);

  filter->SetFailedComponents(vtkQuadRemesh::FAIL_WITH_FAILED_COMPONENTS);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::NoValidResult);
  EXPECT_NE(messages.errors, "");
  // The quads from before stay; of the failure the places alone are shown beside them.
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
  problems = countProblems(filter);
  EXPECT_EQ(problems[0], 0);
  EXPECT_GT(problems[1], 0);
}

TEST(QuadRemeshFailure, ShowsAnInputWithoutPolygons)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::gridPlane(4, 4));
  vtkNew<vtkCellArray> vertices, lines;
  vertices->InsertNextCell({ 3 });
  vertices->InsertNextCell({ 7 });
  lines->InsertNextCell({ 0, 1, 2 });
  input->SetPolys(nullptr);
  input->SetVerts(vertices);
  input->SetLines(lines);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 40);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  auto* problems = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(8));
  EXPECT_EQ(problems->GetNumberOfVerts(), 2);
  EXPECT_EQ(problems->GetNumberOfLines(), 1);
  vtkDataArray* kinds = problems->GetCellData()->GetArray("Problem");
  EXPECT_EQ(kinds->GetNumberOfTuples(), 3);
  EXPECT_EQ(kinds->GetRange()[1], 0);
}

/// A band with half a twist.
vtkSmartPointer<vtkPolyData> moebius(vtkIdType around)
{
  constexpr double halfWidth = 0.3;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (vtkIdType i = 0; i < around; ++i)
  {
    const double angle = 2 * vtkMath::Pi() * static_cast<double>(i) / static_cast<double>(around);
    for (const double s : { -halfWidth, halfWidth })
    {
      const double r = 1 + s * std::cos(angle / 2);
      points->InsertNextPoint(r * std::cos(angle), r * std::sin(angle), s * std::sin(angle / 2));
    }
    const bool isLast = i + 1 == around;
    polygons->InsertNextCell({ 2 * i, 2 * i + 1, isLast ? 0 : 2 * i + 3, isLast ? 1 : 2 * i + 2 });
  }
  auto band = vtkSmartPointer<vtkPolyData>::New();
  band->SetPoints(points);
  band->SetPolys(polygons);
  return band;
}

/// Where the first cell of the output Problems begins.
const double* firstProblem(vtkQuadRemesh* filter)
{
  auto* problems = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(8));
  return problems->GetPoint(problems->GetCell(0)->GetPointId(0));
}

/// The mean of its corners.
std::array<double, 3> middleOfCell(vtkPolyData* input, vtkIdType cell)
{
  std::array<double, 3> middle{};
  const vtkIdType corners = input->GetCell(cell)->GetNumberOfPoints();
  for (vtkIdType corner = 0; corner < corners; ++corner)
  {
    vtkMath::Add(
      middle.data(), input->GetPoint(input->GetCell(cell)->GetPointId(corner)), middle.data());
  }
  vtkMath::MultiplyScalar(middle.data(), 1.0 / static_cast<double>(corners));
  return middle;
}

TEST(QuadRemeshFailure, MarksThePolygonWhereABandIsTwisted)
{
  const vtkSmartPointer<vtkPolyData> input = moebius(12);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 40);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_EQ(countProblems(filter)[0], input->GetNumberOfCells());
  ASSERT_EQ(countProblems(filter)[1], 1);
  const double* mark = firstProblem(filter);
  double least = 1;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    least =
      std::min(least, vtkMath::Distance2BetweenPoints(mark, middleOfCell(input, cell).data()));
  }
  EXPECT_NEAR(least, 0, 1e-20); // rounding of sums of four
}

TEST(QuadRemeshFailure, MarksWhereAnArrayHasAValueThatCannotBe)
{
  constexpr vtkIdType kWrong = 7;
  for (const bool isOfCell : { false, true })
  {
    const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::gridPlane(6, 6));
    vtkNew<vtkDoubleArray> values;
    values->SetName(isOfCell ? "GuidingWeight" : "Sizing");
    values->SetNumberOfTuples(isOfCell ? input->GetNumberOfCells() : input->GetNumberOfPoints());
    values->Fill(1);
    values->SetValue(kWrong, -1);
    if (isOfCell)
    {
      vtkNew<vtkDoubleArray> directions;
      directions->SetName("GuidingDirection");
      directions->SetNumberOfComponents(3);
      directions->SetNumberOfTuples(input->GetNumberOfCells());
      directions->Fill(1);
      input->GetCellData()->AddArray(directions);
      input->GetCellData()->AddArray(values);
    }
    else
    {
      input->GetPointData()->AddArray(values);
    }
    vtkNew<vtkQuadRemesh> filter;
    const test::Messages messages(filter);
    run(filter, input, 40);
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
    EXPECT_EQ(countProblems(filter)[0], input->GetNumberOfCells());
    ASSERT_EQ(countProblems(filter)[1], 1);
    const double* mark = firstProblem(filter);
    std::array<double, 3> place = middleOfCell(input, kWrong);
    if (!isOfCell)
    {
      input->GetPoint(kWrong, place.data());
    }
    EXPECT_NEAR(
      vtkMath::Distance2BetweenPoints(mark, place.data()), 0, 1e-20); // rounding of sums of three
  }
}

// A thin ring, whose tube a quad of 5,000 goes round by more than 45 degrees.
TEST(QuadRemesh, TheShapeSaysHowManyWhereNobodyDoes)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(600, 24, 1, 0.0102));
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_EQ(filter->GetTargetQuads(), 7000);
  EXPECT_NE(std::string(filter->GetVerdict()).find(" quads (about 7000 for its shape), "),
    std::string::npos)
    << filter->GetVerdict();
  EXPECT_NE(std::string(filter->GetNoticesText()).find("7000 quads are asked for, as nobody"),
    std::string::npos);
  vtkNew<vtkQuadRemesh> given;
  run(given, input, 7000);
  EXPECT_EQ(std::string(given->GetNoticesText()).find("as nobody"), std::string::npos);
  EXPECT_NE(
    std::string(given->GetVerdict()).find(" quads (about 7000 asked for), "), std::string::npos);
  vtkNew<vtkQuadRemesh> thick;
  thick->SetInputData(test::toPolyData(test::torus(60, 30)));
  thick->Update();
  EXPECT_NE(
    std::string(thick->GetVerdict()).find(" quads (about 5000 by default), "), std::string::npos)
    << thick->GetVerdict();
  ASSERT_EQ(given->GetOutput()->GetNumberOfPoints(), filter->GetOutput()->GetNumberOfPoints());
  for (vtkIdType i = 0; i < given->GetOutput()->GetNumberOfPoints(); ++i)
  {
    double a[3], b[3];
    given->GetOutput()->GetPoint(i, a);
    filter->GetOutput()->GetPoint(i, b);
    ASSERT_TRUE(std::equal(a, a + 3, b)) << i;
  }
  run(filter, input, 5000);
  EXPECT_EQ(filter->GetTargetQuads(), 5000);
}

TEST(QuadRemeshFailure, ShowsTheInputWhereNothingElseIs)
{
  const vtkSmartPointer<vtkPolyData> input = sphereAndOneWithoutMap();
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetFailedComponents(vtkQuadRemesh::FAIL_WITH_FAILED_COMPONENTS);
  run(filter, input, 40);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::NoValidResult);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(std::string(filter->GetVerdict()).find("Failed: ask for smaller quads"), 0u)
    << filter->GetVerdict();
  EXPECT_EQ(countProblems(filter)[0], input->GetNumberOfCells());
  EXPECT_GT(countProblems(filter)[1], 0);
  EXPECT_STREQ(filter->GetRemedyText(), "NumberOfQuads 160"); // half the edge length
  // So it is where a property is at fault; a success takes it away.
  filter->SetTargetTypeToEdgeLength();
  filter->SetEdgeLength(-1);
  filter->Update();
  EXPECT_EQ(countProblems(filter)[0], input->GetNumberOfCells());
  EXPECT_EQ(countProblems(filter)[1], 0);
  EXPECT_STREQ(filter->GetRemedyText(), "");
  input->GetCellData()->RemoveArray("FeatureEdges");
  filter->SetEdgeLength(0.3);
  filter->Update();
  expectValid(filter, 4, true);
  EXPECT_EQ(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(8))->GetNumberOfCells(), 0);
  EXPECT_NE(std::string(filter->GetVerdict()).find(", all valid"), std::string::npos)
    << filter->GetVerdict();
  EXPECT_STREQ(filter->GetRemedyText(), "");
}

TEST(QuadRemeshFailure, TellsThePropertyThatMendsIt)
{
  const vtkSmartPointer<vtkPolyData> input = sphereAndOneWithoutMap();
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 40);
  EXPECT_EQ(filter->GetComponentsWithoutQuads(), 1);
  EXPECT_STREQ(filter->GetRemedyText(), "NumberOfQuads 160");
  // Quads that a limit forbids are no remedy.
  filter->SetMaximumNumberOfQuads(2 * filter->GetTargetQuads());
  filter->Update();
  EXPECT_STREQ(filter->GetRemedyText(), "");
  // A limit that was in the way is the remedy: with it there are quads.
  filter->SetMaximumNumberOfQuads(5);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::TooLarge);
  std::istringstream words(filter->GetRemedyText());
  std::string property;
  vtkIdType limit = 0;
  words >> property >> limit;
  EXPECT_EQ(property, "MaximumNumberOfQuads");
  filter->SetMaximumNumberOfQuads(limit);
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(QuadRemeshFailure, EmptyInputIsAnErrorInASerialRun)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, empty, 100);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(messages.errors, "");
}

TEST(QuadRemeshFailure, EmptyInputOnARankIsNone)
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(empty);
  filter->UpdatePiece(1, 2, 0);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(messages.errors, "");
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(QuadRemeshFailure, BadPropertiesAreRefused)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::gridPlane(4, 4));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, -1);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  filter->SetTargetTypeToEdgeLength();
  filter->SetEdgeLength(-1);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  filter->SetEdgeLength(1);
  filter->SetFeatureAngle(500);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

TEST(QuadRemeshFailure, RefusesTooManyQuads)
{
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetMaximumNumberOfQuads(100);
  run(filter, test::toPolyData(test::torus(40, 20)), 2000);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::TooLarge);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(QuadRemesh, AnAnisotropyLimitIsToldOrRefused)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(40, 20));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 300);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("AnisotropyLimit"), nullptr);
  filter->SetAnisotropyLimit(1.05);
  run(filter, input, 300);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  for (vtkPolyData* data : { filter->GetOutput(), filter->GetMappedSurface() })
  {
    ASSERT_NE(data->GetFieldData()->GetArray("BeyondAnisotropyLimit"), nullptr);
    EXPECT_EQ(data->GetFieldData()->GetArray("AnisotropyLimit")->GetTuple1(0), 1.05);
    const double beyond = data->GetFieldData()->GetArray("BeyondAnisotropyLimit")->GetTuple1(0);
    EXPECT_GT(beyond, 0);
    EXPECT_LT(beyond, 1);
  }
  EXPECT_NE(std::string(filter->GetNoticesText()).find("anisotropy limit"), std::string::npos);
  filter->SetAnisotropyLimit(0.5);
  run(filter, input, 300);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(filter->GetOutcomeText()).find("anisotropy"), std::string::npos);

  vtkNew<vtkDecimationHierarchy> hierarchy;
  hierarchy->SetInputData(input);
  vtkNew<vtkIntegerGridMap> map;
  const test::Messages others(map);
  map->SetInputConnection(hierarchy->GetOutputPort(0));
  map->SetAnisotropyLimit(2);
  map->Update();
  ASSERT_EQ(map->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << map->GetOutcomeText();
  EXPECT_NE(map->GetOutput()->GetFieldData()->GetArray("BeyondAnisotropyLimit"), nullptr);
  map->SetMethodToQuadCover();
  map->Update();
  EXPECT_EQ(map->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

TEST(QuadRemesh, CoarsestIntegersMakeAFewQuads)
{
  const vtkSmartPointer<vtkPolyData> input =
    test::toPolyData(test::voxelSurface({ 3, 2, 1 }, 4, [](int, int, int) { return true; }));
  vtkNew<vtkQuadRemesh> filter;
  run(filter, input, 300);
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 200);
  filter->SetIntegersToCoarsest();
  run(filter, input, 300);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 6);
  filter->SetIntegersToKeepSizes();
  run(filter, input, 300);
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 200);

  vtkNew<vtkDecimationHierarchy> hierarchy;
  hierarchy->SetInputData(input);
  vtkNew<vtkIntegerGridMap> map;
  map->SetInputConnection(hierarchy->GetOutputPort(0));
  map->SetIntegersToCoarsest();
  map->Update();
  ASSERT_EQ(map->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << map->GetOutcomeText();
  double area = 0;
  vtkDataArray* determinants = map->GetOutput()->GetCellData()->GetArray("Determinant");
  for (vtkIdType i = 0; i < determinants->GetNumberOfTuples(); ++i)
  {
    area += determinants->GetTuple1(i) / 2;
  }
  EXPECT_NEAR(area, 6, 1e-6);
}

TEST(QuadRemeshFailure, AConnectionJoinsTwoPoints)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(40, 20));
  vtkNew<vtkIntArray> connections;
  connections->SetName("ConnectId");
  connections->SetNumberOfTuples(input->GetNumberOfPoints());
  connections->Fill(0);
  for (const vtkIdType point : { 3, 70, 200 })
  {
    connections->SetValue(point, 7);
  }
  input->GetPointData()->AddArray(connections);
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 200);
  EXPECT_NE(filter->GetOutcome(), vtkQuadRemesh::Succeeded);
  EXPECT_NE(
    std::string(filter->GetOutcomeText()).find("7 of ConnectId stands at 3"), std::string::npos)
    << filter->GetOutcomeText();
}

/// Asks to stop at the first progress event; the next update must run again, not serve the empty output.
TEST(QuadRemeshFailure, AbortLeavesTheFilterOutOfDate)
{
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1); });
  const unsigned long id = filter->AddObserver(vtkCommand::ProgressEvent, stop);
  run(filter, test::toPolyData(test::torus(40, 20)), 200);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Aborted);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  EXPECT_EQ(messages.errors.find("In vtkQuad"), std::string::npos);
  filter->RemoveObserver(id);
  filter->SetAbortExecute(0);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0);
}

/// The points of quads, for a comparison.
std::vector<double> coordinatesOf(vtkPolyData* quads)
{
  std::vector<double> points;
  for (vtkIdType p = 0; p < quads->GetNumberOfPoints(); ++p)
  {
    points.insert(points.end(), quads->GetPoint(p), quads->GetPoint(p) + 3);
  }
  return points;
}

TEST(QuadRemeshFailure, AStopKeepsTheQuadsSoFar)
{
  const vtkSmartPointer<vtkPolyData> input = test::sphereWithoutRoomData();
  vtkNew<vtkQuadRemesh> fresh;
  run(fresh, input, 100);
  ASSERT_EQ(fresh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << fresh->GetOutcomeText();
  EXPECT_FALSE(fresh->GetIsSoFar());
  for (const bool keepsLevels : { true, false })
  {
    vtkNew<vtkQuadRemesh> filter;
    filter->SetKeepLevels(keepsLevels);
    const test::Messages messages(filter);
    {
      const test::StopAt stop(filter, "Attempt 2 of at most ");
      run(filter, input, 100);
    }
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Aborted);
    EXPECT_TRUE(filter->GetIsSoFar());
    EXPECT_NE(std::string(filter->GetOutcomeText()).find("best quads so far"), std::string::npos);
    EXPECT_NE(std::string(filter->GetNoticesText()).find("stopped on request (Attempt 2"),
      std::string::npos);
    EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 70);
    EXPECT_GT(filter->GetMappedSurface()->GetNumberOfCells(), 0);
    EXPECT_NE(filter->GetOutput()->GetFieldData()->GetAbstractArray("Stopped"), nullptr);
    EXPECT_EQ(messages.errors.find("In vtkQuad"), std::string::npos);
    // The next update is not served with them.
    filter->SetAbortExecute(0);
    filter->Update();
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    EXPECT_FALSE(filter->GetIsSoFar());
    EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetAbstractArray("Stopped"), nullptr);
    EXPECT_EQ(coordinatesOf(filter->GetOutput()), coordinatesOf(fresh->GetOutput()));
  }
}

/// What a filter's outputs hold, for a comparison.
std::vector<vtkIdType> sizesOf(vtkQuadRemesh* filter)
{
  std::vector<vtkIdType> sizes;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    auto* data = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
    if (!data)
    {
      auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(port));
      sizes.insert(sizes.end(), { table->GetNumberOfRows(), table->GetNumberOfColumns() });
      continue;
    }
    sizes.insert(sizes.end(),
      { data->GetNumberOfPoints(), data->GetNumberOfCells(),
        vtkIdType{ data->GetPointData()->GetNumberOfArrays() },
        vtkIdType{ data->GetFieldData()->GetNumberOfArrays() } });
  }
  return sizes;
}

std::vector<double> coordinates(vtkPolyData* data)
{
  std::vector<double> result;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    result.insert(result.end(), data->GetPoint(i), data->GetPoint(i) + 3);
  }
  return result;
}

void guideSome(vtkPolyData* data, double x, double y)
{
  vtkNew<vtkDoubleArray> directions;
  directions->SetName("GuidingDirection");
  directions->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    const bool guided = i < data->GetNumberOfCells() / 30;
    directions->InsertNextTuple3(guided ? x : 0, guided ? y : 0, 0);
  }
  data->GetCellData()->AddArray(directions);
}

TEST(QuadRemesh, AChangeBeginsAtItsStageWithTheSameQuads)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  EXPECT_TRUE(filter->GetKeepLevels());
  EXPECT_FALSE(filter->GetWarmStart());
  run(filter, input, 400);
  EXPECT_STREQ(filter->GetReusedStagesText(), "");
  EXPECT_GT(filter->GetRememberedMegabytes(), 0.1);
  const auto expectAsNew = [&](const char* reused)
  {
    vtkNew<vtkQuadRemesh> other;
    other->KeepLevelsOff();
    run(other, input, filter->GetNumberOfQuads());
    EXPECT_EQ(other->GetRememberedMegabytes(), 0);
    EXPECT_EQ(coordinates(filter->GetOutput()), coordinates(other->GetOutput()));
    EXPECT_EQ(coordinates(filter->GetMappedSurface()), coordinates(other->GetMappedSurface()));
    EXPECT_STREQ(filter->GetReusedStagesText(), reused);
  };
  guideSome(input, 1, 0);
  run(filter, input, 400);
  expectAsNew("repair\norder\nconnectivity\nrefine\nhandles\nphase1\nphase2");
  EXPECT_EQ(
    filter->GetOutput()->GetFieldData()->GetAbstractArray("ReusedStages")->GetNumberOfTuples(), 7);
  run(filter, input, 500);
  expectAsNew("repair\norder\nconnectivity");
  // A copy with other arrays and times has the same content.
  const vtkSmartPointer<vtkPolyData> copy = vtkSmartPointer<vtkPolyData>::New();
  copy->DeepCopy(input);
  run(filter, copy, 500);
  expectAsNew("repair\norder\nconnectivity\nrefine\nhandles\nphase1\nphase2\nfield\nseamless\nquant"
              "ize\nembed\nreplay\n"
              "certify\nextract");
  filter->WarmStartOn();
  copy->Modified();
  run(filter, copy, 500);
  EXPECT_NE(std::string(filter->GetReusedStagesText()).find("seamless"), std::string::npos)
    << filter->GetReusedStagesText() << filter->GetNoticesText() << filter->GetOutcomeText();
  expectValid(filter, 0, true);
  filter->KeepLevelsOff();
  EXPECT_EQ(filter->GetRememberedMegabytes(), 0);
}

TEST(QuadRemesh, GoingBackAndOtherLimitsAreALookUp)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, input, 400);
  const std::vector<double> first = coordinates(filter->GetOutput());
  const std::string notices = filter->GetNoticesText();
  run(filter, input, 500);
  EXPECT_STRNE(filter->GetReusedStagesText(), "all");
  const std::vector<double> second = coordinates(filter->GetOutput());
  EXPECT_NE(first, second);
  const auto expectAll = [&](const std::vector<double>& points)
  {
    EXPECT_STREQ(filter->GetReusedStagesText(), "all");
    EXPECT_EQ(coordinates(filter->GetOutput()), points);
    EXPECT_EQ(filter->GetActualQuads(), filter->GetOutput()->GetNumberOfCells());
    expectValid(filter, 0, true);
  };
  run(filter, input, 400);
  expectAll(first);
  EXPECT_EQ(filter->GetNoticesText(), notices);
  run(filter, input, 500);
  expectAll(second);
  filter->SetNumberOfThreads(1);
  filter->SetTimeLimit(100);
  filter->SetMemoryLimit(1000);
  filter->SetMaximumNumberOfQuads(5000);
  filter->Update();
  expectAll(second);
  // A limit that the result does not keep to is an error as ever.
  filter->SetMaximumNumberOfQuads(100);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::TooLarge);
  filter->SetMaximumNumberOfQuads(5000);
  filter->SetSmoothingSteps(0);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_STRNE(filter->GetReusedStagesText(), "all");
  filter->KeepLevelsOff();
  filter->SetSmoothingSteps(5);
  filter->Update();
  EXPECT_STREQ(filter->GetReusedStagesText(), "");
}

TEST(QuadRemesh, OtherQuadsOfTheSameMapLeaveTheMappedSurfaceAsItIs)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(input);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(400);
  filter->Update();
  const auto mapOf = [&] { return filter->GetMappedSurface()->GetCellData()->GetArray("IGM"); };
  const vtkSmartPointer<vtkDataArray> first = mapOf();
  ASSERT_TRUE(first);
  filter->SetSmoothingSteps(1);
  filter->Update();
  EXPECT_EQ(mapOf(), first);
  // Another map, and the same one with an array of the input more, are written anew.
  const auto mark = vtkSmartPointer<vtkIntArray>::New();
  mark->SetName("Mark");
  mark->SetNumberOfValues(input->GetNumberOfPoints());
  mark->FillValue(7);
  input->GetPointData()->AddArray(mark);
  input->Modified();
  filter->SetSmoothingSteps(2);
  filter->Update();
  EXPECT_TRUE(filter->GetMappedSurface()->GetPointData()->HasArray("Mark"));
  filter->SetNumberOfQuads(600);
  filter->Update();
  EXPECT_NE(mapOf(), first);
  EXPECT_GT(filter->GetMappedSurface()->GetFieldData()->GetArray("Charts")->GetTuple1(0), 0);
}

// A constraint that an undo has made anew is another object with the same contents.
TEST(QuadRemesh, ConstraintsOfTheSameContentsAreTheSame)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  const auto valenceAt = [](double x, int valence)
  {
    const auto points = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> places;
    places->InsertNextPoint(x, 0, 0);
    vtkNew<vtkIntArray> valences;
    valences->SetName("TargetValence");
    valences->InsertNextValue(valence);
    points->SetPoints(places);
    points->GetPointData()->AddArray(valences);
    return points;
  };
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(input);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(400);
  const auto run = [&](double x, int valence)
  {
    filter->SetValencePointsData(valenceAt(x, valence));
    filter->Update();
    return std::string(filter->GetReusedStagesText());
  };
  EXPECT_NE(run(3, 3), "all");
  const std::vector<double> first = coordinates(filter->GetOutput());
  EXPECT_EQ(run(3, 3), "all");
  EXPECT_NE(run(3, 5), "all");
  EXPECT_NE(run(2.9, 5), "all");
  EXPECT_EQ(run(3, 3), "all"); // of those before
  EXPECT_EQ(coordinates(filter->GetOutput()), first);
}

TEST(QuadRemesh, NothingNewReturnsTheResultBefore)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  vtkNew<vtkTrivialProducer> upstream;
  upstream->SetOutput(input);
  filter->SetInputConnection(upstream->GetOutputPort());
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(400);
  filter->Update();
  const std::vector<double> before = coordinates(filter->GetOutput());
  const std::string certificate = filter->GetCertificateText();
  // Another object with the same arrays, as a filter upstream makes that passes its input on.
  const auto runAgain = [&]
  {
    const auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->ShallowCopy(input);
    upstream->SetOutput(copy);
    filter->Update();
  };
  runAgain();
  EXPECT_STREQ(filter->GetReusedStagesText(), "all");
  EXPECT_EQ(coordinates(filter->GetOutput()), before);
  EXPECT_EQ(filter->GetCertificateText(), certificate);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(filter->GetActualQuads(), filter->GetOutput()->GetNumberOfCells());
  EXPECT_GT(filter->GetMappedSurface()->GetNumberOfCells(), 0);
  // Any array counts, as all are carried over; so does what was changed in place, and a property.
  vtkNew<vtkDoubleArray> numbers;
  numbers->SetName("Numbers");
  numbers->SetNumberOfTuples(input->GetNumberOfPoints());
  numbers->FillValue(1);
  input->GetPointData()->AddArray(numbers);
  runAgain();
  EXPECT_STRNE(filter->GetReusedStagesText(), "all");
  EXPECT_TRUE(filter->GetOutput()->GetPointData()->HasArray("Numbers"));
  numbers->FillValue(2);
  numbers->Modified();
  runAgain();
  EXPECT_STRNE(filter->GetReusedStagesText(), "all");
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("Numbers")->GetTuple1(0), 2);
  input->GetPoints()->SetPoint(0, 1.5, 0, 0.01);
  input->GetPoints()->Modified();
  runAgain();
  EXPECT_STREQ(filter->GetReusedStagesText(), "");
  filter->ComputeMappedSurfaceOff();
  runAgain();
  EXPECT_STRNE(filter->GetReusedStagesText(), "all");
  // A failure is tried again, and forgets what was before.
  filter->SetNumberOfQuads(-1);
  runAgain();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  runAgain();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

TEST(QuadRemeshFailure, PreviousResultIsKept)
{
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  run(filter, test::toPolyData(test::torus(40, 20)), 200);
  const std::vector<vtkIdType> before = sizesOf(filter);
  ASSERT_GT(before[1], 0);
  double corner[3];
  filter->GetOutput()->GetPoint(0, corner);

  // A stop on request, in the middle.
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback(
    [](vtkObject* caller, unsigned long, void*, void*)
    {
      auto* algorithm = vtkAlgorithm::SafeDownCast(caller);
      algorithm->SetAbortExecute(algorithm->GetProgress() > 0.3);
    });
  const unsigned long id = filter->AddObserver(vtkCommand::ProgressEvent, stop);
  filter->SetNumberOfQuads(400);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Aborted);
  EXPECT_NE(std::string(filter->GetOutcomeText()).find("previous result"), std::string::npos);
  EXPECT_EQ(sizesOf(filter), before);
  filter->RemoveObserver(id);
  filter->SetAbortExecute(0);

  // An error.
  filter->SetNumberOfQuads(-1);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_EQ(sizesOf(filter), before);
  double kept[3];
  filter->GetOutput()->GetPoint(0, kept);
  EXPECT_TRUE(std::equal(corner, corner + 3, kept));

  // And the next success replaces it.
  filter->SetNumberOfQuads(800);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 2 * before[1]);
}

TEST(QuadRemeshFailure, TimeLimitIsAnError)
{
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetTimeLimit(1e-9);
  run(filter, test::toPolyData(test::torus(40, 20)), 200);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::TimedOut);
  EXPECT_NE(messages.errors.find("time limit"), std::string::npos);
}

} // namespace
} // namespace quadrille
