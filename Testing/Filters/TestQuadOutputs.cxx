// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What comes out of the two filters that make quads: carried arrays, places on the input, patches, layout.
#include "PlyFile.h"
#include "TestSurfaces.h"

#include "Convert/Quads.h"
#include "Features/Features.h"
#include "Prepare/Prepare.h"
#include "Quads/QuadLayout.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkQuadExtraction.h>
#include <vtkQuadRemesh.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace quadrille
{
namespace
{

constexpr double kFeatureAngle = 40 * test::kPi / 180; // the filters' default

// ------------------------------------------------------------------ surfaces

/// Four corners a cell, not in a plane.
vtkSmartPointer<vtkPolyData> quadrilaterals()
{
  const Mesh mesh = test::torus(30, 16);
  vtkSmartPointer<vtkPolyData> data = test::toPolyData(mesh);
  vtkNew<vtkCellArray> polys;
  for (Index f = 0; f < mesh.faceCount(); f += 2)
  {
    polys->InsertNextCell(
      { static_cast<vtkIdType>(mesh.origin[3 * f]), static_cast<vtkIdType>(mesh.origin[3 * f + 1]),
        static_cast<vtkIdType>(mesh.origin[3 * f + 2]),
        static_cast<vtkIdType>(mesh.origin[3 * f + 5]) });
  }
  data->SetPolys(polys);
  return data;
}

/// Every triangle has its own points; some are there twice, some turned round, one has no area.
vtkSmartPointer<vtkPolyData> soup()
{
  const Mesh mesh = test::squareTorus(6);
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polys;
  const auto add = [&](Index a, Index b, Index c)
  {
    std::array<vtkIdType, 3> ids{};
    for (int i = 0; i < 3; ++i)
    {
      ids[i] = points->InsertNextPoint(mesh.position[std::array<Index, 3>{ a, b, c }[i]].data());
    }
    polys->InsertNextCell(3, ids.data());
  };
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Index* c = mesh.origin.data() + 3 * f;
    f % 7 == 3 ? add(c[1], c[0], c[2]) : add(c[0], c[1], c[2]);
    if (f % 50 == 0)
    {
      add(c[0], c[1], c[2]);
    }
  }
  add(mesh.origin[0], mesh.origin[1], mesh.origin[0]);
  data->SetPoints(points);
  data->SetPolys(polys);
  return data;
}

/// Ids of the regions between sharp edges, one a triangle of a clean surface.
std::vector<int> regions(const SurfaceInput& input)
{
  PrepareOptions options;
  options.featureAngle = kFeatureAngle;
  const PreparedSurface surface = prepareSurface(input, options);
  const Mesh& mesh = surface.mesh;
  std::vector<int> region(mesh.faceCount(), -1);
  int next = 100; // no ids that could be found by counting
  for (Index first = 0; first < mesh.faceCount(); ++first)
  {
    if (region[first] >= 0)
    {
      continue;
    }
    std::vector<Index> stack{ first };
    region[first] = next++;
    while (!stack.empty())
    {
      const Index f = stack.back();
      stack.pop_back();
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = mesh.isConstrained(h) ? f : Mesh::face(mesh.twin[h]);
        if (region[g] < 0)
        {
          region[g] = region[f];
          stack.push_back(g);
        }
      }
    }
  }
  std::vector<int> ofPolygon(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    ofPolygon[surface.sourcePolygon[f]] = region[f];
  }
  return ofPolygon;
}

/// Of a file, with its patch ids or those of its regions, and its triangles in another order than repair has them; null
/// where there is no file.
vtkSmartPointer<vtkPolyData> model(const std::string& path)
{
  const std::optional<SurfaceInput> input = test::loadPly(path);
  if (!input)
  {
    return nullptr;
  }
  std::vector<int> patchOf(input->patchIds.begin(), input->patchIds.end());
  if (patchOf.empty())
  {
    patchOf = regions(*input);
  }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vector3& p : input->points)
  {
    points->InsertNextPoint(p.data());
  }
  vtkNew<vtkCellArray> polys;
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  for (std::size_t f = patchOf.size(); f-- > 0;)
  {
    const Index* corner = input->polygonPoints.data() + 3 * f;
    polys->InsertNextCell({ static_cast<vtkIdType>(corner[0]), static_cast<vtkIdType>(corner[1]),
      static_cast<vtkIdType>(corner[2]) });
    patches->InsertNextValue(patchOf[f]);
  }
  data->SetPoints(points);
  data->SetPolys(polys);
  data->GetCellData()->AddArray(patches);
  return data;
}

struct Surface
{
  std::string name;
  vtkSmartPointer<vtkPolyData> data;
  vtkIdType quads;
  bool clean = false; ///< triangles that repair leaves alone
};

std::vector<Surface> surfaces()
{
  std::vector<Surface> list{ { "large triangles", test::toPolyData(test::unitCube(1)), 600, true },
    { "quadrilaterals", quadrilaterals(), 500 }, { "soup", soup(), 800 },
    { "sphere", test::toPolyData(test::sphere(4)), 300, true },
    { "plate", test::toPolyData(test::plateWithHole(4)), 400, true },
    { "part", model(QUADRILLE_DATA "/part.ply"), 3000, true } };
#ifdef QUADRILLE_SHARED_DATA
  list.push_back({ "hull", model(QUADRILLE_SHARED_DATA "/cad/of_DTC_hull.ply"), 3000, true });
#endif
  list.erase(
    std::remove_if(list.begin(), list.end(), [](const Surface& s) { return !s.data; }), list.end());
  return list;
}

// ------------------------------------------------------------------ filters

/// The quads both ways: in one click, and from the mapped surface.
struct Both
{
  vtkNew<vtkQuadRemesh> remesh;
  vtkNew<vtkQuadExtraction> extraction;

  Both(vtkPolyData* input, vtkIdType quads, int cellDataFrom = vtkQuadRemesh::CELL_DATA_FROM_CENTRE,
    int smoothingSteps = 5)
  {
    remesh->SetInputData(input);
    remesh->SetTargetTypeToNumberOfQuads();
    remesh->SetNumberOfQuads(quads);
    remesh->SetCellDataFrom(cellDataFrom);
    extraction->SetInputConnection(remesh->GetOutputPort(1));
    extraction->SetCellDataFrom(cellDataFrom);
    remesh->SetSmoothingSteps(smoothingSteps);
    extraction->SetSmoothingSteps(smoothingSteps);
    extraction->Update();
    EXPECT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << remesh->GetOutcomeText();
    EXPECT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << extraction->GetOutcomeText();
  }

  struct Outputs
  {
    vtkPolyData* quads;
    vtkPolyData* lines;
    vtkPolyData* separatrices;
  };
  std::vector<Outputs> outputs()
  {
    return { { remesh->GetOutput(), remesh->GetLines(), remesh->GetSeparatrices() },
      { extraction->GetOutput(), extraction->GetLines(), extraction->GetSeparatrices() } };
  }
};

std::vector<vtkIdType> cornersOf(vtkPolyData* data, vtkIdType cell)
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  data->GetCellPoints(cell, count, ids);
  return { ids, ids + count };
}

using Edge = std::pair<vtkIdType, vtkIdType>;

/// The cells at each edge.
std::map<Edge, std::vector<vtkIdType>> cellsAtEdges(vtkPolyData* data)
{
  std::map<Edge, std::vector<vtkIdType>> cells;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    const std::vector<vtkIdType> ids = cornersOf(data, c);
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      cells[std::minmax(ids[i], ids[(i + 1) % ids.size()])].push_back(c);
    }
  }
  return cells;
}

// ------------------------------------------------------------------ linear fields

/// Component c of the test fields at p.
double linear(const double* p, int c)
{
  return (1 + c % 3) * p[0] - (1 + c % 2) * p[1] + (c % 5 - 2.5) * p[2] + c;
}

template <class Array>
void addLinear(vtkPolyData* data, const char* name, int components)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    std::vector<double> tuple;
    for (int c = 0; c < components; ++c)
    {
      tuple.push_back(linear(data->GetPoint(i), c));
    }
    array->InsertNextTuple(tuple.data());
  }
  data->GetPointData()->AddArray(array);
}

void expectLinear(vtkPolyData* data, const char* name, int components)
{
  vtkDataArray* array = data->GetPointData()->GetArray(name);
  ASSERT_TRUE(array && array->GetNumberOfComponents() == components) << name;
  for (int c = 0; c < components; ++c)
  {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double error = 0;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      const double wanted = linear(data->GetPoint(i), c);
      low = std::min(low, wanted);
      high = std::max(high, wanted);
      error = std::max(error, std::abs(array->GetComponent(i, c) - wanted));
    }
    EXPECT_LT(error, 1e-6 * (high - low)) << name << " " << c;
  }
}

void expectLinearFields(vtkPolyData* data)
{
  ASSERT_GT(data->GetNumberOfPoints(), 0);
  for (const std::string type : { "Float", "Double" })
  {
    expectLinear(data, (type + "Scalar").c_str(), 1);
    expectLinear(data, (type + "Vector").c_str(), 3);
    expectLinear(data, (type + "Tensor").c_str(), 9);
  }
  EXPECT_STREQ(data->GetPointData()->GetVectors()->GetName(), "DoubleVector");
  EXPECT_STREQ(data->GetPointData()->GetTensors()->GetName(), "DoubleTensor");
}

TEST(QuadOutputs, LinearFieldsAreReproduced)
{
  for (const Surface& surface : surfaces())
  {
    SCOPED_TRACE(surface.name);
    addLinear<vtkFloatArray>(surface.data, "FloatScalar", 1);
    addLinear<vtkDoubleArray>(surface.data, "DoubleScalar", 1);
    addLinear<vtkFloatArray>(surface.data, "FloatVector", 3);
    addLinear<vtkDoubleArray>(surface.data, "DoubleVector", 3);
    addLinear<vtkFloatArray>(surface.data, "FloatTensor", 9);
    addLinear<vtkDoubleArray>(surface.data, "DoubleTensor", 9);
    surface.data->GetPointData()->SetActiveVectors("DoubleVector");
    surface.data->GetPointData()->SetActiveTensors("DoubleTensor");
    for (const int smoothingSteps : { 0, 5 })
    {
      Both both(surface.data, surface.quads, vtkQuadRemesh::CELL_DATA_FROM_CENTRE, smoothingSteps);
      expectLinearFields(both.remesh->GetOutput());
      expectLinearFields(both.extraction->GetOutput());
      expectLinearFields(both.remesh->GetMappedSurface());
    }
  }
}

// ------------------------------------------------------------------ places

TEST(QuadOutputs, PointsLieOnTheirSourceFaces)
{
  for (const Surface& surface : surfaces())
  {
    SCOPED_TRACE(surface.name);
    Both both(surface.data, surface.quads);
    const double diagonal = surface.data->GetLength();
    for (const Both::Outputs& out : both.outputs())
    {
      vtkPointData* arrays = out.quads->GetPointData();
      auto* cell = vtkIdTypeArray::SafeDownCast(arrays->GetArray("SourceCellId"));
      auto* ids = vtkIdTypeArray::SafeDownCast(arrays->GetArray("SourcePointIds"));
      vtkDataArray* weights = arrays->GetArray("SourceBarycentric");
      ASSERT_TRUE(cell && ids && weights);
      for (vtkIdType i = 0; i < out.quads->GetNumberOfPoints(); ++i)
      {
        const std::vector<vtkIdType> corners = cornersOf(surface.data, cell->GetValue(i));
        Vector3 place = Vector3::Zero();
        double sum = 0;
        for (int k = 0; k < 3; ++k)
        {
          const vtkIdType id = ids->GetTypedComponent(i, k);
          EXPECT_NE(std::find(corners.begin(), corners.end(), id), corners.end());
          EXPECT_GE(weights->GetComponent(i, k), 0);
          place += weights->GetComponent(i, k) * Vector3(surface.data->GetPoint(id));
          sum += weights->GetComponent(i, k);
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        // Flat parts are flat but for what single precision leaves.
        ASSERT_LT((place - Vector3(out.quads->GetPoint(i))).norm(), 2e-8 * diagonal);
      }
    }
  }
}

/// Is the edge a boundary, a border of patches, or sharper than the feature angle?
bool isConstrained(
  vtkPolyData* data, const std::map<Edge, std::vector<vtkIdType>>& cells, const Edge& edge)
{
  const auto found = cells.find(edge);
  if (found == cells.end())
  {
    return false;
  }
  if (found->second.size() == 1)
  {
    return true;
  }
  vtkDataArray* patches = data->GetCellData()->GetArray("PatchId");
  std::array<Vector3, 2> normal;
  for (std::size_t i = 0; i < 2; ++i)
  {
    const std::vector<vtkIdType> ids = cornersOf(data, found->second[i]);
    const Vector3 p(data->GetPoint(ids[0]));
    normal[i] = (Vector3(data->GetPoint(ids[1])) - p).cross(Vector3(data->GetPoint(ids[2])) - p);
    normal[i].normalize();
  }
  return normal[0].dot(normal[1]) < std::cos(kFeatureAngle) + 1e-9 ||
    (patches && patches->GetTuple1(found->second[0]) != patches->GetTuple1(found->second[1]));
}

/// With one weight exactly zero for the edge, two for a vertex at the end of such an edge.
TEST(QuadOutputs, PointsOfLinesLieExactlyOnConstrainedEdges)
{
  std::size_t onEdges = 0;
  for (const Surface& surface : surfaces())
  {
    if (!surface.clean)
    {
      continue;
    }
    SCOPED_TRACE(surface.name);
    const auto cells = cellsAtEdges(surface.data);
    std::set<vtkIdType> onConstrained;
    for (const auto& [edge, unused] : cells)
    {
      if (isConstrained(surface.data, cells, edge))
      {
        onConstrained.insert({ edge.first, edge.second });
      }
    }
    Both both(surface.data, surface.quads);
    for (const Both::Outputs& out : both.outputs())
    {
      auto* ids =
        vtkIdTypeArray::SafeDownCast(out.quads->GetPointData()->GetArray("SourcePointIds"));
      vtkDataArray* weights = out.quads->GetPointData()->GetArray("SourceBarycentric");
      for (vtkIdType i = 0; i < out.lines->GetNumberOfPoints(); ++i)
      {
        const auto p =
          static_cast<vtkIdType>(out.lines->GetPointData()->GetArray("QuadPointId")->GetTuple1(i));
        std::vector<vtkIdType> used;
        for (int k = 0; k < 3; ++k)
        {
          if (weights->GetComponent(p, k) != 0)
          {
            used.push_back(ids->GetTypedComponent(p, k));
          }
        }
        ASSERT_LT(used.size(), 3u) << "point " << p << " lies inside a face";
        onEdges += used.size() == 2 ? 1 : 0;
        EXPECT_TRUE(used.size() == 1
            ? onConstrained.count(used[0]) == 1
            : isConstrained(surface.data, cells, std::minmax(used[0], used[1])))
          << "point " << p;
      }
    }
  }
  EXPECT_GT(onEdges, 1000u);
}

// ------------------------------------------------------------------ patches and labels

std::set<long long> valuesOf(vtkPolyData* data, const char* name)
{
  std::set<long long> values;
  vtkDataArray* array = data->GetCellData()->GetArray(name);
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.insert(static_cast<long long>(array->GetTuple1(i)));
  }
  return values;
}

/// Per edge the pair of a two-component array of the lines.
std::map<Edge, std::pair<long long, long long>> pairsOfLines(vtkPolyData* lines, const char* name)
{
  std::map<Edge, std::pair<long long, long long>> pairs;
  vtkDataArray* array = lines->GetCellData()->GetArray(name);
  vtkDataArray* points = lines->GetPointData()->GetArray("QuadPointId");
  for (vtkIdType i = 0; array && i < lines->GetNumberOfLines(); ++i)
  {
    const std::vector<vtkIdType> ids = cornersOf(lines, i);
    const auto a = static_cast<vtkIdType>(points->GetTuple1(ids[0]));
    const auto b = static_cast<vtkIdType>(points->GetTuple1(ids[1]));
    pairs[std::minmax(a, b)] = { static_cast<long long>(array->GetComponent(i, 0)),
      static_cast<long long>(array->GetComponent(i, 1)) };
  }
  return pairs;
}

/// Each line tells the values of the quads on its two sides; where the value changes there is a line.
void expectLinesSeparate(const Both::Outputs& out, const char* ofQuads, const char* ofLines)
{
  vtkDataArray* values = out.quads->GetCellData()->GetArray(ofQuads);
  ASSERT_NE(values, nullptr);
  const auto pairs = pairsOfLines(out.lines, ofLines);
  EXPECT_EQ(pairs.size(), static_cast<std::size_t>(out.lines->GetNumberOfLines()));
  for (const auto& [edge, cells] : cellsAtEdges(out.quads))
  {
    const auto first = static_cast<long long>(values->GetTuple1(cells.front()));
    const auto last = static_cast<long long>(values->GetTuple1(cells.back()));
    const auto found = pairs.find(edge);
    if (found != pairs.end())
    {
      EXPECT_EQ(found->second, (std::pair<long long, long long>(std::minmax(first, last))));
    }
    else if (std::string(ofQuads) == "PatchId")
    {
      EXPECT_EQ(first, last) << "a patch that ends at no feature line";
    }
  }
}

TEST(QuadOutputs, PatchesSurvive)
{
  std::size_t models = 0;
  for (const Surface& surface : surfaces())
  {
    if (!surface.data->GetCellData()->HasArray("PatchId"))
    {
      continue;
    }
    SCOPED_TRACE(surface.name);
    ++models;
    const std::set<long long> wanted = valuesOf(surface.data, "PatchId");
    EXPECT_GT(wanted.size(), 2u);
    for (const int from :
      { vtkQuadRemesh::CELL_DATA_FROM_CENTRE, vtkQuadRemesh::CELL_DATA_FROM_AREA })
    {
      Both both(surface.data, surface.quads, from);
      for (const Both::Outputs& out : both.outputs())
      {
        EXPECT_EQ(valuesOf(out.quads, "PatchId"), wanted);
        expectLinesSeparate(out, "PatchId", "PatchIds");
      }
    }
  }
  EXPECT_GE(models, 1u);
}

/// On a flat plate whose quads are some triangles wide: averages are nearer to the middle of the quads than the values
/// of single triangles, and labels are those of most of the quad.
TEST(QuadOutputs, CellDataFromAreaIsThatOfTheWholeQuad)
{
  const Mesh mesh = test::gridPlane(41, 41);
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(mesh);
  vtkNew<vtkDoubleArray> place;
  place->SetName("Place");
  vtkNew<vtkIntArray> side;
  side->SetName("Side");
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    Vector3 centre = Vector3::Zero();
    for (Index i = 0; i < 3; ++i)
    {
      centre += mesh.position[mesh.origin[3 * f + i]] / 3;
    }
    place->InsertNextValue(centre.x());
    side->InsertNextValue(centre.x() < 20 ? 1 : 2);
  }
  input->GetCellData()->AddArray(place);
  input->GetCellData()->AddArray(side);
  std::array<double, 2> error{};
  for (const int from :
    { vtkQuadRemesh::CELL_DATA_FROM_CENTRE, vtkQuadRemesh::CELL_DATA_FROM_AREA })
  {
    Both both(input, 150, from);
    for (const Both::Outputs& out : both.outputs())
    {
      for (vtkIdType q = 0; q < out.quads->GetNumberOfCells(); ++q)
      {
        double low = 41, high = 0, middle = 0;
        for (const vtkIdType p : cornersOf(out.quads, q))
        {
          const double x = out.quads->GetPoint(p)[0];
          middle += x / 4;
          low = std::min(low, x);
          high = std::max(high, x);
        }
        const double value = out.quads->GetCellData()->GetArray("Place")->GetTuple1(q);
        error[static_cast<std::size_t>(from)] += std::abs(value - middle);
        const double label = out.quads->GetCellData()->GetArray("Side")->GetTuple1(q);
        // A triangle of the border is one unit wide.
        if (high < 20 + 0.4 * (high - low) - 1 || low > 20 - 0.4 * (high - low) + 1)
        {
          EXPECT_EQ(label, high < 20 + 0.4 * (high - low) - 1 ? 1 : 2);
        }
      }
    }
    EXPECT_EQ(both.remesh->GetCellDataFrom(), from);
  }
  EXPECT_LT(error[1], 0.3 * error[0]);
}

// ------------------------------------------------------------------ layout

TEST(QuadOutputs, LayoutsArriveWhole)
{
  for (const Surface& surface : surfaces())
  {
    SCOPED_TRACE(surface.name);
    Both both(surface.data, surface.quads);
    for (const Both::Outputs& out : both.outputs())
    {
      QuadMesh mesh;
      mesh.points.resize(static_cast<std::size_t>(out.quads->GetNumberOfPoints()));
      for (vtkIdType q = 0; q < out.quads->GetNumberOfCells(); ++q)
      {
        const std::vector<vtkIdType> ids = cornersOf(out.quads, q);
        mesh.quads.push_back({ static_cast<Index>(ids[0]), static_cast<Index>(ids[1]),
          static_cast<Index>(ids[2]), static_cast<Index>(ids[3]) });
      }
      const auto pairs = pairsOfLines(out.lines, "LayoutPatchIds");
      for (const auto& [edge, unused] : pairs)
      {
        mesh.lines.push_back(
          { static_cast<Index>(edge.first), static_cast<Index>(edge.second), 0, false });
      }
      const QuadLayout layout = layoutOf(mesh);
      vtkDataArray* patch = out.quads->GetCellData()->GetArray("LayoutPatch");
      ASSERT_NE(patch, nullptr);
      for (std::size_t q = 0; q < mesh.quads.size(); ++q)
      {
        ASSERT_EQ(patch->GetTuple1(static_cast<vtkIdType>(q)), layout.patchOf[q]);
      }
      expectLinesSeparate(out, "LayoutPatch", "LayoutPatchIds");
      vtkDataArray* shape = out.quads->GetFieldData()->GetArray("LayoutPatchShape");
      vtkDataArray* size = out.quads->GetFieldData()->GetArray("LayoutPatchSize");
      ASSERT_TRUE(shape && size);
      ASSERT_EQ(shape->GetNumberOfTuples(), static_cast<vtkIdType>(layout.patches.size()));
      double quads = 0;
      for (std::size_t i = 0; i < layout.patches.size(); ++i)
      {
        const auto id = static_cast<vtkIdType>(i);
        EXPECT_EQ(shape->GetTuple1(id), static_cast<int>(layout.patches[i].shape));
        EXPECT_EQ(size->GetComponent(id, 0), layout.patches[i].size[0]);
        quads += size->GetComponent(id, 0) * size->GetComponent(id, 1);
      }
      EXPECT_EQ(quads, out.quads->GetNumberOfCells());
    }
  }
}

TEST(QuadOutputs, SeparatricesAreLinesOfTheQuads)
{
  for (const Surface& surface : surfaces())
  {
    SCOPED_TRACE(surface.name);
    Both both(surface.data, surface.quads);
    for (const Both::Outputs& out : both.outputs())
    {
      const auto edges = cellsAtEdges(out.quads);
      const auto features = pairsOfLines(out.lines, "LayoutPatchIds");
      vtkDataArray* ids = out.separatrices->GetPointData()->GetArray("QuadPointId");
      vtkCellData* cells = out.separatrices->GetCellData();
      vtkDataArray* start = cells->GetArray("StartKind");
      vtkDataArray* end = cells->GetArray("EndKind");
      vtkDataArray* feature = cells->GetArray("Feature");
      vtkDataArray* separatrix = cells->GetArray("Separatrix");
      vtkDataArray* valence = out.quads->GetPointData()->GetArray("Valence");
      vtkDataArray* boundary = out.quads->GetPointData()->GetArray("OnBoundary");
      ASSERT_TRUE(ids && start && end && feature && separatrix);
      const auto isKind = [&](double kind, vtkIdType p)
      {
        const bool irregular = valence->GetTuple1(p) > 4 - boundary->GetTuple1(p) ||
          (boundary->GetTuple1(p) == 0 && valence->GetTuple1(p) < 4);
        return kind == 0 ? irregular : kind == 1 ? boundary->GetTuple1(p) == 1 : !irregular;
      };
      for (vtkIdType i = 0; i < out.separatrices->GetNumberOfLines(); ++i)
      {
        std::vector<vtkIdType> points;
        for (const vtkIdType id : cornersOf(out.separatrices, i))
        {
          points.push_back(static_cast<vtkIdType>(ids->GetTuple1(id)));
          EXPECT_EQ(
            Vector3(out.separatrices->GetPoint(id)), Vector3(out.quads->GetPoint(points.back())));
        }
        for (std::size_t k = 0; k + 1 < points.size(); ++k)
        {
          const Edge edge = std::minmax(points[k], points[k + 1]);
          ASSERT_EQ(edges.count(edge), 1u);
          EXPECT_EQ(edges.at(edge).size(), 2u);
          EXPECT_EQ(features.count(edge), static_cast<std::size_t>(feature->GetTuple1(i)));
        }
        EXPECT_TRUE(isKind(start->GetTuple1(i), points.front()));
        EXPECT_TRUE(isKind(end->GetTuple1(i), points.back()));
        EXPECT_EQ(
          start->GetTuple1(i) == 3, points.front() == points.back() && end->GetTuple1(i) == 3);
        EXPECT_TRUE(
          separatrix->GetTuple1(i) == 1 || (start->GetTuple1(i) != 0 && end->GetTuple1(i) != 0));
      }
    }
  }
}

TEST(QuadOutputs, TheLayoutOfACubeIsItsSides)
{
  Both both(test::toPolyData(test::unitCube(12)), 600);
  for (const Both::Outputs& out : both.outputs())
  {
    EXPECT_EQ(valuesOf(out.quads, "LayoutPatch"), (std::set<long long>{ 0, 1, 2, 3, 4, 5 }));
    EXPECT_EQ(out.separatrices->GetNumberOfLines(), 12);
    EXPECT_EQ(valuesOf(out.separatrices, "StartKind"), (std::set<long long>{ 0 }));
    EXPECT_EQ(valuesOf(out.separatrices, "EndKind"), (std::set<long long>{ 0 }));
    EXPECT_EQ(valuesOf(out.separatrices, "Feature"), (std::set<long long>{ 1 }));
    EXPECT_EQ(valuesOf(out.lines, "Separatrix"), (std::set<long long>{ 1 }));
  }
}

/// Quads are polygons like others; what told of their layout does not pass for that of the new ones.
TEST(QuadOutputs, QuadsOfQuadsHaveTheirOwnLayout)
{
  Both first(test::toPolyData(test::unitCube(8)), 300);
  Both second(first.remesh->GetOutput(), 700);
  for (const Both::Outputs& out : second.outputs())
  {
    vtkDataArray* size = out.quads->GetFieldData()->GetArray("LayoutPatchSize");
    double quads = 0;
    for (vtkIdType i = 0; i < size->GetNumberOfTuples(); ++i)
    {
      quads += size->GetComponent(i, 0) * size->GetComponent(i, 1);
    }
    EXPECT_EQ(quads, out.quads->GetNumberOfCells());
    EXPECT_EQ(out.quads->GetPointData()->GetArray("Valence")->GetNumberOfTuples(),
      out.quads->GetNumberOfPoints());
  }
}

TEST(QuadOutputs, SameBytesForAnyNumberOfThreads)
{
  const vtkSmartPointer<vtkPolyData> input = model(QUADRILLE_DATA "/part.ply");
  ASSERT_NE(input, nullptr);
  addLinear<vtkDoubleArray>(input, "Linear", 3);
  std::vector<vtkSmartPointer<vtkQuadRemesh>> runs;
  for (const int threads : { 1, 3 })
  {
    runs.push_back(vtkSmartPointer<vtkQuadRemesh>::New());
    runs.back()->SetInputData(input);
    runs.back()->SetTargetTypeToNumberOfQuads();
    runs.back()->SetNumberOfQuads(2000);
    runs.back()->SetNumberOfThreads(threads);
    runs.back()->SetCellDataFromToArea();
    runs.back()->Update();
    ASSERT_EQ(runs.back()->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  }
  for (int port = 0; port < 4; ++port)
  {
    std::array<vtkPolyData*, 2> data{};
    for (std::size_t i = 0; i < 2; ++i)
    {
      data[i] = vtkPolyData::SafeDownCast(runs[i]->GetOutputDataObject(port));
    }
    for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      vtkDataSetAttributes* arrays = data[0]->GetAttributes(type);
      ASSERT_EQ(arrays->GetNumberOfArrays(), data[1]->GetAttributes(type)->GetNumberOfArrays());
      EXPECT_GT(arrays->GetNumberOfArrays(), 0);
      for (int k = 0; k < arrays->GetNumberOfArrays(); ++k)
      {
        vtkDataArray* a = arrays->GetArray(k);
        vtkDataArray* b = data[1]->GetAttributes(type)->GetArray(k);
        ASSERT_EQ(a->GetNumberOfValues(), b->GetNumberOfValues());
        EXPECT_EQ(std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
                    static_cast<std::size_t>(a->GetNumberOfValues() * a->GetDataTypeSize())),
          0)
          << port << " " << a->GetName();
      }
    }
  }
}

// A strip of quads of which the first three are no squares of the map, as in a face that was filled.
TEST(QuadOutputs, OnlyVerticesOfTheMapCanBeMoved)
{
  QuadMesh mesh;
  constexpr Index kLength = 8;
  for (Index i = 0; i <= kLength; ++i)
  {
    mesh.points.emplace_back(i, 0, 0);
    mesh.points.emplace_back(i, 1, 0);
  }
  for (Index i = 0; i < kLength; ++i)
  {
    mesh.quads.push_back({ 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1 });
    mesh.quadSourceWeights.push_back(
      i < 3 ? std::array<double, 3>{} : std::array<double, 3>{ 0.5, 0.25, 0.25 });
  }
  mesh.valence.assign(mesh.points.size(), 5);
  mesh.onBoundary.assign(mesh.points.size(), 0);
  mesh.onBoundary[2 * 7] = 1;
  mesh.lines.push_back({ 2 * 5, 2 * 6 });
  const vtkSmartPointer<vtkPolyData> irregular = writePreview(mesh).irregular;
  vtkDataArray* movable = irregular->GetPointData()->GetArray("MovableValence");
  ASSERT_EQ(irregular->GetNumberOfPoints(), 2 * kLength + 2);
  for (vtkIdType p = 0; p < irregular->GetNumberOfPoints(); ++p)
  {
    const bool stays = p < 2 * 3 || p == 2 * 5 || p == 2 * 6 || p == 2 * 7;
    EXPECT_EQ(movable->GetTuple1(p), stays ? 0 : 5) << p;
  }
  mesh.quadSourceWeights.clear(); // as where quads are put back onto another surface
  EXPECT_EQ(
    writePreview(mesh).irregular->GetPointData()->GetArray("MovableValence")->GetTuple1(0), 5);
}

TEST(QuadOutputs, ArraysThatAreTooShortAreANotice)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(40, 20));
  vtkNew<vtkDoubleArray> none;
  none->SetName("None");
  input->GetPointData()->AddArray(none);
  Both both(input, 300);
  EXPECT_NE(
    std::string(both.remesh->GetNoticesText()).find("'None' has 0 tuples"), std::string::npos);
  EXPECT_FALSE(both.remesh->GetOutput()->GetPointData()->HasArray("None"));
  both.remesh->GetMappedSurface()->GetPointData()->AddArray(none);
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputData(both.remesh->GetMappedSurface());
  extraction->Update();
  EXPECT_NE(
    std::string(extraction->GetNoticesText()).find("'None' has 0 tuples"), std::string::npos);
}

} // namespace
} // namespace quadrille
