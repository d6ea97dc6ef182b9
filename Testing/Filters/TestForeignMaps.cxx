// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"
#include "TestSurfaces.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkOBJReader.h>
#include <vtkPointData.h>
#include <vtkQuadExtraction.h>
#include <vtkQuadRemesh.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <limits>

namespace quadrille
{
namespace
{

vtkSmartPointer<vtkPolyData> mappedTorus()
{
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(test::toPolyData(test::torus(80, 40)));
  remesh->SetTargetTypeToNumberOfQuads();
  remesh->SetNumberOfQuads(500);
  remesh->Update();
  auto mapped = vtkSmartPointer<vtkPolyData>::New();
  mapped->DeepCopy(remesh->GetMappedSurface());
  return mapped;
}

/// The same triangles without any array; corner i of cell f has point 3 f + i where `soup`, else the point of the map
/// for display.
vtkSmartPointer<vtkPolyData> bareSurface(vtkPolyData* mapped, bool soup)
{
  auto bare = vtkSmartPointer<vtkPolyData>::New();
  if (!soup)
  {
    bare->CopyStructure(mapped);
    return bare;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polys;
  for (vtkIdType f = 0; f < mapped->GetNumberOfCells(); ++f)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    mapped->GetCellPoints(f, count, ids);
    polys->InsertNextCell(3);
    for (vtkIdType i = 0; i < 3; ++i)
    {
      polys->InsertCellPoint(points->InsertNextPoint(mapped->GetPoint(ids[i])));
    }
  }
  bare->SetPoints(points);
  bare->SetPolys(polys);
  return bare;
}

/// The map as texture coordinates of a type and number of components, each changed by a function.
template <class Array>
vtkSmartPointer<vtkPolyData> asTexture(
  vtkPolyData* mapped, int components, bool soup,
  const std::function<Vector2(const Vector2&)>& change = [](const Vector2& p) { return p; })
{
  vtkSmartPointer<vtkPolyData> data = bareSurface(mapped, soup);
  vtkNew<Array> texture;
  texture->SetName("Texture");
  texture->SetNumberOfComponents(components);
  texture->SetNumberOfTuples(data->GetNumberOfPoints());
  texture->Fill(0);
  vtkDataArray* igm = mapped->GetCellData()->GetArray(arrays::kIgm);
  for (vtkIdType f = 0; f < data->GetNumberOfCells(); ++f)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    data->GetCellPoints(f, count, ids);
    for (int i = 0; i < 3; ++i)
    {
      const Vector2 p =
        change(Vector2(igm->GetComponent(f, 2 * i), igm->GetComponent(f, 2 * i + 1)));
      texture->SetComponent(ids[i], 0, p.x());
      texture->SetComponent(ids[i], 1, p.y());
    }
  }
  data->GetPointData()->SetTCoords(texture);
  return data;
}

/// Runs a filter on data and keeps what it says.
struct Extracted
{
  vtkNew<vtkQuadExtraction> filter;
  test::Messages messages{ filter };

  explicit Extracted(vtkPolyData* data, double scale = 1)
  {
    filter->SetInputData(data);
    filter->SetTextureScale(scale);
    filter->Update();
  }
  vtkPolyData* quads() { return filter->GetOutput(); }
  bool succeeded() const { return filter->GetOutcome() == vtkQuadrilleAlgorithm::Succeeded; }
  double field(const char* name) { return quads()->GetFieldData()->GetArray(name)->GetTuple1(0); }
};

void expectBitIdentical(vtkPolyData* a, vtkPolyData* b)
{
  ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  ASSERT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    ASSERT_EQ(Vector3(a->GetPoint(i)), Vector3(b->GetPoint(i)));
  }
  for (vtkIdType q = 0; q < a->GetNumberOfCells(); ++q)
  {
    vtkIdType count = 0, other = 0;
    const vtkIdType *ids = nullptr, *others = nullptr;
    a->GetCellPoints(q, count, ids);
    b->GetCellPoints(q, other, others);
    ASSERT_TRUE(std::equal(ids, ids + count, others, others + other));
  }
}

std::map<int, int> valences(vtkPolyData* quads)
{
  std::map<int, int> count;
  vtkDataArray* array = quads->GetPointData()->GetArray(arrays::kValence);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    ++count[static_cast<int>(array->GetTuple1(i))];
  }
  return count;
}

/// The same quads but for their order: every centre of one mesh is near one of the other.
void expectSameQuads(vtkPolyData* a, vtkPolyData* b, double tolerance)
{
  ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  ASSERT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
  EXPECT_EQ(valences(a), valences(b));
  const auto centres = [](vtkPolyData* data)
  {
    std::vector<Vector3> result;
    for (vtkIdType q = 0; q < data->GetNumberOfCells(); ++q)
    {
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      data->GetCellPoints(q, count, ids);
      Vector3 sum = Vector3::Zero();
      for (vtkIdType i = 0; i < count; ++i)
      {
        sum += Vector3(data->GetPoint(ids[i])) / static_cast<double>(count);
      }
      result.push_back(sum);
    }
    return result;
  };
  const std::vector<Vector3> wanted = centres(b);
  for (const Vector3& c : centres(a))
  {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3& other : wanted)
    {
      nearest = std::min(nearest, (c - other).norm());
    }
    EXPECT_LT(nearest, tolerance);
  }
}

/// With a vertex for each point of the surface and texture coordinates of their own, as other programs write them.
void writeObj(const std::string& path, vtkPolyData* mapped)
{
  std::ofstream file(path);
  file << std::setprecision(12);
  vtkDataArray* vertex = mapped->GetPointData()->GetArray(arrays::kSurfacePointId);
  std::map<vtkIdType, Vector3> vertices;
  for (vtkIdType i = 0; i < mapped->GetNumberOfPoints(); ++i)
  {
    vertices[static_cast<vtkIdType>(vertex->GetTuple1(i))] = Vector3(mapped->GetPoint(i));
  }
  for (const auto& [id, p] : vertices)
  {
    file << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  }
  vtkDataArray* igm = mapped->GetCellData()->GetArray(arrays::kIgm);
  for (vtkIdType f = 0; f < mapped->GetNumberOfCells(); ++f)
  {
    for (int i = 0; i < 3; ++i)
    {
      file << "vt " << igm->GetComponent(f, 2 * i) << " " << igm->GetComponent(f, 2 * i + 1)
           << "\n";
    }
  }
  for (vtkIdType f = 0; f < mapped->GetNumberOfCells(); ++f)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    mapped->GetCellPoints(f, count, ids);
    file << "f";
    for (vtkIdType i = 0; i < 3; ++i)
    {
      file << " " << static_cast<vtkIdType>(vertex->GetTuple1(ids[i])) + 1 << "/" << 3 * f + i + 1;
    }
    file << "\n";
  }
}

vtkSmartPointer<vtkPolyData> readObj(const std::string& path)
{
  vtkNew<vtkOBJReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

} // namespace

// Our own map, through texture coordinates that hold it exactly.
TEST(ForeignMaps, ExactTextureCoordinatesGiveTheSameQuads)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  ASSERT_TRUE(own.succeeded()) << own.messages.errors;
  EXPECT_EQ(own.field("MapLargestMove"), 0);
  EXPECT_STREQ(own.filter->GetNoticesText(), "");
  for (const bool soup : { false, true })
  {
    for (const int components : { 2, 3 })
    {
      Extracted run(asTexture<vtkDoubleArray>(mapped, components, soup));
      ASSERT_TRUE(run.succeeded()) << run.messages.errors;
      EXPECT_EQ(run.field("MapLargestMove"), 0);
      expectBitIdentical(run.quads(), own.quads());
    }
  }
}

// The values of a file in single precision, with every corner a point of its own.
TEST(ForeignMaps, ObjFilesComeBackAsTheSameQuads)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  const std::string path = testing::TempDir() + "quadrille_foreign_map.obj";
  writeObj(path, mapped);
  const vtkSmartPointer<vtkPolyData> read = readObj(path);
  std::remove(path.c_str());
  // What the reader does where vertices have several texture coordinates.
  ASSERT_EQ(read->GetNumberOfPoints(), 3 * mapped->GetNumberOfCells());
  Extracted run(read);
  ASSERT_TRUE(run.succeeded()) << run.messages.errors;
  EXPECT_GT(run.field("MapLargestMove"), 0);
  EXPECT_LT(run.field("MapLargestMove"), 1e-5);
  EXPECT_EQ(run.field("MapInconsistentVertices"), 0);
  EXPECT_NE(std::string(run.filter->GetNoticesText()).find("has been rounded"), std::string::npos);
  EXPECT_NE(run.quads()->GetFieldData()->GetAbstractArray("Notices"), nullptr);
  expectSameQuads(run.quads(), own.quads(), 1e-4);
  EXPECT_EQ(test::tally(run.quads()).badEdges, 0u);
}

TEST(ForeignMaps, ACellArrayOfAnotherProgramIsRounded)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  vtkDataArray* igm = mapped->GetCellData()->GetArray(arrays::kIgm);
  for (vtkIdType f = 0; f < mapped->GetNumberOfCells(); ++f)
  {
    for (int k = 0; k < 6; ++k)
    {
      igm->SetComponent(
        f, k, igm->GetComponent(f, k) + 1e-6 * static_cast<double>((7 * f + k) % 11 - 5));
    }
  }
  Extracted run(mapped);
  ASSERT_TRUE(run.succeeded()) << run.messages.errors;
  EXPECT_GT(run.field("MapLargestMove"), 1e-7);
  EXPECT_LT(run.field("MapLargestMove"), 2e-5);
  expectSameQuads(run.quads(), own.quads(), 1e-3);
}

TEST(ForeignMaps, CoordinatesOfAnotherUnitAreScaled)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  const vtkSmartPointer<vtkPolyData> small =
    asTexture<vtkFloatArray>(mapped, 2, true, [](const Vector2& p) { return Vector2(p / 30); });
  Extracted unscaled(small);
  EXPECT_EQ(unscaled.filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(unscaled.messages.errors.find("one unit is one quad"), std::string::npos)
    << unscaled.messages.errors;
  Extracted scaled(small, 30);
  ASSERT_TRUE(scaled.succeeded()) << scaled.messages.errors;
  expectSameQuads(scaled.quads(), own.quads(), 1e-4);
  for (const double scale : { 0.0, -1.0, std::numeric_limits<double>::infinity() })
  {
    EXPECT_EQ(Extracted(small, scale).filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  }
}

// Images have their v axis downwards.
TEST(ForeignMaps, MirroredCoordinatesAreTurnedOver)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  Extracted run(asTexture<vtkDoubleArray>(
    mapped, 2, true, [](const Vector2& p) { return Vector2(p.x(), 1 - p.y()); }));
  ASSERT_TRUE(run.succeeded()) << run.messages.errors;
  EXPECT_NE(std::string(run.filter->GetNoticesText()).find("mirrored"), std::string::npos);
  expectSameQuads(run.quads(), own.quads(), 1e-9);
}

TEST(ForeignMaps, AMatchingIsUsedOrRefused)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted own(mapped);
  const vtkSmartPointer<vtkPolyData> texture = asTexture<vtkDoubleArray>(mapped, 2, true);
  vtkNew<vtkIntArray> matching; // of another type, and not within 0 to 3
  matching->SetName(arrays::kMatching);
  matching->SetNumberOfComponents(3);
  matching->SetNumberOfTuples(mapped->GetNumberOfCells());
  vtkDataArray* ours = mapped->GetCellData()->GetArray(arrays::kMatching);
  for (vtkIdType i = 0; i < 3 * mapped->GetNumberOfCells(); ++i)
  {
    matching->SetValue(i, static_cast<int>(ours->GetComponent(i / 3, static_cast<int>(i % 3))) - 4);
  }
  texture->GetCellData()->AddArray(matching);
  Extracted fits(texture);
  ASSERT_TRUE(fits.succeeded()) << fits.messages.errors;
  expectBitIdentical(fits.quads(), own.quads());

  matching->SetValue(3 * 17 + 1, matching->GetValue(3 * 17 + 1) + 1);
  Extracted contradicts(texture);
  EXPECT_EQ(contradicts.filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(contradicts.messages.errors.find("edge 1 of cell 17"), std::string::npos)
    << contradicts.messages.errors;

  matching->SetNumberOfComponents(1);
  matching->SetNumberOfTuples(mapped->GetNumberOfCells());
  EXPECT_NE(Extracted(texture).messages.errors.find("three whole numbers"), std::string::npos);
}

TEST(ForeignMaps, GarbageIsRefusedByName)
{
  const vtkSmartPointer<vtkPolyData> mapped = mappedTorus();
  Extracted none(bareSurface(mapped, true));
  EXPECT_EQ(none.filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(none.messages.errors.find("texture coordinates"), std::string::npos);
  EXPECT_NE(none.messages.errors.find("'IGM'"), std::string::npos);

  for (const double value :
    { std::numeric_limits<double>::quiet_NaN(), 9e18, -std::numeric_limits<double>::infinity() })
  {
    const vtkSmartPointer<vtkPolyData> texture = asTexture<vtkDoubleArray>(mapped, 2, true);
    texture->GetPointData()->GetTCoords()->SetComponent(3 * 40 + 2, 1, value);
    Extracted run(texture);
    EXPECT_EQ(run.filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
    EXPECT_NE(run.messages.errors.find("corner 2 of cell 40"), std::string::npos)
      << run.messages.errors;

    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->DeepCopy(mapped);
    copy->GetCellData()->GetArray(arrays::kIgm)->SetComponent(40, 5, value);
    EXPECT_NE(Extracted(copy).messages.errors.find("corner 2 of cell 40"), std::string::npos);
  }

  const vtkSmartPointer<vtkPolyData> one = asTexture<vtkDoubleArray>(mapped, 1 + 1, true);
  vtkNew<vtkIntArray> whole;
  whole->SetName("Texture");
  whole->SetNumberOfComponents(2);
  whole->SetNumberOfTuples(one->GetNumberOfPoints());
  whole->Fill(0);
  one->GetPointData()->SetTCoords(whole);
  EXPECT_NE(Extracted(one).messages.errors.find("2 or 3 real numbers"), std::string::npos);

  auto wrong = vtkSmartPointer<vtkPolyData>::New();
  wrong->DeepCopy(mapped);
  vtkNew<vtkDoubleArray> igm;
  igm->SetName(arrays::kIgm);
  igm->SetNumberOfComponents(2);
  igm->SetNumberOfTuples(wrong->GetNumberOfCells());
  igm->Fill(0);
  wrong->GetCellData()->AddArray(igm);
  EXPECT_NE(Extracted(wrong).messages.errors.find("6 real numbers a cell"), std::string::npos);

  vtkNew<vtkPolyData> empty;
  EXPECT_EQ(Extracted(empty).filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

// A plane whose texture coordinates are turned against it: the boundary is free.
TEST(ForeignMaps, FreeBoundariesAreTrimmedOrKept)
{
  const vtkSmartPointer<vtkPolyData> plane = test::toPolyData(test::gridPlane(6, 4));
  vtkNew<vtkFloatArray> texture;
  texture->SetName("Texture");
  texture->SetNumberOfComponents(2);
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  for (vtkIdType i = 0; i < plane->GetNumberOfPoints(); ++i)
  {
    const double* p = plane->GetPoint(i);
    texture->InsertNextTuple2(0.75 * p[0] - p[1] + 0.25, p[0] + 0.75 * p[1]);
    height->InsertNextValue(2 * p[0] - p[1]);
  }
  plane->GetPointData()->SetTCoords(texture);
  plane->GetPointData()->AddArray(height);
  EXPECT_EQ(Extracted(plane).filter->GetOutcome(), vtkQuadrilleAlgorithm::NoValidResult);

  for (const int mode :
    { vtkQuadExtraction::BOUNDARY_TRIMMED, vtkQuadExtraction::BOUNDARY_POLYGONS })
  {
    vtkNew<vtkQuadExtraction> filter;
    filter->SetBoundaryMode(mode);
    filter->SetInputData(plane);
    for (const int from :
      { vtkQuadExtraction::CELL_DATA_FROM_CENTRE, vtkQuadExtraction::CELL_DATA_FROM_AREA })
    {
      filter->SetCellDataFrom(from);
      filter->Update();
      ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
      vtkPolyData* quads = filter->GetOutput();
      const bool polygons = mode == vtkQuadExtraction::BOUNDARY_POLYGONS;
      const test::QuadTally tally = test::tally(quads);
      EXPECT_EQ(tally.badEdges, 0u);
      EXPECT_EQ(tally.onlyQuads, !polygons);
      EXPECT_EQ(tally.eulerCharacteristic, 1);
      vtkDataArray* partial = quads->GetCellData()->GetArray(arrays::kPartial);
      ASSERT_EQ(partial != nullptr, polygons);
      const auto cuts =
        static_cast<vtkIdType>(quads->GetFieldData()->GetArray("PartialCells")->GetTuple1(0));
      EXPECT_EQ(cuts > 0, polygons);
      vtkDataArray* patches = quads->GetCellData()->GetArray(arrays::kLayoutPatch);
      double area = 0;
      for (vtkIdType c = 0; c < quads->GetNumberOfCells(); ++c)
      {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        quads->GetCellPoints(c, count, ids);
        for (vtkIdType i = 0; i < count; ++i)
        {
          const Vector3 a(quads->GetPoint(ids[i])), b(quads->GetPoint(ids[(i + 1) % count]));
          area += (a.x() * b.y() - a.y() * b.x()) / 2;
        }
        if (polygons)
        {
          EXPECT_EQ(partial->GetTuple1(c) != 0, c >= quads->GetNumberOfCells() - cuts);
          EXPECT_EQ(patches->GetTuple1(c) == -1, partial->GetTuple1(c) != 0);
        }
      }
      // A cell is 0.64 large.
      EXPECT_NEAR(
        area, polygons ? 24 : 0.64 * static_cast<double>(quads->GetNumberOfCells()), 1e-6);
      vtkDataArray* carried = quads->GetPointData()->GetArray("Height");
      for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
      {
        const double* p = quads->GetPoint(i);
        EXPECT_NEAR(carried->GetTuple1(i), 2 * p[0] - p[1], 1e-6);
      }
      for (int a = 0; a < quads->GetCellData()->GetNumberOfArrays(); ++a)
      {
        EXPECT_EQ(quads->GetCellData()->GetAbstractArray(a)->GetNumberOfTuples(),
          quads->GetNumberOfCells());
      }
      EXPECT_GT(filter->GetSeparatrices()->GetNumberOfCells(), 0); // the whole quads end in stairs
      EXPECT_GT(filter->GetLines()->GetNumberOfCells(), polygons ? 0 : -1);
    }
  }
}

// Features that end inside of an edge of the quads.
TEST(ForeignMaps, EndsOfFeaturesAreTold)
{
  const vtkSmartPointer<vtkPolyData> plane = test::toPolyData(test::gridPlane(6, 4));
  vtkNew<vtkDoubleArray> texture;
  texture->SetName("Texture");
  texture->SetNumberOfComponents(2);
  for (vtkIdType i = 0; i < plane->GetNumberOfPoints(); ++i)
  {
    const double* p = plane->GetPoint(i);
    texture->InsertNextTuple2(0.5 * p[0], 0.5 * p[1]);
  }
  plane->GetPointData()->SetTCoords(texture);
  vtkNew<vtkUnsignedCharArray> features;
  features->SetName(arrays::kFeatureEdges);
  features->SetNumberOfTuples(plane->GetNumberOfCells());
  features->Fill(0);
  for (vtkIdType f = 0; f < plane->GetNumberOfCells(); ++f)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    plane->GetCellPoints(f, count, ids);
    for (int i = 0; i < 3; ++i)
    {
      const Vector3 a(plane->GetPoint(ids[i])), b(plane->GetPoint(ids[(i + 1) % 3]));
      if (a.y() == 2 && b.y() == 2 && std::max(a.x(), b.x()) <= 3)
      {
        features->SetValue(f, static_cast<unsigned char>(features->GetValue(f) | 1 << i));
      }
    }
  }
  plane->GetCellData()->AddArray(features);
  Extracted aligned(plane);
  EXPECT_EQ(aligned.filter->GetOutcome(), vtkQuadrilleAlgorithm::NoValidResult);
  vtkNew<vtkQuadExtraction> filter;
  filter->SetBoundaryModeToTrimmed();
  filter->SetInputData(plane);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  vtkFieldData* fields = filter->GetOutput()->GetFieldData();
  EXPECT_EQ(fields->GetArray("NonIntegerFeatureEnds")->GetTuple1(0), 1);
  EXPECT_EQ(
    Vector3(fields->GetArray("NonIntegerFeatureEndPlaces")->GetTuple3(0)), Vector3(3, 2, 0));
  EXPECT_NE(std::string(filter->GetNoticesText()).find("no integer points"), std::string::npos);
}

#ifdef QUADRILLE_SHARED_DATA

// Maps by other programs; the counts of fandisk are those of the reference extraction [Ebke et al. 2013] by its
// authors.
TEST(ForeignMaps, FandiskOfAnotherProgram)
{
  const std::string path = QUADRILLE_SHARED_DATA "/igm/qex_fandisk_param.obj";
  if (!std::ifstream(path))
  {
    GTEST_SKIP() << "no " << path;
  }
  Extracted run(readObj(path));
  ASSERT_TRUE(run.succeeded()) << run.messages.errors;
  EXPECT_EQ(run.quads()->GetNumberOfCells(), 897);
  EXPECT_EQ(run.quads()->GetNumberOfPoints(), 899);
  EXPECT_EQ(valences(run.quads()), (std::map<int, int>{ { 3, 18 }, { 4, 871 }, { 5, 10 } }));
}

#endif

} // namespace quadrille
