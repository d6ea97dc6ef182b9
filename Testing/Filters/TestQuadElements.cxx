// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestSurfaces.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkQuadElements.h>
#include <vtkQuadRemesh.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

constexpr double kHeight = 2;

/// An open cylinder with the point arrays Z and the cell array Fibre, which runs round it.
vtkSmartPointer<vtkPolyData> cylinder()
{
  const Mesh mesh = test::openCylinder(96, 32, 1, kHeight);
  auto data = test::toPolyData(mesh);
  vtkNew<vtkDoubleArray> z;
  z->SetName("Z");
  for (const Vector3& p : mesh.position)
  {
    z->InsertNextValue(p.z());
  }
  data->GetPointData()->AddArray(z);
  vtkNew<vtkDoubleArray> fibre;
  fibre->SetName("Fibre");
  fibre->SetNumberOfComponents(3);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 p = mesh.position[mesh.origin[3 * f]];
    fibre->InsertNextTuple3(-5 * p.y(), 5 * p.x(), 0);
  }
  data->GetCellData()->AddArray(fibre);
  return data;
}

struct RemeshedCylinder
{
  vtkSmartPointer<vtkPolyData> surface = cylinder();
  vtkNew<vtkQuadRemesh> remesh;

  RemeshedCylinder()
  {
    remesh->SetInputData(surface);
    remesh->SetTargetTypeToNumberOfQuads();
    remesh->SetNumberOfQuads(200);
    remesh->Update();
    EXPECT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << remesh->GetOutcomeText();
  }
};

/// Quads that share no points.
vtkSmartPointer<vtkPolyData> looseQuads(const std::vector<std::array<Vector3, 4>>& quads)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const std::array<Vector3, 4>& quad : quads)
  {
    cells->InsertNextCell(4);
    for (const Vector3& p : quad)
    {
      cells->InsertCellPoint(points->InsertNextPoint(p.data()));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

const std::array<Vector3, 4> kSquare{ Vector3{ 0, 0, 0 }, Vector3{ 1, 0, 0 }, Vector3{ 1, 1, 0 },
  Vector3{ 0, 1, 0 } };
/// Normals at corners 0 and 2 differ by an angle with the cosine 0.8.
const std::array<Vector3, 4> kWarped{ Vector3{ 0, 0, 0 }, Vector3{ 1, 0, 0 }, Vector3{ 1, 1, 0.5 },
  Vector3{ 0, 1, 0 } };
const std::array<Vector3, 4> kTrapezoid{ Vector3{ 0, 0, 0 }, Vector3{ 4, 0, 0 }, Vector3{ 3, 2, 0 },
  Vector3{ 1, 2, 0 } };
const std::array<Vector3, 4> kParallelogram{ Vector3{ 0, 0, 0 }, Vector3{ 2, 0, 0 },
  Vector3{ 3, 1, 0 }, Vector3{ 1, 1, 0 } };

vtkDataArray* cellArray(vtkQuadElements* filter, const char* name)
{
  vtkDataArray* array = filter->GetElements()->GetCellData()->GetArray(name);
  EXPECT_TRUE(array) << name;
  return array;
}

double fieldOf(vtkQuadElements* filter, const char* name)
{
  vtkDataArray* array = filter->GetElements()->GetFieldData()->GetArray(name);
  return array ? array->GetTuple1(0) : std::nan("");
}

/// SourcePointIds and SourceBarycentric give the place of each point on the surface.
double farthestFromSource(vtkUnstructuredGrid* grid, vtkPolyData* surface)
{
  vtkDataArray* ids = grid->GetPointData()->GetArray("SourcePointIds");
  vtkDataArray* weights = grid->GetPointData()->GetArray("SourceBarycentric");
  double farthest = 0;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
    {
      sum += weights->GetComponent(i, k) *
        Vector3(surface->GetPoint(static_cast<vtkIdType>(ids->GetComponent(i, k))));
    }
    farthest = std::max(farthest, (sum - Vector3(grid->GetPoint(i))).norm());
  }
  return farthest;
}

TEST(QuadElements, OfFirstOrderAreTheQuads)
{
  RemeshedCylinder c;
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(c.remesh->GetOutput());
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkUnstructuredGrid* grid = filter->GetElements();
  vtkPolyData* quads = c.remesh->GetOutput();
  ASSERT_EQ(grid->GetNumberOfCells(), quads->GetNumberOfPolys());
  EXPECT_EQ(grid->GetCellType(0), VTK_QUAD);
  EXPECT_EQ(grid->GetPoints()->GetData(), quads->GetPoints()->GetData());
  for (const char* name : { "Fibre", "FeatureEdges", "LayoutPatch", "SourceCellId" })
  {
    EXPECT_EQ(grid->GetCellData()->GetArray(name), quads->GetCellData()->GetArray(name)) << name;
  }
  EXPECT_EQ(filter->GetHistograms()->GetNumberOfColumns(), 0);
  EXPECT_EQ(filter->GetWorstElements()->GetNumberOfPoints(), 0);
}

/// The input and the mapped surface, which has other triangles, ids and doubled points, are the same surface.
TEST(QuadElements, OfSecondOrderHaveNodesOnTheSurface)
{
  RemeshedCylinder c;
  c.remesh->GetMappedSurface();
  for (const bool isMapped : { false, true })
  {
    for (const int count : { 8, 9 })
    {
      vtkNew<vtkQuadElements> filter;
      filter->SetInputConnection(c.remesh->GetOutputPort());
      isMapped ? filter->SetSurfaceConnection(c.remesh->GetOutputPort(1))
               : filter->SetSurfaceData(c.surface);
      filter->SetOrderToSecond();
      filter->SetNodesPerElement(count);
      filter->Update();
      ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
      vtkUnstructuredGrid* grid = filter->GetElements();
      EXPECT_EQ(grid->GetCellType(0), count == 8 ? VTK_QUADRATIC_QUAD : VTK_BIQUADRATIC_QUAD);
      const vtkIdType quads = grid->GetNumberOfCells();
      const vtkIdType corners = c.remesh->GetOutput()->GetNumberOfPoints();
      // chi 0: as many edges as points and quads; and a centre each.
      EXPECT_EQ(grid->GetNumberOfPoints(), 2 * corners + quads + (count == 9 ? quads : 0));
      EXPECT_LT(farthestFromSource(grid, c.surface), 1e-14);
      EXPECT_EQ(fieldOf(filter, "NodesMovedAlong"), 0);
      EXPECT_EQ(fieldOf(filter, "NodesMovedOff"), 0);
      EXPECT_EQ(fieldOf(filter, "EdgesWithoutCurve"), 0);
      vtkDataArray* z = grid->GetPointData()->GetArray("Z");
      vtkDataArray* onBoundary = grid->GetPointData()->GetArray("OnBoundary");
      ASSERT_TRUE(z && onBoundary);
      const double facets = std::cos(test::kPi / 96); // least radius of the surface
      for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
      {
        const Vector3 p(grid->GetPoint(i));
        EXPECT_NEAR(z->GetTuple1(i), p.z(), 1e-12); // a linear function stays what it is
        EXPECT_GE(p.head<2>().norm(), facets - 1e-12);
        const bool isEnd = p.z() < 1e-12 || p.z() > kHeight - 1e-12;
        EXPECT_EQ(onBoundary->GetTuple1(i), isEnd ? 1 : 0);
      }
    }
  }
}

TEST(QuadElements, AskForTheSurface)
{
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(looseQuads({ kSquare }));
  filter->SetOrderToSecond();
  const test::Messages messages(filter);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(filter->GetOutcomeText()).find("surface"), std::string::npos);
}

/// By hand: the trapezoid's sides are 4, sqrt 5, 2, sqrt 5, its area 6, its angles atan 2 and 180 degrees less that.
TEST(QuadElements, MeasuresAreThoseOfVerdict)
{
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(looseQuads({ kSquare, kWarped, kTrapezoid, kParallelogram }));
  filter->QualityOn();
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const auto value = [&](const char* name, vtkIdType i)
  { return cellArray(filter, name)->GetTuple1(i); };
  for (const char* name : { "ScaledJacobian", "AspectRatio", "Warpage", "EdgeRatio" })
  {
    EXPECT_NEAR(value(name, 0), 1, 1e-12) << name;
  }
  EXPECT_NEAR(value("Skew", 0), 0, 1e-12);
  EXPECT_NEAR(value("Taper", 0), 0, 1e-12);
  EXPECT_NEAR(value("MinimumAngle", 0), 90, 1e-9);
  EXPECT_NEAR(value("MaximumAngle", 0), 90, 1e-9);
  EXPECT_NEAR(value("Warpage", 1), 0.8 * 0.8 * 0.8, 1e-12);
  const double angle = std::atan(2.0) * 180 / test::kPi;
  EXPECT_NEAR(value("ScaledJacobian", 2), 2 / std::sqrt(5.0), 1e-12); // the sine of the angle
  EXPECT_NEAR(value("AspectRatio", 2), 4 * (6 + 2 * std::sqrt(5.0)) / (4 * 6), 1e-12);
  EXPECT_NEAR(value("EdgeRatio", 2), 2, 1e-12);
  EXPECT_NEAR(value("MinimumAngle", 2), angle, 1e-9);
  EXPECT_NEAR(value("MaximumAngle", 2), 180 - angle, 1e-9);
  EXPECT_NEAR(value("Skew", 2), 0, 1e-12); // the middle lines are perpendicular
  // (p0 - p1 + p2 - p3) over the shorter of the two principal axes: 2 over 4.
  EXPECT_NEAR(value("Taper", 2), 0.5, 1e-12);
  EXPECT_NEAR(value("Skew", 3), std::sqrt(0.5), 1e-12); // cosine of 45 degrees

  vtkTable* histograms = filter->GetHistograms();
  ASSERT_EQ(histograms->GetNumberOfColumns(), 3 * 8);
  for (vtkIdType column = 2; column < histograms->GetNumberOfColumns(); column += 3)
  {
    double sum = 0;
    for (vtkIdType row = 0; row < histograms->GetNumberOfRows(); ++row)
    {
      sum += histograms->GetValue(row, column).ToDouble();
    }
    EXPECT_EQ(sum, 4) << histograms->GetColumnName(column);
  }
  vtkPolyData* worst = filter->GetWorstElements();
  ASSERT_EQ(worst->GetNumberOfPoints(), 4);
  EXPECT_EQ(worst->GetPointData()->GetArray("ElementId")->GetTuple1(0), 3); // sine of 45 degrees
  EXPECT_EQ(Vector3(worst->GetPoint(0)), Vector3(1.5, 0.5, 0));
}

TEST(QuadElements, CountsElementsThatFailARequirement)
{
  auto quads = looseQuads({ kSquare, kTrapezoid, kParallelogram, kSquare });
  quads->GetPoints()->SetPoint(12, std::nan(""), 0, 0); // keeps no limit
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(quads);
  filter->AddRequirement("scaled-jacobian > 0.8");
  filter->AddRequirement("EdgeRatio<=2");
  filter->AddRequirement("maximum-angle<180");
  const test::Messages messages(filter);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_EQ(filter->GetNumberOfFailedElements(), 2); // parallelogram, and the one without a place
  vtkDataArray* failed = filter->GetElements()->GetFieldData()->GetArray("FailedElements");
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->GetTuple1(0), 2);
  EXPECT_FALSE(filter->GetElements()->GetCellData()->GetArray("ScaledJacobian")); // not asked for
  EXPECT_EQ(filter->GetWorstElements()->GetPointData()->GetArray("ElementId")->GetTuple1(1), 2);
  EXPECT_NE(std::string(filter->GetNoticesText()).find("2 of 4 elements fail"), std::string::npos)
    << filter->GetNoticesText();
}

TEST(QuadElements, RefuseWhatIsNoRequirement)
{
  for (const char* text : { "jacobian>0.2", "scaled-jacobian", "scaled-jacobian>", ">1", "skew<a",
         "skew<1e999", "skew<nan", "skew<>1", "skew==1" })
  {
    EXPECT_NE(vtkQuadElements::GetRequirementError(text), "") << text;
    vtkNew<vtkQuadElements> filter;
    filter->SetInputData(looseQuads({ kSquare }));
    filter->AddRequirement(text);
    const test::Messages messages(filter);
    filter->Update();
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput) << text;
  }
  EXPECT_EQ(vtkQuadElements::GetRequirementError("skew<=1e-1"), "");
}

/// Thickness x on a trapezoid: its mean is the x of the centroid; shifted and stretched, as it is 2 by symmetry here.
TEST(QuadElements, TakeTheThicknessByArea)
{
  auto quads = looseQuads({ kTrapezoid, kSquare });
  vtkNew<vtkDoubleArray> x;
  x->SetName("T");
  for (vtkIdType i = 0; i < 8; ++i)
  {
    x->InsertNextValue(quads->GetPoint(i)[1] + (i < 4 ? 1 : -1));
  }
  quads->GetPointData()->AddArray(x);
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(quads);
  filter->SetThicknessArrayName("T");
  const test::Messages messages(filter);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  // Sides 4 and 2 at the distance 2: the centroid lies at 2 / 3 (4 + 2 * 2) / (4 + 2).
  EXPECT_NEAR(cellArray(filter, "Thickness")->GetTuple1(0), 1 + 8.0 / 9, 1e-12);
  EXPECT_NEAR(cellArray(filter, "Thickness")->GetTuple1(1), -0.5, 1e-12);
  EXPECT_NE(
    std::string(filter->GetNoticesText()).find("1 element is not positive"), std::string::npos)
    << filter->GetNoticesText();
}

TEST(QuadElements, TurnDirectionsIntoTheElements)
{
  RemeshedCylinder c;
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(c.remesh->GetOutput());
  filter->SetAxisArrayName("Fibre");
  filter->AddVectorArrayName("Fibre");
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkDataArray* axis = cellArray(filter, "ElementAxis");
  vtkDataArray* local = cellArray(filter, "FibreInElement");
  vtkDataArray* fibre = cellArray(filter, "Fibre");
  vtkUnstructuredGrid* grid = filter->GetElements();
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
  {
    const Vector3 a(axis->GetTuple3(i)), f(fibre->GetTuple3(i)), l(local->GetTuple3(i));
    vtkNew<vtkIdList> ids;
    grid->GetCellPoints(i, ids);
    const auto point = [&](vtkIdType k) { return Vector3(grid->GetPoint(ids->GetId(k))); };
    const Vector3 normal = (point(2) - point(0)).cross(point(3) - point(1)).normalized();
    EXPECT_NEAR(a.norm(), 1, 1e-12);
    EXPECT_NEAR(a.dot(normal), 0, 1e-12);
    EXPECT_NEAR(l.norm(), f.norm(), 1e-12 * f.norm()); // a rotation
    EXPECT_NEAR(l.y(), 0, 1e-12 * f.norm());           // the axis is its own direction
    EXPECT_NEAR(l.z(), f.dot(normal), 1e-12 * f.norm());
    EXPECT_GT(l.x(), 0);
  }
}

TEST(QuadElements, TellWhereThereIsNoDirection)
{
  auto quads = looseQuads({ kSquare, kTrapezoid, kParallelogram });
  vtkNew<vtkDoubleArray> fibre;
  fibre->SetName("Fibre");
  fibre->SetNumberOfComponents(3);
  fibre->InsertNextTuple3(0, 2, 7);
  fibre->InsertNextTuple3(0, 0, 0);
  fibre->InsertNextTuple3(0, 0, 3);
  quads->GetCellData()->AddArray(fibre);
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(quads);
  filter->SetAxisArrayName("Fibre");
  const test::Messages messages(filter);
  for (const int fallback : { vtkQuadElements::AXIS_REQUIRED, vtkQuadElements::AXIS_Z })
  {
    filter->SetAxisFallback(fallback);
    filter->Update();
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
    const std::string text = filter->GetOutcomeText();
    EXPECT_NE(text.find("2 elements, the first is element 1 at"), std::string::npos) << text;
  }
  for (const int fallback : { vtkQuadElements::AXIS_Y, vtkQuadElements::AXIS_OF_ELEMENT })
  {
    filter->SetAxisFallback(fallback);
    filter->Update();
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    vtkDataArray* axis = cellArray(filter, "ElementAxis");
    EXPECT_EQ(Vector3(axis->GetTuple3(0)), Vector3(0, 1, 0));
    const Vector3 expected =
      fallback == vtkQuadElements::AXIS_Y ? Vector3(0, 1, 0) : Vector3(1, 0, 0);
    EXPECT_LT((Vector3(axis->GetTuple3(1)) - expected).norm(), 1e-12);
    EXPECT_LT((Vector3(axis->GetTuple3(2)) - expected).norm(), 1e-12);
    EXPECT_EQ(fieldOf(filter, "ElementsWithoutDirection"), 2);
    EXPECT_NE(std::string(filter->GetNoticesText()).find("2 elements"), std::string::npos);
  }
}

TEST(QuadElements, RefuseArraysThatDoNotFit)
{
  auto quads = looseQuads({ kSquare });
  vtkNew<vtkDoubleArray> one;
  one->SetName("One");
  one->InsertNextValue(1);
  quads->GetCellData()->AddArray(one);
  const auto fails = [&](const std::function<void(vtkQuadElements*)>& set)
  {
    vtkNew<vtkQuadElements> filter;
    filter->SetInputData(quads);
    set(filter);
    const test::Messages messages(filter);
    filter->Update();
    return filter->GetOutcome() == vtkQuadrilleAlgorithm::BadInput;
  };
  EXPECT_TRUE(fails([](vtkQuadElements* f) { f->SetThicknessArrayName("None"); }));
  EXPECT_TRUE(fails([](vtkQuadElements* f) { f->SetAxisArrayName("One"); }));
  EXPECT_TRUE(fails([](vtkQuadElements* f) { f->AddVectorArrayName("One"); }));
}

TEST(QuadElements, TakeComposites)
{
  RemeshedCylinder c;
  vtkNew<vtkMultiBlockDataSet> quads, surfaces;
  for (unsigned i = 0; i < 2; ++i)
  {
    quads->SetBlock(i, c.remesh->GetOutput());
    surfaces->SetBlock(i, c.surface);
  }
  vtkNew<vtkQuadElements> filter;
  filter->SetInputData(quads);
  filter->SetSurfaceData(surfaces);
  filter->SetOrderToSecond();
  filter->QualityOn();
  filter->AddRequirement("scaled-jacobian>2"); // none can
  const test::Messages messages(filter);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  auto* result = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(result);
  vtkIdType count = 0;
  for (unsigned i = 0; i < 2; ++i)
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(result->GetBlock(i));
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->GetCellType(0), VTK_QUADRATIC_QUAD);
    count += grid->GetNumberOfCells();
  }
  EXPECT_EQ(filter->GetNumberOfFailedElements(), count);
}

} // namespace
} // namespace quadrille
