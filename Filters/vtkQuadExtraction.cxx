// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadExtraction.h"

#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Common/VtkVersions.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "Convert/Quads.h"
#include "Extraction/Extraction.h"
#include "Mesh/FlatSources.h"
#include "Mesh/NearestTriangle.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/StageRecords.h"
#include "Stages/MappedInput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

vtkStandardNewMacro(vtkQuadExtraction);

namespace
{

using quadrille::Index;
using quadrille::PointOrigin;
using Weights = std::array<double, 3>;

/// Points of the mapped surface itself: corners of its cells, all triangles, before the seams were welded. Several
/// threads may ask.
PointOrigin carrierPoint(vtkPolyData* data, Index face, const Weights& weights)
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  vtkNew<vtkIdList> copy;
  quadrille::getCorners(data->GetPolys(), face, count, ids, copy);
  return { { ids[0], ids[1], ids[2] }, weights };
}

/// The user's triangles under faces of a mapped surface that come from several.
struct FlatTriangles
{
  vtkIdTypeArray* cells = nullptr;
  vtkIdTypeArray* points = nullptr;
  std::unique_ptr<quadrille::NearestTriangle> tree;

  explicit FlatTriangles(vtkPolyData* data)
  {
    vtkFieldData* arrays = data->GetFieldData();
    cells = vtkIdTypeArray::SafeDownCast(arrays->GetArray(quadrille::arrays::kFlatCellId));
    points = vtkIdTypeArray::SafeDownCast(arrays->GetArray(quadrille::arrays::kFlatPointIds));
    vtkDataArray* places = arrays->GetArray(quadrille::arrays::kFlatPoints);
    if (!cells || !points || !places || points->GetNumberOfComponents() != 3 ||
      places->GetNumberOfComponents() != 9 ||
      points->GetNumberOfTuples() != cells->GetNumberOfTuples() ||
      places->GetNumberOfTuples() != cells->GetNumberOfTuples() || cells->GetNumberOfTuples() == 0)
    {
      return;
    }
    quadrille::TriangleList triangles;
    for (vtkIdType t = 0; t < cells->GetNumberOfTuples(); ++t)
    {
      const auto first = static_cast<Index>(triangles.points.size());
      for (int k = 0; k < 9; k += 3)
      {
        triangles.points.emplace_back(places->GetComponent(t, k), places->GetComponent(t, k + 1),
          places->GetComponent(t, k + 2));
      }
      triangles.corners.push_back({ first, first + 1, first + 2 });
    }
    tree = std::make_unique<quadrille::NearestTriangle>(std::move(triangles));
  }
};

/// Where a mapped surface came from, as far as it tells.
struct Ancestry
{
  vtkIdTypeArray* cells = nullptr;  ///< SourceCellId
  vtkIdTypeArray* points = nullptr; ///< SourcePointIds
  vtkDataArray* weights = nullptr;  ///< SourceWeights

  explicit Ancestry(vtkPolyData* data)
  {
    vtkCellData* arrays = data->GetCellData();
    cells = vtkIdTypeArray::SafeDownCast(arrays->GetArray(quadrille::arrays::kSourceCellId));
    points = vtkIdTypeArray::SafeDownCast(arrays->GetArray(quadrille::arrays::kSourcePointIds));
    weights = arrays->GetArray(quadrille::arrays::kSourceWeights);
    if (!cells || !points || points->GetNumberOfComponents() != 3)
    {
      cells = points = nullptr;
    }
    if (weights && weights->GetNumberOfComponents() != 9)
    {
      weights = nullptr;
    }
  }

  PointOrigin point(Index face, const Weights& inFace) const
  {
    PointOrigin origin;
    points->GetTypedTuple(face, origin.ids.data());
    origin.weights = inFace;
    if (weights)
    {
      double corner[9];
      weights->GetTuple(face, corner);
      for (int j = 0; j < 3; ++j)
      {
        origin.weights[j] =
          inFace[0] * corner[j] + inFace[1] * corner[3 + j] + inFace[2] * corner[6 + j];
      }
    }
    return origin;
  }
};

/// Points of quads in faces that come from several of the user's triangles, as weights below zero tell, are looked up
/// in these.
void findOnFlatTriangles(
  vtkPolyData* data, const quadrille::QuadMesh& quads, quadrille::QuadSource& source)
{
  const Ancestry ancestry(data);
  const FlatTriangles flat(data);
  if (!ancestry.cells || !ancestry.weights || !flat.tree)
  {
    return;
  }
  const auto isOver = [&](Index face)
  {
    double corner[9];
    ancestry.weights->GetTuple(face, corner);
    return std::any_of(
      corner, corner + 9, [](double weight) { return weight < -quadrille::kRounding; });
  };
  const auto placeIn = [&](Index face, const Weights& weights)
  {
    vtkNew<vtkIdList> copy;
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    quadrille::getCorners(data->GetPolys(), face, count, ids, copy);
    quadrille::Vector3 place = quadrille::Vector3::Zero();
    for (int k = 0; k < 3; ++k)
    {
      place += weights[static_cast<std::size_t>(k)] * quadrille::Vector3(data->GetPoint(ids[k]));
    }
    return flat.tree->at(place);
  };
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    const Index face = quads.sourceFace[p];
    source.sourceOrigins.push_back(ancestry.point(face, quads.sourceWeights[p]));
    source.pointCells.push_back(ancestry.cells->GetValue(face));
    if (!isOver(face))
    {
      continue;
    }
    const auto at = placeIn(face, quads.sourceWeights[p]);
    PointOrigin& origin = source.sourceOrigins.back();
    flat.points->GetTypedTuple(at->triangle, origin.ids.data());
    origin.weights = quadrille::withoutRounding(at->weights);
    source.pointCells.back() = flat.cells->GetValue(at->triangle);
  }
}

quadrille::QuadSource sourceOfMapped(vtkPolyData* data, const std::string& patchArray)
{
  quadrille::QuadSource source;
  source.carrier = data;
  source.patchArray = data->GetCellData()->HasArray(patchArray.c_str()) ? patchArray : "";
  source.carrierPoint = [data](Index face, const Weights& weights)
  { return carrierPoint(data, face, weights); };
  source.carrierCell = [](Index face) { return static_cast<vtkIdType>(face); };
  const Ancestry ancestry(data);
  if (ancestry.cells)
  {
    source.sourcePoint = [ancestry](Index face, const Weights& weights)
    { return ancestry.point(face, weights); };
    source.sourceCell = [ancestry](Index face) { return ancestry.cells->GetValue(face); };
  }
  return source;
}

/// What of a free boundary and of features the quads do not show, as notices.
std::vector<std::string> boundaryNotices(
  const quadrille::ExtractionResult& result, const quadrille::Mesh& mesh)
{
  std::vector<std::string> notices;
  if (const std::string ends = result.features.text(mesh); !ends.empty())
  {
    notices.push_back("features: " + ends + "; the quads follow them up to the last whole edge");
  }
  if (result.loopsInCells > 0)
  {
    notices.push_back(std::to_string(result.loopsInCells) +
      " holes are smaller than a quad and lie inside of one; make smaller quads to show them");
  }
  return notices;
}

/// NonIntegerFeatureEnds, NonIntegerFeatureEndPlaces (3 a tuple), LoopsInCells, SeparatedFans and PartialCells.
void addBoundaryReport(
  vtkDataObject* data, const quadrille::ExtractionResult& result, const quadrille::Mesh& mesh)
{
  quadrille::addCount(data, "NonIntegerFeatureEnds", result.features.nonInteger.size());
  vtkNew<vtkDoubleArray> places;
  places->SetName("NonIntegerFeatureEndPlaces");
  places->SetNumberOfComponents(3);
  for (const Index v : result.features.nonInteger)
  {
    places->InsertNextTuple(mesh.position[v].data());
  }
  data->GetFieldData()->RemoveArray(places->GetName());
  data->GetFieldData()->AddArray(places);
  quadrille::addCount(data, "LoopsInCells", result.loopsInCells);
  quadrille::addCount(data, "SeparatedFans", result.separatedFans);
  quadrille::addCount(data, "PartialCells", result.mesh.polygonSourceFace.size());
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadExtraction::vtkQuadExtraction()
{
  this->SetNumberOfOutputPorts(3);
}

vtkQuadExtraction::~vtkQuadExtraction() = default;

//------------------------------------------------------------------------------
void vtkQuadExtraction::SetPatchArrayName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->PatchArrayName)
  {
    this->PatchArrayName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadExtraction::GetLines()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadExtraction::GetSeparatrices()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(2));
}

//------------------------------------------------------------------------------
void vtkQuadExtraction::Execute(quadrille::Block& block)
{
  if (this->MaximumNumberOfQuads < 1)
  {
    throw quadrille::InvalidInput("MaximumNumberOfQuads must be at least 1");
  }
  if (this->SmoothingSteps < 0)
  {
    throw quadrille::InvalidInput("SmoothingSteps must be at least 0");
  }
  vtkPolyData* input = block.input();
  if (quadrille::readMethod(input) == quadrille::MapMethod::Seamless)
  {
    throw quadrille::InvalidInput(
      "the map was made by the method 'seamless', which has no integers, so there are no "
      "quads: choose another method where the map is made");
  }
  if (!(this->TextureScale > 0 && std::isfinite(this->TextureScale)))
  {
    throw quadrille::InvalidInput("TextureScale must be above 0 and finite");
  }
  quadrille::StageLaps laps;
  const quadrille::MappedInput mapped =
    quadrille::readMappedInput(input, this->TextureScale, this->NumberOfThreads);
  const quadrille::Mesh& mesh = mapped.mesh;
  const quadrille::Frame& frame = mapped.frame;
  const quadrille::PlaceScope places(frame.centre, frame.unit, frame.sign);
  std::vector<quadrille::FixedVec2> uvInFrame = mapped.map.uv;
  if (frame.reversed)
  {
    quadrille::reverseMap(uvInFrame);
  }
  laps.lap("read", mesh.faceCount(), mesh.faceCount());
  if (const std::string notice = mapped.notice(); !notice.empty())
  {
    this->AddNotice(notice);
  }
  quadrille::ExtractionOptions options;
  options.maximumNumberOfQuads = static_cast<std::size_t>(this->MaximumNumberOfQuads);
  options.boundary = static_cast<quadrille::BoundaryMode>(this->BoundaryMode);
  options.smoothingSteps = this->SmoothingSteps;
  options.threads = this->NumberOfThreads;
  options.fixedVertices = quadrille::requestedVertices(input, mesh);
  options.guides = quadrille::readSmoothingGuides(input, mesh, frame);
  options.progress = this->MakeProgress(0.0, 0.95);
  quadrille::ExtractionResult result =
    quadrille::extractQuads(mapped.meshInFrame(), uvInFrame, options);
  laps.lap("extract", mesh.faceCount(), result.mesh.quads.size());
  this->SetStageRecords(laps.records.all());
  quadrille::requireOk(result.status, "the extraction of quads");
  quadrille::leaveFrame(result.mesh, mapped.meshInFrame(), frame, mesh.position);
  for (const std::string& notice : boundaryNotices(result, mapped.meshInFrame()))
  {
    this->AddNotice(notice);
  }

  quadrille::QuadSource source = sourceOfMapped(input, this->PatchArrayName);
  source.cellDataFrom = static_cast<quadrille::CellDataFrom>(this->CellDataFrom);
  source.threads = this->NumberOfThreads;
  findOnFlatTriangles(input, result.mesh, source);
  const quadrille::QuadOutputs written =
    quadrille::writeOutputs(result.mesh, mesh, mapped.map.uv, source);
  for (const std::string& notice : written.notCarried)
  {
    this->AddNotice(notice);
  }
  vtkPolyData* quads = block.output(0);
  quads->ShallowCopy(written.quads);
  for (const char* ofMappedSurface : { quadrille::arrays::kFrame, quadrille::arrays::kSmoothedCells,
         quadrille::arrays::kSmoothedAlong })
  {
    quads->GetFieldData()->RemoveArray(ofMappedSurface);
  }
  quadrille::addFields(quads, quadrille::stageFields(laps.records.all()));
  quadrille::addMapReport(quads, mapped);
  addBoundaryReport(quads, result, mesh);
  quadrille::addText(quads, "Notices", this->GetBlockNotices());
  quadrille::addFields(quads, quadrille::extractionFields(result));
  quadrille::addCount(quads, "ActualQuads", result.mesh.quads.size());
  this->SetResult(std::to_string(result.mesh.quads.size()) + " quads, " +
    std::to_string(written.irregular->GetNumberOfPoints()) + " irregular vertices");
  block.output(1)->ShallowCopy(written.lines);
  block.output(2)->ShallowCopy(written.separatrices);
}

//------------------------------------------------------------------------------
void vtkQuadExtraction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumNumberOfQuads: " << this->MaximumNumberOfQuads << "\n";
  os << indent << "SmoothingSteps: " << this->SmoothingSteps << "\n";
  os << indent << "BoundaryMode: " << this->BoundaryMode << "\n";
  os << indent << "TextureScale: " << this->TextureScale << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
  os << indent << "CellDataFrom: " << this->CellDataFrom << "\n";
}
