// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "Quads/QuadShape.h"
#include "TestSurfaces.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDecimationHierarchy.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkIntegerGridMap.h>
#include <vtkIntegerGridMapUpmap.h>
#include <vtkMath.h>
#include <vtkPointData.h>
#include <vtkQuadExtraction.h>
#include <vtkQuadRemesh.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace quadrille
{
namespace
{

/// The four stage filters in a row.
struct Chain
{
  vtkNew<vtkDecimationHierarchy> hierarchy;
  vtkNew<vtkIntegerGridMap> map;
  vtkNew<vtkIntegerGridMapUpmap> upmap;
  vtkNew<vtkQuadExtraction> extraction;

  explicit Chain(vtkPolyData* input)
  {
    hierarchy->SetInputData(input);
    hierarchy->SetTargetTypeToNumberOfQuads();
    hierarchy->SetNumberOfQuads(500);
    map->SetInputConnection(hierarchy->GetOutputPort(0));
    upmap->SetInputConnection(map->GetOutputPort());
    upmap->SetInputData(1, input);
    upmap->SetLogConnection(hierarchy->GetOutputPort(2));
    upmap->SetIntermediateConnection(hierarchy->GetOutputPort(1));
    extraction->SetInputConnection(upmap->GetOutputPort());
  }
};

std::vector<Vector3> pointsOf(vtkPolyData* data)
{
  std::vector<Vector3> points;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    points.push_back(Vector3(data->GetPoint(i)));
  }
  return points;
}

/// Positive where faces look outwards.
double volumeOf(vtkPolyData* data)
{
  vtkNew<vtkIdList> ids;
  const Vector3 base(data->GetPoint(0));
  double volume = 0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    data->GetCellPoints(c, ids);
    for (vtkIdType i = 2; i < ids->GetNumberOfIds(); ++i)
    {
      const Vector3 a = Vector3(data->GetPoint(ids->GetId(0))) - base;
      const Vector3 b = Vector3(data->GetPoint(ids->GetId(i - 1))) - base;
      const Vector3 d = Vector3(data->GetPoint(ids->GetId(i))) - base;
      volume += a.dot(b.cross(d)) / 6;
    }
  }
  return volume;
}

vtkSmartPointer<vtkQuadRemesh> inOneClick(vtkPolyData* input)
{
  const auto remesh = vtkSmartPointer<vtkQuadRemesh>::New();
  remesh->SetInputData(input);
  remesh->SetTargetTypeToNumberOfQuads();
  remesh->SetNumberOfQuads(500);
  remesh->Update();
  return remesh;
}

/// Where the pipeline needs no second attempt, the stages one by one are the same computation.
TEST(StageFilters, ChainEqualsOneClick)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    height->InsertNextValue(input->GetPoint(i)[2]);
  }
  input->GetPointData()->AddArray(height);
  Chain chain(input);
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
    << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
  const vtkSmartPointer<vtkQuadRemesh> oneClick = inOneClick(input);
  ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);

  vtkPolyData* quads = chain.extraction->GetOutput();
  EXPECT_EQ(pointsOf(quads), pointsOf(oneClick->GetOutput()));
  vtkCellArray* corners = quads->GetPolys();
  vtkCellArray* sameCorners = oneClick->GetOutput()->GetPolys();
  ASSERT_EQ(corners->GetNumberOfConnectivityIds(), sameCorners->GetNumberOfConnectivityIds());
  for (vtkIdType i = 0; i < corners->GetNumberOfConnectivityIds(); ++i)
  {
    ASSERT_EQ(corners->GetConnectivityArray()->GetTuple1(i),
      sameCorners->GetConnectivityArray()->GetTuple1(i));
  }
  auto* cells = vtkIdTypeArray::SafeDownCast(quads->GetPointData()->GetArray("SourceCellId"));
  auto* expected =
    vtkIdTypeArray::SafeDownCast(oneClick->GetOutput()->GetPointData()->GetArray("SourceCellId"));
  ASSERT_TRUE(cells && expected);
  vtkDataArray* carried = quads->GetPointData()->GetArray("Height");
  ASSERT_NE(carried, nullptr);
  for (vtkIdType i = 0; i < cells->GetNumberOfValues(); ++i)
  {
    ASSERT_EQ(cells->GetValue(i), expected->GetValue(i));
    // Height is linear in the position.
    ASSERT_NEAR(carried->GetTuple1(i), quads->GetPoint(i)[2], 1e-12);
  }
}

bool sameArrays(vtkFieldData* a, vtkFieldData* b)
{
  bool same = a->GetNumberOfArrays() == b->GetNumberOfArrays();
  for (int i = 0; same && i < a->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = a->GetAbstractArray(i);
    vtkAbstractArray* other = b->GetAbstractArray(array->GetName());
    same = other && array->GetNumberOfValues() == other->GetNumberOfValues();
    for (vtkIdType k = 0; same && k < array->GetNumberOfValues(); ++k)
    {
      same = array->GetVariantValue(k) == other->GetVariantValue(k);
    }
  }
  return same;
}

/// All that later filters read, but for the seconds in the field data.
void expectSameData(vtkPolyData* a, vtkPolyData* b)
{
  EXPECT_EQ(pointsOf(a), pointsOf(b));
  EXPECT_TRUE(sameArrays(a->GetPointData(), b->GetPointData()));
  EXPECT_TRUE(sameArrays(a->GetCellData(), b->GetCellData()));
  ASSERT_EQ(a->GetNumberOfPolys(), b->GetNumberOfPolys());
  vtkDataArray* corners = a->GetPolys()->GetConnectivityArray();
  vtkDataArray* others = b->GetPolys()->GetConnectivityArray();
  ASSERT_EQ(corners->GetNumberOfValues(), others->GetNumberOfValues());
  for (vtkIdType i = 0; i < corners->GetNumberOfValues(); ++i)
  {
    ASSERT_EQ(corners->GetTuple1(i), others->GetTuple1(i));
  }
}

bool hasPrepared(vtkQuadrilleAlgorithm* filter)
{
  return std::string(filter->GetStageTimesText()).find("repair:") != std::string::npos;
}

/// What is found in the process, and what is made again where nobody holds it any more (from a file, in another
/// process), are the same bytes.
TEST(StageFilters, WhatIsHeldIsFoundAndMadeAgainWhereItIsNot)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  vtkNew<vtkPolyData> coarse;
  vtkNew<vtkTable> log;
  vtkNew<vtkPolyData> mapped;
  vtkNew<vtkPolyData> quads;
  {
    Chain chain(input);
    chain.extraction->Update();
    ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
    EXPECT_TRUE(hasPrepared(chain.hierarchy));
    EXPECT_FALSE(hasPrepared(chain.upmap)) << chain.upmap->GetStageTimesText();
    coarse->ShallowCopy(chain.map->GetOutput());
    log->ShallowCopy(chain.hierarchy->GetOutputDataObject(2));
    mapped->ShallowCopy(chain.upmap->GetOutput());
    quads->ShallowCopy(chain.extraction->GetOutput());
  }
  vtkNew<vtkIntegerGridMapUpmap> upmap; // the filters that held something are gone
  upmap->SetInputData(0, coarse);
  upmap->SetInputData(1, input);
  upmap->SetInputData(2, log);
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputData(mapped);
  extraction->Update();
  expectSameData(extraction->GetOutput(), quads);
  upmap->Update();
  EXPECT_TRUE(hasPrepared(upmap)) << upmap->GetStageTimesText();
  expectSameData(upmap->GetOutput(), mapped);

  // Executed again it finds what it has made itself.
  upmap->TextureCoordinatesOff();
  upmap->Update();
  ASSERT_EQ(upmap->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_FALSE(hasPrepared(upmap)) << upmap->GetStageTimesText();
}

/// Contents count, not the object: a change that VTK does not hear of is seen.
TEST(StageFilters, NothingIsFoundForASurfaceThatHasChanged)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  Chain chain(input);
  chain.extraction->Update();
  auto* points = vtkDoubleArray::SafeDownCast(input->GetPoints()->GetData());
  ASSERT_NE(points, nullptr);
  points->GetPointer(0)[0] += 1e-3; // more than a step of the grid that a run works on
  vtkNew<vtkIntegerGridMapUpmap> upmap;
  upmap->SetInputData(0, chain.map->GetOutput());
  upmap->SetInputData(1, input);
  upmap->SetInputData(2, chain.hierarchy->GetOutputDataObject(2));
  const test::Messages messages(upmap);
  upmap->Update();
  EXPECT_EQ(upmap->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(std::string(upmap->GetOutcomeText()).find("another surface"), std::string::npos);
  EXPECT_TRUE(hasPrepared(upmap) || std::string(upmap->GetStageTimesText()).empty());

  // One corner of the map moved: the extraction has to see it.
  vtkNew<vtkPolyData> mapped;
  mapped->DeepCopy(chain.upmap->GetOutput());
  auto* igm = vtkDoubleArray::SafeDownCast(mapped->GetCellData()->GetArray("IGM"));
  ASSERT_NE(igm, nullptr);
  igm->GetPointer(0)[0] += 3;
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputData(mapped);
  const test::Messages ofExtraction(extraction);
  extraction->Update();
  EXPECT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

/// Far from the origin, and as a mirror image with its faces as they were (so that they look inwards) or turned round.
TEST(StageFilters, ChainEqualsOneClickFarAwayAndInTheMirror)
{
  for (const bool mirrored : { false, true })
  {
    for (const bool reversed : { false, true })
    {
      Mesh mesh = test::torus(80, 40);
      for (Vector3& p : mesh.position.editAll())
      {
        p = Vector3((mirrored ? -1 : 1) * p.x() + 30000, p.y() - 20000, p.z());
      }
      if (reversed)
      {
        reverseFaces(mesh);
      }
      const vtkSmartPointer<vtkPolyData> input = test::toPolyData(mesh);
      Chain chain(input);
      chain.extraction->Update();
      ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
        << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
        << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
      const vtkSmartPointer<vtkQuadRemesh> oneClick = inOneClick(input);
      ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
      EXPECT_EQ(pointsOf(chain.extraction->GetOutput()), pointsOf(oneClick->GetOutput()));
      // Levels and the mapped surface have the points of the input, and faces that look where the input's look.
      const std::vector<Vector3> points = pointsOf(input);
      for (vtkPolyData* level :
        { chain.hierarchy->GetOutput(), chain.map->GetOutput(), chain.upmap->GetOutput(),
          vtkPolyData::SafeDownCast(oneClick->GetOutputDataObject(1)) })
      {
        const std::vector<Vector3> own = pointsOf(level);
        for (const Vector3& p : own)
        {
          ASSERT_NE(std::find(points.begin(), points.end(), p), points.end());
        }
        EXPECT_EQ(volumeOf(level) > 0, volumeOf(input) > 0);
        vtkDataArray* determinant = level->GetCellData()->GetArray(arrays::kDeterminant);
        EXPECT_TRUE(level == chain.hierarchy->GetOutput() || determinant->GetRange()[0] > 0);
      }
      EXPECT_EQ(volumeOf(chain.extraction->GetOutput()) > 0, volumeOf(input) > 0);
      EXPECT_NEAR(volumeOf(chain.extraction->GetOutput()) / volumeOf(input), 1, 0.05);
      EXPECT_FALSE(chain.extraction->GetOutput()->GetPointData()->HasArray(arrays::kFramePosition));
    }
  }
}

/// The method of the map is a property of its stage; the later ones know from it what the map promises.
TEST(StageFilters, ChainTakesEveryMethod)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  vtkNew<vtkQuadRemesh>
    oneClick; // the same for all: a change of the method begins at the coarse level
  oneClick->SetInputData(input);
  oneClick->SetTargetTypeToNumberOfQuads();
  oneClick->SetNumberOfQuads(500);
  for (int method = vtkIntegerGridMap::METHOD_SCALE_AWARE;
       method <= vtkIntegerGridMap::METHOD_SEAMLESS; ++method)
  {
    Chain chain(input);
    chain.map->SetMethod(method);
    chain.upmap->Update();
    ASSERT_EQ(chain.upmap->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << method << chain.map->GetOutcomeText() << chain.upmap->GetOutcomeText();
    EXPECT_STREQ(chain.upmap->GetNoticesText(), "") << method;
    oneClick->SetMethod(method);
    oneClick->Update();
    ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << oneClick->GetOutcomeText();
    EXPECT_EQ(std::string(oneClick->GetReusedStagesText()).find("phase1") != std::string::npos,
      method != vtkIntegerGridMap::METHOD_SCALE_AWARE)
      << method << ": " << oneClick->GetReusedStagesText();
    EXPECT_EQ(oneClick->GetMappedSurface()->GetNumberOfPolys(), input->GetNumberOfPolys());
    if (method != vtkIntegerGridMap::METHOD_SEAMLESS)
    {
      chain.extraction->Update();
      EXPECT_EQ(pointsOf(chain.extraction->GetOutput()), pointsOf(oneClick->GetOutput())) << method;
      continue;
    }
    EXPECT_EQ(oneClick->GetActualQuads(), 0);
    EXPECT_NE(std::string(oneClick->GetNoticesText()).find("no quads"), std::string::npos);
    for (vtkPolyData* mapped : { chain.upmap->GetOutput(), oneClick->GetMappedSurface() })
    {
      vtkNew<vtkQuadExtraction> extraction;
      const test::Messages messages(extraction);
      extraction->SetInputData(mapped);
      extraction->Update();
      EXPECT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
      EXPECT_NE(messages.errors.find("'seamless'"), std::string::npos) << messages.errors;
    }
  }
}

/// Sizes, with their growth limited, travel with the coarse level; the surface is refined by them again.
TEST(StageFilters, ChainHonoursSizes)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  vtkNew<vtkFloatArray> sizes;
  sizes->SetName("Sizing");
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    sizes->InsertNextValue(input->GetPoint(i)[0] > 0 ? 0.4F : 1.0F);
  }
  input->GetPointData()->AddArray(sizes);
  Chain chain(input);
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
    << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
  EXPECT_TRUE(chain.hierarchy->GetOutput()->GetPointData()->HasArray("Sizing"));
  EXPECT_NE(
    std::string(chain.hierarchy->GetNoticesText()).find("grow gradually"), std::string::npos);

  const vtkSmartPointer<vtkQuadRemesh> oneClick = inOneClick(input);
  ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  vtkPolyData* quads = chain.extraction->GetOutput();
  ASSERT_EQ(quads->GetNumberOfPoints(), oneClick->GetOutput()->GetNumberOfPoints());
  std::size_t fine = 0;
  for (const Vector3& p : pointsOf(quads))
  {
    const vtkIdType at = test::nearestPoint(oneClick->GetOutput(), p);
    EXPECT_LT((Vector3(oneClick->GetOutput()->GetPoint(at)) - p).norm(), 1e-12);
    fine += p.x() > 0 ? 1 : 0;
  }
  // Six times as many a unit of area, were it not for the growth in between.
  EXPECT_GT(fine, 3 * (static_cast<std::size_t>(quads->GetNumberOfPoints()) - fine));
}

/// Guides and target valences travel with the coarse level and the mapped surface.
TEST(StageFilters, ChainHonoursGuidesAndValences)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  vtkNew<vtkDoubleArray> directions;
  directions->SetName("GuidingDirection");
  directions->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
  {
    const Vector3 p(input->GetPoint(input->GetCell(i)->GetPointId(0)));
    directions->InsertNextTuple3(p.x() > 0.9 ? 1 : 0, 0, p.x() > 0.9 ? 1 : 0);
  }
  input->GetCellData()->AddArray(directions);
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  valences->SetNumberOfTuples(input->GetNumberOfPoints());
  valences->Fill(0);
  valences->SetValue(1530, 3);
  valences->SetValue(1820, 5);
  input->GetPointData()->AddArray(valences);
  Chain chain(input);
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
    << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
  EXPECT_TRUE(chain.hierarchy->GetOutput()->GetCellData()->HasArray("GuidingDirection"));
  EXPECT_TRUE(chain.hierarchy->GetOutput()->GetPointData()->HasArray("TargetValence"));
  EXPECT_STREQ(chain.hierarchy->GetNoticesText(), "");

  const vtkSmartPointer<vtkQuadRemesh> oneClick = inOneClick(input);
  ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  vtkPolyData* quads = chain.extraction->GetOutput();
  EXPECT_EQ(pointsOf(quads), pointsOf(oneClick->GetOutput()));
  EXPECT_EQ(quads->GetNumberOfPolys(), oneClick->GetOutput()->GetNumberOfPolys());
  vtkDataArray* valence = oneClick->GetOutput()->GetPointData()->GetArray("Valence");
  for (const vtkIdType point : { 1530, 1820 })
  {
    const vtkIdType at = oneClick->GetOutput()->FindPoint(input->GetPoint(point));
    EXPECT_EQ(Vector3(oneClick->GetOutput()->GetPoint(at)), Vector3(input->GetPoint(point)));
    EXPECT_EQ(valence->GetTuple1(at), valences->GetValue(point));
  }

  // Without the intermediate level the map has the same whole numbers, but is not turned along the guides between.
  const std::vector<Vector3> along = pointsOf(quads);
  chain.upmap->SetInputConnection(3, nullptr);
  chain.extraction->Update();
  EXPECT_EQ(pointsOf(chain.extraction->GetOutput()).size(), along.size());
  EXPECT_NE(pointsOf(chain.extraction->GetOutput()), along);
}

TEST(StageFilters, ChainMakesCycles)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  std::vector<Vector3> points; // round the tube, slanted
  for (int i = 0; i <= 24; ++i)
  {
    const double angle = vtkMath::Pi() * (i % 24) / 12;
    const double turn = 0.3 * std::cos(angle);
    const double radius = 1 + 0.4 * std::cos(angle);
    points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), 0.4 * std::sin(angle));
  }
  const vtkSmartPointer<vtkPolyData> loop = test::polyline(points);
  vtkNew<vtkIntArray> kind;
  kind->SetName("ConstraintType");
  kind->InsertNextValue(3);
  loop->GetCellData()->AddArray(kind);
  Chain chain(input);
  chain.hierarchy->SetCurvesData(loop);
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
    << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
  const std::string notices = chain.hierarchy->GetNoticesText();
  EXPECT_NE(notices.find("were added to the triangles where constraints lie"), std::string::npos)
    << notices;
  EXPECT_STREQ(chain.map->GetNoticesText(), "");

  const auto oneClick = vtkSmartPointer<vtkQuadRemesh>::New();
  oneClick->SetInputData(input);
  oneClick->SetCurvesData(loop);
  oneClick->SetTargetTypeToNumberOfQuads();
  oneClick->SetNumberOfQuads(500);
  oneClick->Update();
  ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(oneClick->GetConstraintTable()->GetValueByName(0, "Met").ToInt(), 1);
  EXPECT_EQ(pointsOf(chain.extraction->GetOutput()), pointsOf(oneClick->GetOutput()));
}

/// What is drawn on triangles that are larger than the quads changes these; the surface is made again from the log.
TEST(StageFilters, ChainHonoursWhatIsDrawn)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(24, 12));
  const auto onTorus = [](double u, double v)
  {
    const double radius = 1 + 0.4 * std::cos(v);
    return Vector3(radius * std::cos(u), radius * std::sin(u), 0.4 * std::sin(v));
  };
  const vtkSmartPointer<vtkPolyData> curve =
    test::polyline({ onTorus(0.3, 0.2), onTorus(0.9, 0.9) });
  const vtkSmartPointer<vtkPolyData> stroke = test::polyline({ onTorus(2, 0.1), onTorus(2.6, 1) });
  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  for (const auto& [place, valence] :
    { std::pair{ onTorus(4.1, 1.1), 3 }, std::pair{ onTorus(5, 2), 5 } })
  {
    coordinates->InsertNextPoint(place.data());
    valences->InsertNextValue(valence);
  }
  points->SetPoints(coordinates);
  points->GetPointData()->AddArray(valences);
  const auto draw = [&](vtkQuadrilleSurfaceAlgorithm* filter)
  {
    filter->SetCurvesData(curve);
    filter->SetStrokesData(stroke);
    filter->SetStrokeRadius(0.2);
    filter->SetValencePointsData(points);
  };
  auto chain = std::make_unique<Chain>(input);
  draw(chain->hierarchy);
  chain->extraction->Update();
  ASSERT_EQ(chain->extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain->hierarchy->GetOutcomeText() << chain->map->GetOutcomeText()
    << chain->upmap->GetOutcomeText() << chain->extraction->GetOutcomeText();
  const std::vector<Vector3> quads = pointsOf(chain->extraction->GetOutput());
  const auto oneClick = vtkSmartPointer<vtkQuadRemesh>::New();
  oneClick->SetInputData(input);
  draw(oneClick);
  oneClick->SetTargetTypeToNumberOfQuads();
  oneClick->SetNumberOfQuads(500);
  oneClick->Update();
  ASSERT_EQ(oneClick->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  ASSERT_EQ(oneClick->GetOutput()->GetFieldData()->GetArray("Attempts")->GetTuple1(0), 1);
  EXPECT_EQ(quads, pointsOf(oneClick->GetOutput()));
  // From data alone, as behind a file: nothing of this process is found.
  vtkNew<vtkPolyData> coarse;
  coarse->DeepCopy(chain->map->GetOutput());
  vtkNew<vtkPolyData> intermediate;
  intermediate->DeepCopy(chain->hierarchy->GetOutput(1));
  vtkNew<vtkTable> log;
  log->DeepCopy(chain->hierarchy->GetOutputDataObject(2));
  chain.reset();
  vtkNew<vtkIntegerGridMapUpmap> upmap;
  upmap->SetInputData(0, coarse);
  upmap->SetInputData(1, input);
  upmap->SetInputDataObject(2, log);
  upmap->SetInputData(3, intermediate);
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputConnection(upmap->GetOutputPort());
  extraction->Update();
  ASSERT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << upmap->GetOutcomeText() << extraction->GetOutcomeText();
  EXPECT_EQ(pointsOf(extraction->GetOutput()), quads);
}

/// An array of the surface that changes is answered from the stage that it enters at, with the same levels.
TEST(StageFilters, OtherGuidesBeginAtTheCoarseLevel)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  const auto guided = [&](double x)
  {
    const auto data = vtkSmartPointer<vtkPolyData>::New();
    data->ShallowCopy(input);
    vtkNew<vtkDoubleArray> directions;
    directions->SetName("GuidingDirection");
    directions->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < input->GetNumberOfCells(); ++i)
    {
      const Vector3 p(input->GetPoint(input->GetCell(i)->GetPointId(0)));
      directions->InsertNextTuple3(p.x() > 0.9 ? x : 0, 0, p.x() > 0.9 ? 1 : 0);
    }
    data->GetCellData()->AddArray(directions);
    return data;
  };
  const auto setInput = [](Chain& chain, vtkPolyData* data)
  {
    chain.hierarchy->SetInputData(data);
    chain.upmap->SetInputData(1, data);
    chain.extraction->Update();
  };
  Chain chain(guided(1));
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_STREQ(chain.hierarchy->GetReusedStagesText(), "");
  for (const bool keepsLevels : { true, false })
  {
    chain.hierarchy->SetKeepLevels(keepsLevels);
    setInput(chain, guided(keepsLevels ? -1 : 0.5));
    ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
    const std::string ran = chain.hierarchy->GetStageTimesText();
    EXPECT_EQ(ran.find("phase1") == std::string::npos, keepsLevels) << ran;
    EXPECT_EQ(ran.find("order") == std::string::npos, keepsLevels) << ran;
    EXPECT_EQ(ran.find("phase2") == std::string::npos, keepsLevels) << ran;
    EXPECT_FALSE(hasPrepared(chain.upmap)) << chain.upmap->GetStageTimesText();
    Chain fresh(guided(keepsLevels ? -1 : 0.5));
    fresh.extraction->Update();
    expectSameData(chain.extraction->GetOutput(), fresh.extraction->GetOutput());
  }
}

TEST(StageFilters, LevelsAreSubsamplingsOfTheSurface)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  Chain chain(input);
  chain.hierarchy->SetCoarseVertices(200);
  chain.hierarchy->Update();
  ASSERT_EQ(chain.hierarchy->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText();
  const vtkIdType coarse = chain.hierarchy->GetOutput()->GetNumberOfPoints();
  const vtkIdType middle =
    vtkPolyData::SafeDownCast(chain.hierarchy->GetOutputDataObject(1))->GetNumberOfPoints();
  EXPECT_LE(coarse, middle);
  EXPECT_LE(middle, input->GetNumberOfPoints());
  EXPECT_LT(coarse, 400);
  const Mesh mesh = readMesh(chain.hierarchy->GetOutput());
  EXPECT_EQ(validate(mesh), "");
  EXPECT_EQ(summarizeTopology(mesh).eulerCharacteristic, 0);
}

TEST(StageFilters, CostsOfTheDecimationGiveOtherLevelsAndTheSameOnesAgain)
{
  Chain chain(test::toPolyData(test::torus(80, 40)));
  std::vector<std::vector<Vector3>> levels;
  for (const int cost : { vtkDecimationHierarchy::COST_GAUSSIAN,
         vtkDecimationHierarchy::COST_GAUSSIAN_MEMORY, vtkDecimationHierarchy::COST_QUADRIC,
         vtkDecimationHierarchy::COST_UNIFORM, vtkDecimationHierarchy::COST_GAUSSIAN })
  {
    chain.hierarchy->SetCoarseVertices(200);
    chain.hierarchy->SetDecimationCost(cost);
    chain.upmap->Update();
    ASSERT_EQ(chain.upmap->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << chain.upmap->GetOutcomeText();
    levels.push_back(pointsOf(vtkPolyData::SafeDownCast(chain.hierarchy->GetOutputDataObject(0))));
  }
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      EXPECT_NE(levels[i], levels[j]) << i << " and " << j;
    }
  }
  EXPECT_EQ(levels.front(), levels.back());
}

TEST(StageFilters, AnEdgeLengthOfTheMapsOwnGivesQuadsOfThatSize)
{
  Chain chain(test::toPolyData(test::torus(80, 40)));
  chain.hierarchy->Update();
  vtkDataArray* target = chain.hierarchy->GetOutput()->GetFieldData()->GetArray("TargetEdgeLength");
  ASSERT_NE(target, nullptr);
  for (const double factor : { 1.0, 1.5 })
  {
    chain.map->SetEdgeLength(factor * target->GetTuple1(0));
    chain.extraction->Update();
    ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << chain.extraction->GetOutcomeText();
    const double quads = static_cast<double>(chain.extraction->GetOutput()->GetNumberOfCells());
    EXPECT_NEAR(quads * factor * factor / 500, 1, 0.15);
  }
}

TEST(StageFilters, LogOfAnotherSurfaceIsRefused)
{
  Chain chain(test::toPolyData(test::torus(80, 40)));
  chain.map->Update();
  const test::Messages messages(chain.upmap);
  chain.upmap->SetInputData(1, test::toPolyData(test::torus(80, 40, 1, 0.3)));
  chain.upmap->Update();
  EXPECT_EQ(chain.upmap->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_EQ(chain.upmap->GetOutput()->GetNumberOfCells(), 0);
}

TEST(StageFilters, DamagedLogIsRefused)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(80, 40));
  Chain chain(input);
  chain.map->Update();
  vtkNew<vtkTable> damaged;
  damaged->DeepCopy(chain.hierarchy->GetOutputDataObject(2));
  auto* bytes =
    vtkUnsignedCharArray::SafeDownCast(damaged->GetFieldData()->GetAbstractArray("DecimationLog"));
  ASSERT_NE(bytes, nullptr);
  const vtkIdType middle = bytes->GetNumberOfValues() / 2;
  bytes->SetValue(middle, static_cast<unsigned char>(bytes->GetValue(middle) ^ 0x10));
  const test::Messages messages(chain.upmap);
  chain.upmap->SetInputData(2, damaged);
  chain.upmap->Update();
  EXPECT_EQ(chain.upmap->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_NE(messages.errors, "");
}

TEST(StageFilters, MissingArraysAreNamed)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(20, 10));
  vtkNew<vtkQuadExtraction> extraction;
  const test::Messages messages(extraction);
  extraction->SetInputData(input);
  extraction->Update();
  EXPECT_NE(messages.errors.find("IGM"), std::string::npos);
  vtkNew<vtkIntegerGridMap> map;
  const test::Messages mapMessages(map);
  map->SetInputData(input);
  map->Update();
  EXPECT_NE(mapMessages.errors.find("TargetEdgeLength"), std::string::npos);
}

/// The second output of the one-click filter is as good an input as the chain's, split points or not.
TEST(StageFilters, ExtractionTakesTheMappedSurface)
{
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(test::toPolyData(test::unitCube(10)));
  remesh->SetTargetTypeToNumberOfQuads();
  remesh->SetNumberOfQuads(400);
  for (const bool split : { true, false })
  {
    remesh->SetTextureCoordinates(split);
    vtkNew<vtkQuadExtraction> extraction;
    extraction->SetInputConnection(remesh->GetOutputPort(1));
    extraction->Update();
    ASSERT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
      << extraction->GetOutcomeText();
    EXPECT_EQ(pointsOf(extraction->GetOutput()), pointsOf(remesh->GetOutput()));
    EXPECT_EQ(extraction->GetLines()->GetNumberOfLines(), remesh->GetLines()->GetNumberOfLines());
  }
}

double worstScaledJacobian(vtkPolyData* quads)
{
  const std::vector<Vector3> points = pointsOf(quads);
  double worst = 1;
  vtkNew<vtkIdList> ids;
  for (vtkIdType q = 0; q < quads->GetNumberOfCells(); ++q)
  {
    quads->GetCellPoints(q, ids);
    std::array<Vector3, 4> corners;
    for (vtkIdType i = 0; i < 4; ++i)
    {
      corners[static_cast<std::size_t>(i)] = points[static_cast<std::size_t>(ids->GetId(i))];
    }
    worst = std::min(worst, scaledJacobian(corners));
  }
  return worst;
}

/// Smoothing moves points only, and no quad gets worse than the worst one was; both filters have it.
TEST(StageFilters, SmoothingIsAChoice)
{
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(test::toPolyData(test::sphere(4)));
  remesh->SetTargetTypeToNumberOfQuads();
  remesh->SetNumberOfQuads(100);
  remesh->SetSmoothingSteps(0);
  remesh->Update();
  ASSERT_EQ(remesh->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << remesh->GetOutcomeText();
  const vtkSmartPointer<vtkPolyData> plain = vtkSmartPointer<vtkPolyData>::New();
  plain->DeepCopy(remesh->GetOutput());
  vtkNew<vtkQuadExtraction> extraction;
  extraction->SetInputConnection(remesh->GetOutputPort(1));
  extraction->SetSmoothingSteps(0);
  extraction->Update();
  EXPECT_EQ(pointsOf(extraction->GetOutput()), pointsOf(plain));

  remesh->SetSmoothingSteps(5);
  remesh->Update();
  vtkPolyData* smooth = remesh->GetOutput();
  ASSERT_EQ(smooth->GetNumberOfPoints(), plain->GetNumberOfPoints());
  EXPECT_NE(pointsOf(smooth), pointsOf(plain));
  EXPECT_GE(worstScaledJacobian(smooth), worstScaledJacobian(plain));
  vtkNew<vtkIdList> before;
  vtkNew<vtkIdList> after;
  for (vtkIdType q = 0; q < plain->GetNumberOfCells(); ++q)
  {
    plain->GetCellPoints(q, before);
    smooth->GetCellPoints(q, after);
    for (vtkIdType i = 0; i < 4; ++i)
    {
      ASSERT_EQ(before->GetId(i), after->GetId(i));
    }
  }
  extraction->SetSmoothingSteps(5);
  extraction->Update();
  EXPECT_EQ(pointsOf(extraction->GetOutput()), pointsOf(smooth));

  const test::Messages messages(extraction);
  extraction->SetSmoothingSteps(-1);
  extraction->Update();
  EXPECT_EQ(extraction->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

/// Where a loop is too short for three quads, the first filter makes them smaller there, as the one click does, and
/// tells the same.
TEST(StageFilters, ChainMakesQuadsSmallerAtShortLoops)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::parametricGrid(160, 50, true,
    [](double u, double v)
    {
      const double tube = 0.215 - 0.185 * std::cos(2 * test::kPi * u);
      const double r = 1 + tube * std::cos(2 * test::kPi * v);
      return Vector3(r * std::cos(2 * test::kPi * u), r * std::sin(2 * test::kPi * u),
        tube * std::sin(2 * test::kPi * v));
    }));
  Chain chain(input);
  chain.extraction->Update();
  ASSERT_EQ(chain.extraction->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded)
    << chain.hierarchy->GetOutcomeText() << chain.map->GetOutcomeText()
    << chain.upmap->GetOutcomeText() << chain.extraction->GetOutcomeText();
  const std::string told = chain.hierarchy->GetNoticesText();
  EXPECT_NE(told.find("made smaller round"), std::string::npos) << told;
  const vtkSmartPointer<vtkQuadRemesh> oneClick = inOneClick(input);
  EXPECT_EQ(pointsOf(chain.extraction->GetOutput()), pointsOf(oneClick->GetOutput()));
  EXPECT_NE(std::string(oneClick->GetNoticesText()).find(told), std::string::npos)
    << oneClick->GetNoticesText();
}

} // namespace
} // namespace quadrille
