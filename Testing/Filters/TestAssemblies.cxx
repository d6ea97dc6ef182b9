// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of assemblies: their shares of the quads, what is kept of them, and quads that fit together where they meet.
#include "PlyFile.h"
#include "StaggeredTube.h"
#include "TestSurfaces.h"

#include "Base/Angles.h"
#include "Mesh/Surface.h"
#include "Mesh/Topology.h"
#include "Prepare/Prepare.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataAssembly.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkQuadExtraction.h>
#include <vtkQuadRemesh.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

using PointPlace = std::array<double, 3>;
using PlacePair = std::pair<PointPlace, PointPlace>;

bool tells(const char* text, const std::string& part)
{
  return std::string(text).find(part) != std::string::npos;
}

void setPart(
  vtkMultiBlockDataSet* data, unsigned index, vtkDataObject* part, const std::string& name)
{
  data->SetBlock(index, part);
  data->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), name.c_str());
}

vtkPolyData* partOf(vtkQuadRemesh* filter, unsigned index, int port = 0)
{
  auto* data = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(port));
  return data ? vtkPolyData::SafeDownCast(data->GetBlock(index)) : nullptr;
}

void addFieldNumber(vtkDataObject* data, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  data->GetFieldData()->AddArray(array);
}

/// The faces of a mesh by part, each part a surface with points of its own.
vtkSmartPointer<vtkMultiBlockDataSet> cutApart(
  const Mesh& mesh, unsigned parts, const std::function<unsigned(Index face)>& partAt)
{
  auto whole = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned part = 0; part < parts; ++part)
  {
    std::map<Index, vtkIdType> own;
    auto data = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> polys;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      if (partAt(f) != part)
      {
        continue;
      }
      polys->InsertNextCell(3);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const auto [found, isNew] = own.emplace(mesh.origin[h], points->GetNumberOfPoints());
        if (isNew)
        {
          points->InsertNextPoint(mesh.position[mesh.origin[h]].data());
        }
        polys->InsertCellPoint(found->second);
      }
    }
    data->SetPoints(points);
    data->SetPolys(polys);
    setPart(whole, part, data, "part " + std::to_string(part));
  }
  return whole;
}

Vector3 middleOf(const Mesh& mesh, Index f)
{
  return (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
           mesh.position[mesh.origin[3 * f + 2]]) /
    3;
}

/// By the side of the cube that the face lies on.
vtkSmartPointer<vtkMultiBlockDataSet> cubeOfSix(int n)
{
  const Mesh cube = test::unitCube(n);
  return cutApart(cube, 6,
    [&cube](Index f)
    {
      Index axis = 0;
      const Vector3 normal = test::faceNormal(cube, f);
      normal.cwiseAbs().maxCoeff(&axis);
      return static_cast<unsigned>(2 * axis + (normal[axis] > 0 ? 1 : 0));
    });
}

/// Patches between sharp edges.
vtkSmartPointer<vtkMultiBlockDataSet> cutAtFeatures(const Mesh& mesh)
{
  std::vector<unsigned> part(mesh.faceCount(), 0);
  unsigned parts = 0;
  for (Index seed = 0; seed < mesh.faceCount(); ++seed)
  {
    if (part[seed] != 0)
    {
      continue;
    }
    part[seed] = ++parts;
    for (std::vector<Index> open{ seed }; !open.empty();)
    {
      const Index f = open.back();
      open.pop_back();
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = mesh.twin[h];
        if (g != kInvalidIndex && !mesh.isFeature(h) && part[g / 3] == 0)
        {
          part[g / 3] = parts;
          open.push_back(g / 3);
        }
      }
    }
  }
  return cutApart(mesh, parts, [&part](Index f) { return part[f] - 1; });
}

/// A wall of triangles and two discs that are fans round their middles.
vtkSmartPointer<vtkMultiBlockDataSet> cylinderOfThree()
{
  constexpr int around = 32;
  const Mesh wall = test::openCylinder(around, 12);
  auto whole = cutApart(wall, 1, [](Index) { return 0U; });
  for (const bool isTop : { false, true })
  {
    auto disc = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> polys;
    std::vector<Vector3> rim;
    double low = 1e30, high = -1e30;
    for (const Vector3& p : wall.position)
    {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    for (const Vector3& p : wall.position)
    {
      if (p.z() == (isTop ? high : low))
      {
        rim.push_back(p);
      }
    }
    std::sort(rim.begin(), rim.end(),
      [](const Vector3& a, const Vector3& b)
      { return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x()); });
    EXPECT_EQ(rim.size(), static_cast<std::size_t>(around));
    points->InsertNextPoint(0, 0, isTop ? high : low);
    for (const Vector3& p : rim)
    {
      points->InsertNextPoint(p.data());
    }
    for (vtkIdType i = 0; i < around; ++i)
    {
      // Counterclockwise seen from above; the lower disc runs against its wall on purpose.
      polys->InsertNextCell({ 0, i + 1, (i + 1) % around + 1 });
    }
    disc->SetPoints(points);
    disc->SetPolys(polys);
    setPart(whole, isTop ? 2 : 1, disc, isTop ? "top" : "bottom");
  }
  return whole;
}

PointPlace placeOf(vtkPolyData* data, vtkIdType point)
{
  PointPlace place;
  data->GetPoint(point, place.data());
  return place;
}

/// All quads of the parts by the places of their corners.
struct Union
{
  std::map<PlacePair, int> edges; ///< number of quads
  std::set<PointPlace> places;
  vtkIdType quads = 0;

  explicit Union(vtkQuadRemesh* filter)
  {
    auto* data = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    for (unsigned i = 0; i < data->GetNumberOfBlocks(); ++i)
    {
      add(vtkPolyData::SafeDownCast(data->GetBlock(i)));
    }
  }
  void add(vtkPolyData* part)
  {
    ASSERT_NE(part, nullptr);
    quads += part->GetNumberOfCells();
    for (vtkIdType c = 0; c < part->GetNumberOfCells(); ++c)
    {
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      part->GetCellPoints(c, count, ids);
      ASSERT_EQ(count, 4);
      for (int i = 0; i < 4; ++i)
      {
        const PointPlace a = placeOf(part, ids[i]), b = placeOf(part, ids[(i + 1) % 4]);
        ++edges[{ std::min(a, b), std::max(a, b) }];
        places.insert(a);
      }
    }
  }
  int edgesOf(int uses) const
  {
    return static_cast<int>(std::count_if(
      edges.begin(), edges.end(), [uses](const auto& edge) { return edge.second == uses; }));
  }
  long long euler() const
  {
    return static_cast<long long>(places.size()) - static_cast<long long>(edges.size()) + quads;
  }
};

void expectClosedUnion(vtkQuadRemesh* filter, long long euler)
{
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const Union all(filter);
  EXPECT_EQ(all.edgesOf(2), static_cast<int>(all.edges.size()));
  EXPECT_EQ(all.euler(), euler);
  EXPECT_EQ(all.quads, filter->GetActualQuads());
  auto* data = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned i = 0; i < data->GetNumberOfBlocks(); ++i)
  {
    const test::QuadTally t = test::tally(partOf(filter, i));
    EXPECT_GT(t.boundaryEdges, 0U);
    EXPECT_EQ(t.badEdges, 0U);
  }
}

void remeshTogether(vtkQuadRemesh* filter, vtkDataObject* input, vtkIdType quads)
{
  filter->SetInputDataObject(input);
  filter->SetNumberOfQuads(quads);
  filter->ConformingOn();
  filter->Update();
}

//------------------------------------------------------------------------------
// Shares, and what is kept

TEST(Assemblies, OwnNumbersGoFirstAndTheRestIsShared)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(8);
  addFieldNumber(input->GetBlock(1), "NumberOfQuads", 400);
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->SetNumberOfQuads(1000);
  filter->SetQuadsOfBlocks(" part 0 = 100\n part 2=25 ; ");
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const auto target = [&filter](unsigned part)
  { return partOf(filter, part)->GetFieldData()->GetArray("TargetQuads")->GetTuple1(0); };
  EXPECT_EQ(target(0), 100);
  EXPECT_EQ(target(1), 400);
  EXPECT_EQ(target(2), 25);
  for (const unsigned part : { 3U, 4U, 5U })
  {
    EXPECT_NEAR(target(part), (1000 - 525) / 3.0, 1);
  }
  // The text goes before the array, and a number of its own is none of the others.
  filter->SetQuadsOfBlocks("part 1 = 300");
  filter->SetQuadsAreToPerBlock();
  filter->SetNumberOfQuads(64);
  filter->Update();
  EXPECT_EQ(target(1), 300);
  EXPECT_EQ(target(0), 64);
  EXPECT_EQ(partOf(filter, 0)->GetNumberOfCells(), 64);
}

TEST(Assemblies, WrongNumbersAreTold)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(4);
  const auto textOf = [&input](const char* pairs)
  {
    vtkNew<vtkQuadRemesh> filter;
    const test::Messages messages(filter);
    filter->SetInputData(input);
    filter->SetNumberOfQuads(600);
    filter->SetQuadsOfBlocks(pairs);
    filter->Update();
    EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput) << pairs;
    return std::string(filter->GetOutcomeText());
  };
  EXPECT_TRUE(tells(textOf("wheel = 5").c_str(), "no such block; there are 'part 0', 'part 1'"));
  EXPECT_TRUE(tells(textOf("part 1 = 2.5").c_str(), "'part 1 = 2.5'"));
  EXPECT_TRUE(tells(textOf("part 1 300").c_str(), "no pair of a name"));
  EXPECT_TRUE(tells(textOf("part 1 = 3; part 1 = 4").c_str(), "twice"));
  EXPECT_TRUE(tells(textOf("part 1 = 600").c_str(), "nothing of the 600 quads"));
  addFieldNumber(input->GetBlock(3), "NumberOfQuads", 0);
  EXPECT_TRUE(tells(textOf("").c_str(), "part 3: the field data array 'NumberOfQuads'"));
}

TEST(Assemblies, NamesFieldDataAndTheTreeAreKept)
{
  static vtkInformationIntegerKey* const key = new vtkInformationIntegerKey("Colour", "Test");
  const vtkSmartPointer<vtkMultiBlockDataSet> inner = cubeOfSix(4);
  addFieldNumber(inner, "Mass", 7);
  addFieldNumber(inner->GetBlock(2), "Thickness", 0.5);
  vtkNew<vtkMultiBlockDataSet> input;
  setPart(input, 0, inner, "Cube");
  input->GetMetaData(0U)->Set(key, 42);
  addFieldNumber(input, "Time", 3);
  vtkNew<vtkQuadRemesh> filter;
  for (const vtkTypeBool conforming : { 0, 1 })
  {
    filter->SetConforming(conforming);
    filter->SetInputData(input);
    filter->SetQuadsOfBlocks("Cube/part 2 = 150");
    filter->SetNumberOfQuads(600);
    filter->Update();
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    EXPECT_EQ(output->GetFieldData()->GetArray("Time")->GetTuple1(0), 3);
    EXPECT_EQ(output->GetMetaData(0U)->Get(key), 42);
    EXPECT_STREQ(output->GetMetaData(0U)->Get(vtkCompositeDataSet::NAME()), "Cube");
    auto* cube = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(0));
    EXPECT_EQ(cube->GetFieldData()->GetArray("Mass")->GetTuple1(0), 7);
    EXPECT_STREQ(cube->GetMetaData(2U)->Get(vtkCompositeDataSet::NAME()), "part 2");
    EXPECT_EQ(cube->GetBlock(2)->GetFieldData()->GetArray("Thickness")->GetTuple1(0), 0.5);
    EXPECT_EQ(cube->GetBlock(2)->GetFieldData()->GetArray("TargetQuads")->GetTuple1(0), 150);
    EXPECT_FALSE(cube->GetBlock(1)->GetFieldData()->HasArray("Thickness"));
  }
}

//------------------------------------------------------------------------------
// Conforming

TEST(ConformingParts, SixSidesOfACubeAreClosed)
{
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, cubeOfSix(8), 600);
  expectClosedUnion(filter, 2);
  EXPECT_TRUE(tells(filter->GetNoticesText(),
    "part 0: conforming, made in one run with 'part 1', 'part 2', 'part 3', 'part 4', 'part 5': "
    "they "
    "have 96 edges in common"))
    << filter->GetNoticesText();
  vtkAbstractArray* others = partOf(filter, 1)->GetFieldData()->GetAbstractArray("ConformingWith");
  ASSERT_NE(others, nullptr);
  EXPECT_EQ(others->GetNumberOfValues(), 5);
  // Apart they do not fit: the test can fail.
  filter->SetQuadsOfBlocks("part 0 = 30; part 1 = 200");
  filter->ConformingOff();
  filter->Update();
  EXPECT_GT(Union(filter).edgesOf(1), 0);
  filter->ConformingOn();
  filter->Update();
  expectClosedUnion(filter, 2);
}

/// Sizes do what they can: sides that meet have the same number of edges on their common curve.
TEST(ConformingParts, OwnNumbersBecomeSizes)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetQuadsOfBlocks("part 5 = 300; part 4 = 24");
  remeshTogether(filter, cubeOfSix(8), 600);
  expectClosedUnion(filter, 2);
  EXPECT_GT(partOf(filter, 5)->GetNumberOfCells(), 2 * partOf(filter, 4)->GetNumberOfCells());
}

/// Corners where four parts meet, curves that are bent.
TEST(ConformingParts, OctantsOfASphereAreClosed)
{
  const Mesh sphere = test::sphere(4);
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter,
    cutApart(sphere, 8,
      [&sphere](Index f)
      {
        const Vector3 p = middleOf(sphere, f);
        return (p.x() > 0 ? 1U : 0U) + (p.y() > 0 ? 2U : 0U) + (p.z() > 0 ? 4U : 0U);
      }),
    500);
  expectClosedUnion(filter, 2);
}

/// The lower disc runs the other way round, and stays so.
TEST(ConformingParts, EachKeepsItsOrientation)
{
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, cylinderOfThree(), 500);
  expectClosedUnion(filter, 2);
  for (const unsigned part : { 1U, 2U })
  {
    vtkPolyData* disc = partOf(filter, part);
    double area = 0;
    for (vtkIdType c = 0; c < disc->GetNumberOfCells(); ++c)
    {
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      disc->GetCellPoints(c, count, ids);
      const Vector3 a(placeOf(disc, ids[0]).data()), b(placeOf(disc, ids[1]).data()),
        d(placeOf(disc, ids[2]).data()), e(placeOf(disc, ids[3]).data());
      area += 0.5 * (d - a).cross(e - b).z();
    }
    EXPECT_NEAR(area, 3.1, 0.2); // both counterclockwise seen from above, as they came
  }
}

/// Many patches of all shapes and sizes between the sharp edges of parts, some smaller than the quads would be.
TEST(ConformingParts, PatchesOfCadPartsAreClosed)
{
  std::vector<std::string> paths{ QUADRILLE_DATA "/part.ply" };
#ifdef QUADRILLE_SHARED_DATA
  paths.emplace_back(QUADRILLE_SHARED_DATA "/cad/fandisk.ply");
#endif
  for (const std::string& path : paths)
  {
    SCOPED_TRACE(path);
    const std::optional<SurfaceInput> input = test::loadPly(path);
    ASSERT_TRUE(input);
    PrepareOptions options;
    options.featureAngle = 40 * kPi / 180;
    const Mesh mesh = prepareSurface(*input, options).mesh;
    const vtkSmartPointer<vtkMultiBlockDataSet> patches = cutAtFeatures(mesh);
    ASSERT_GT(patches->GetNumberOfBlocks(), 4U);
    vtkNew<vtkQuadRemesh> filter;
    remeshTogether(filter, patches, 3000);
    // A seam that is not closed would change the Euler characteristic.
    const TopologySummary topology = summarizeTopology(mesh);
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    const Union all(filter);
    EXPECT_EQ(all.euler(), topology.eulerCharacteristic);
    EXPECT_EQ(all.edgesOf(1) + all.edgesOf(2), static_cast<int>(all.edges.size()));
    EXPECT_EQ(all.edgesOf(1) == 0, topology.boundaryLoops == 0);
  }
}

/// What the part's own map gives are the part's own quads.
TEST(ConformingParts, EachHasItsOwnMap)
{
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, cylinderOfThree(), 400);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputConnection(filter->GetOutputPort(1));
  extraction->Update();
  ASSERT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << extraction->GetOutcomeText();
  auto* quads = vtkMultiBlockDataSet::SafeDownCast(extraction->GetOutputDataObject(0));
  for (unsigned part = 0; part < 3; ++part)
  {
    EXPECT_EQ(vtkPolyData::SafeDownCast(quads->GetBlock(part))->GetNumberOfCells(),
      partOf(filter, part)->GetNumberOfCells());
  }
}

/// Arrays that only one part has stay with it, and tell of its own points and cells.
TEST(ConformingParts, EachKeepsItsArrays)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(8);
  for (unsigned part = 0; part < 6; ++part)
  {
    auto* data = vtkPolyData::SafeDownCast(input->GetBlock(part));
    vtkNew<vtkDoubleArray> x;
    x->SetName(part == 3 ? "only here" : "x");
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      x->InsertNextValue(data->GetPoint(i)[0] + 10 * part);
    }
    data->GetPointData()->AddArray(x);
  }
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, input, 600);
  expectClosedUnion(filter, 2);
  for (unsigned part = 0; part < 6; ++part)
  {
    vtkPolyData* quads = partOf(filter, part);
    auto* source = vtkPolyData::SafeDownCast(input->GetBlock(part));
    EXPECT_EQ(quads->GetPointData()->HasArray("only here"), part == 3 ? 1 : 0);
    vtkDataArray* x = quads->GetPointData()->GetArray(part == 3 ? "only here" : "x");
    vtkDataArray* cells = quads->GetCellData()->GetArray("SourceCellId");
    ASSERT_NE(x, nullptr);
    for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
    {
      ASSERT_NEAR(x->GetTuple1(i), quads->GetPoint(i)[0] + 10 * part, 1e-9);
    }
    ASSERT_LT(cells->GetRange()[1], source->GetNumberOfCells());
  }
}

TEST(ConformingParts, ABlockThatTouchesNoneIsMadeAlone)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(6);
  const Mesh torus = test::torus(40, 20);
  auto far = test::toPolyData(torus);
  for (vtkIdType i = 0; i < far->GetNumberOfPoints(); ++i)
  {
    const double* p = far->GetPoint(i);
    far->GetPoints()->SetPoint(i, p[0] + 4, p[1], p[2]);
  }
  setPart(input, 6, far, "Torus");
  vtkNew<vtkQuadRemesh> filter, apart;
  remeshTogether(filter, input, 1200);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  apart->SetInputData(input);
  apart->SetNumberOfQuads(1200);
  apart->Update();
  ASSERT_EQ(partOf(filter, 6)->GetNumberOfPoints(), partOf(apart, 6)->GetNumberOfPoints());
  for (vtkIdType i = 0; i < partOf(apart, 6)->GetNumberOfPoints(); ++i)
  {
    ASSERT_EQ(placeOf(partOf(filter, 6), i), placeOf(partOf(apart, 6), i));
  }
  EXPECT_FALSE(partOf(filter, 6)->GetFieldData()->HasArray("ConformingWith"));
}

/// The cube with a fin that goes on from one of its edges.
vtkSmartPointer<vtkMultiBlockDataSet> cubeWithFin(int n)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(n);
  auto sheet = test::toPolyData(test::gridPlane(n, n)); // in the plane z = 0
  double bounds[6];
  input->GetBounds(bounds);
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    const double* p = sheet->GetPoint(i);
    sheet->GetPoints()->SetPoint(
      i, bounds[1] + p[0] / n, bounds[2] + p[1] / n * (bounds[3] - bounds[2]), bounds[5]);
  }
  setPart(input, 6, sheet, "Fin");
  return input;
}

TEST(ConformingParts, ThreeSheetsMeetAtACurve)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetQuadsOfBlocks("Fin = 40"); // fewer edges than the others have there
  remeshTogether(filter, cubeWithFin(8), 600);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const Union all(filter);
  // All but the borders of the fin are edges of two quads or, where it stands, of three.
  const test::QuadTally fin = test::tally(partOf(filter, 6));
  EXPECT_EQ(fin.eulerCharacteristic, 1);
  EXPECT_EQ(fin.badEdges, 0U);
  EXPECT_GT(all.edgesOf(3), 5);
  EXPECT_EQ(all.edgesOf(1) + all.edgesOf(3), static_cast<int>(fin.boundaryEdges));
  EXPECT_EQ(all.edgesOf(1) + all.edgesOf(2) + all.edgesOf(3), static_cast<int>(all.edges.size()));
  EXPECT_EQ(all.euler(), 2); // of the cube; the fin adds a disc along a curve
  EXPECT_TRUE(tells(filter->GetNoticesText(), "common to more than two sheets"))
    << filter->GetNoticesText();
}

/// Voxels that `isIn` chooses, as a solid; two of them have the same triangles where they touch.
vtkSmartPointer<vtkPolyData> solidOf(const std::function<bool(int, int, int)>& isIn)
{
  return test::toPolyData(test::voxelSurface({ 12, 6, 6 }, 1, isIn));
}

/// Each solid is closed, and what they share are the same quads: an edge has two quads of each solid that it is on.
TEST(ConformingParts, TouchingSolidsShareTheirQuads)
{
  for (const bool areEqual : { true, false })
  {
    SCOPED_TRACE(areEqual);
    vtkNew<vtkMultiBlockDataSet> input;
    setPart(input, 0, solidOf([](int i, int, int) { return i < 6; }), "A");
    setPart(input, 1,
      solidOf(
        [&](int i, int j, int k) { return i >= 6 && (areEqual || (j >= 1 && j < 5 && k >= 2)); }),
      "B");
    vtkNew<vtkQuadRemesh> filter;
    remeshTogether(filter, input, 900);
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    std::vector<std::set<std::set<PointPlace>>> quads(2);
    for (unsigned part = 0; part < 2; ++part)
    {
      vtkPolyData* solid = partOf(filter, part);
      const test::QuadTally t = test::tally(solid);
      EXPECT_EQ(t.boundaryEdges, 0U);
      EXPECT_EQ(t.badEdges, 0U);
      EXPECT_EQ(t.eulerCharacteristic, 2);
      double volume = 0; // positive: the quads look outwards, as the triangles did
      for (vtkIdType c = 0; c < solid->GetNumberOfCells(); ++c)
      {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        solid->GetCellPoints(c, count, ids);
        std::set<PointPlace> corners;
        for (int i = 0; i < 4; ++i)
        {
          corners.insert(placeOf(solid, ids[i]));
        }
        quads[part].insert(corners);
        const Vector3 a(placeOf(solid, ids[0]).data()), b(placeOf(solid, ids[1]).data()),
          d(placeOf(solid, ids[2]).data()), e(placeOf(solid, ids[3]).data());
        volume += (a.dot(b.cross(d)) + a.dot(d.cross(e))) / 6;
      }
      EXPECT_NEAR(volume, part == 0 || areEqual ? 216 : 6 * 4 * 4, 1e-6);
    }
    double shared = 0;
    for (const std::set<PointPlace>& quad : quads[0])
    {
      shared += quads[1].count(quad) != 0 ? 1 : 0;
    }
    EXPECT_GT(shared, 20);
    // The faces that both have are those at x = 6, all of them.
    for (unsigned part = 0; part < 2; ++part)
    {
      for (const std::set<PointPlace>& quad : quads[part])
      {
        const bool isInPlane = std::all_of(
          quad.begin(), quad.end(), [](const PointPlace& p) { return std::abs(p[0] - 6) < 1e-9; });
        const bool isOnB = std::all_of(quad.begin(), quad.end(),
          [&](const PointPlace& p)
          { return areEqual || (p[1] > 1 - 1e-9 && p[1] < 5 + 1e-9 && p[2] > 2 - 1e-9); });
        EXPECT_EQ(quads[1 - part].count(quad) != 0, isInPlane && isOnB);
      }
    }
  }
}

/// Planes cut a box into two to four solids, some of them thin: each is closed, and every edge has two quads of each
/// solid that it is on. Where a sheet lacks an odd number of edges, few segments get more: with all numbers even the
/// last box had 1,296 quads of 1,100.
TEST(ConformingParts, BoxesCutByPlanesConform)
{
  using Cut = std::pair<int, int>; // axis, and the first voxel beyond
  const std::vector<std::vector<Cut>> boxes{ { { 0, 5 } }, { { 0, 4 }, { 1, 3 } },
    { { 1, 2 }, { 2, 1 }, { 0, 1 } }, { { 0, 5 }, { 1, 3 }, { 2, 1 } },
    { { 2, 1 }, { 0, 4 }, { 1, 5 } } };
  for (std::size_t b = 0; b < boxes.size(); ++b)
  {
    const std::vector<Cut>& cuts = boxes[b];
    vtkNew<vtkMultiBlockDataSet> input;
    for (std::size_t solid = 0; solid <= cuts.size(); ++solid)
    {
      // Beyond the last cut that it is beyond of; 0: beyond none.
      setPart(input, static_cast<unsigned>(solid),
        test::toPolyData(test::voxelSurface({ 8, 6, 4 }, 1,
          [&](int i, int j, int k)
          {
            const std::array<int, 3> at{ i, j, k };
            std::size_t first = 0;
            while (first < cuts.size() &&
              at[static_cast<std::size_t>(cuts[first].first)] < cuts[first].second)
            {
              ++first;
            }
            return first == solid;
          })),
        "Solid " + std::to_string(solid));
    }
    for (const vtkIdType number : { 300, 1100 })
    {
      SCOPED_TRACE(std::to_string(b) + " with " + std::to_string(number));
      vtkNew<vtkQuadRemesh> filter;
      remeshTogether(filter, input, number);
      ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
      vtkIdType quads = 0;
      for (unsigned solid = 0; solid <= cuts.size(); ++solid)
      {
        const test::QuadTally t = test::tally(partOf(filter, solid));
        EXPECT_EQ(t.boundaryEdges, 0U);
        EXPECT_EQ(t.badEdges, 0U);
        EXPECT_EQ(t.eulerCharacteristic, 2);
        quads += partOf(filter, solid)->GetNumberOfCells();
      }
      if (number > 1000)
      {
        EXPECT_LT(static_cast<double>(quads), 1.15 * static_cast<double>(number));
      }
      const Union all(filter);
      EXPECT_TRUE(std::all_of(
        all.edges.begin(), all.edges.end(), [](const auto& edge) { return edge.second % 2 == 0; }));
      EXPECT_GT(all.edgesOf(4), 10);
    }
  }
}

/// Patches that no map has with all their borders: the faces between borders that end next to each other are filled,
/// which is told with the place, and the blocks are as watertight as ever. With quads small enough for the gap all are
/// mapped.
TEST(ConformingParts, PatchesWithoutAMapAreFilled)
{
  const auto remesh = [](vtkQuadRemesh* filter, double gap, vtkIdType number)
  {
    const test::PatchedMesh tube = test::staggeredTube(gap);
    remeshTogether(filter,
      cutApart(tube.mesh, 4, [&tube](Index f) { return static_cast<unsigned>(tube.patch[f]); }),
      number);
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    // An open tube: its two ends are all that is open.
    const Union all(filter);
    EXPECT_EQ(all.euler(), 0);
    EXPECT_EQ(all.edgesOf(1) + all.edgesOf(2), static_cast<int>(all.edges.size()));
    std::size_t open = 0;
    for (const auto& [edge, uses] : all.edges)
    {
      const bool isEnd = std::abs(std::abs(edge.first[0]) - 1) < 1e-6 &&
        std::abs(edge.first[0] - edge.second[0]) < 1e-6;
      EXPECT_EQ(uses == 1, isEnd);
      open += uses == 1 ? 1 : 0;
    }
    EXPECT_GT(open, 12U);
    for (unsigned part = 0; part < 4; ++part)
    {
      const test::QuadTally t = test::tally(partOf(filter, part));
      EXPECT_EQ(t.badEdges, 0U);
      EXPECT_EQ(t.eulerCharacteristic, 1); // a disc
    }
  };
  vtkNew<vtkQuadRemesh> coarse, fine;
  remesh(coarse, 0.02, 300);
  EXPECT_TRUE(tells(coarse->GetNoticesText(), "between sharp edges")) << coarse->GetNoticesText();
  EXPECT_TRUE(tells(coarse->GetNoticesText(), "near ("));
  EXPECT_TRUE(tells(coarse->GetNoticesText(), "ask for more than"));
  remesh(fine, 0.3, 1500);
  EXPECT_FALSE(tells(fine->GetNoticesText(), "between sharp edges")) << fine->GetNoticesText();
}

/// Two solids with an edge in common and no face have nothing to be cut at: each is closed, and a notice tells.
TEST(ConformingParts, SolidsThatTouchAtAnEdgeAreEachClosed)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setPart(input, 0, solidOf([](int i, int j, int) { return i < 6 && j < 3; }), "A");
  setPart(input, 1, solidOf([](int i, int j, int) { return i >= 6 && j >= 3; }), "B");
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, input, 600);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  for (unsigned part = 0; part < 2; ++part)
  {
    const test::QuadTally t = test::tally(partOf(filter, part));
    EXPECT_EQ(t.boundaryEdges, 0U);
    EXPECT_EQ(t.badEdges, 0U);
    EXPECT_EQ(t.eulerCharacteristic, 2);
  }
  EXPECT_TRUE(tells(filter->GetNoticesText(), "touch at 6 edges, one of them near (6, 3, "))
    << filter->GetNoticesText();
}

TEST(ConformingParts, ASheetThatMeetsItselfIsRefusedWithThePlace)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setPart(input, 0, test::toPolyData(test::gridPlane(6, 6)), "Floor");
  auto fin = test::toPolyData(test::gridPlane(2, 2));
  for (vtkIdType i = 0; i < fin->GetNumberOfPoints(); ++i)
  {
    const double* p = fin->GetPoint(i);
    fin->GetPoints()->SetPoint(i, 3, 2 + p[0], p[1]);
  }
  setPart(input, 1, fin, "Fin");
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  remeshTogether(filter, input, 300);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_TRUE(tells(filter->GetOutcomeText(), "Floor: a sheet meets itself"))
    << filter->GetOutcomeText();
  EXPECT_TRUE(tells(filter->GetOutcomeText(), "(3, 2.5, 0)")) << filter->GetOutcomeText();
}

TEST(ConformingParts, CurvesWithOtherPointsAreTold)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setPart(input, 0, test::toPolyData(test::gridPlane(4, 4)), "Coarse");
  auto fine = test::toPolyData(test::gridPlane(7, 7));
  double bounds[6];
  fine->GetBounds(bounds);
  for (vtkIdType i = 0; i < fine->GetNumberOfPoints(); ++i)
  {
    const double* p = fine->GetPoint(i);
    fine->GetPoints()->SetPoint(i, bounds[0] - (p[0] - bounds[0]), p[1] * 4 / 7, p[2]);
  }
  setPart(input, 1, fine, "Fine");
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, input, 300);
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_TRUE(tells(filter->GetNoticesText(), "of 'Coarse' and 'Fine' at"))
    << filter->GetNoticesText();
}

/// The second execution looks the quads up; a change of one part makes all of its group anew.
TEST(ConformingParts, ResultsAreKept)
{
  const vtkSmartPointer<vtkMultiBlockDataSet> input = cubeOfSix(6);
  vtkNew<vtkQuadRemesh> filter;
  remeshTogether(filter, input, 600);
  const vtkIdType first = filter->GetActualQuads();
  filter->SetNumberOfQuads(300);
  filter->Update();
  expectClosedUnion(filter, 2);
  EXPECT_NE(filter->GetActualQuads(), first);
  filter->SetNumberOfQuads(600);
  filter->Update();
  expectClosedUnion(filter, 2);
  EXPECT_EQ(filter->GetActualQuads(), first);
  EXPECT_TRUE(tells(filter->GetReusedStagesText(), "part 5: all")) << filter->GetReusedStagesText();
  vtkNew<vtkMultiBlockDataSet> fewer;
  fewer->ShallowCopy(input);
  fewer->SetBlock(5, nullptr);
  filter->SetInputData(fewer);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_FALSE(tells(filter->GetReusedStagesText(), "part 0: all"));
}

} // namespace
} // namespace quadrille
