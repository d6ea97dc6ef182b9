// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadCADProjection.h"

#include "Cad/PlacedQuads.h"
#include "Common/NewArray.h"
#include "Files/CadData.h"
#include "Files/CadNames.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkQuadCADProjection);

namespace
{

using quadrille::CadPlace;
using quadrille::CadPlaceKind;
using quadrille::Vector3;

constexpr const char* kWithoutNode = "CadVerticesWithoutNode";

std::vector<Vector3> pointsOf(vtkPointSet* data)
{
  std::vector<Vector3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    data->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  return points;
}

/// The four corners of each quad, which come first in elements of second order.
std::vector<std::array<quadrille::Index, 4>> cornersOf(vtkPointSet* data)
{
  std::vector<std::array<quadrille::Index, 4>> quads;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    data->GetCellPoints(c, ids);
    if (ids->GetNumberOfIds() == 4 || ids->GetNumberOfIds() == 8 || ids->GetNumberOfIds() == 9)
    {
      auto& quad = quads.emplace_back();
      for (std::size_t i = 0; i < 4; ++i)
      {
        quad[i] = static_cast<quadrille::Index>(ids->GetId(static_cast<vtkIdType>(i)));
      }
    }
  }
  return quads;
}

/// Of each point a face of the part that it is of: that of one of its cells; empty where these do not know it.
std::vector<quadrille::Index> facesOf(vtkPointSet* data)
{
  const auto* ids =
    vtkIntArray::SafeDownCast(data->GetCellData()->GetArray(quadrille::arrays::kCadFaceId));
  if (!ids)
  {
    return {};
  }
  std::vector<quadrille::Index> faces(
    static_cast<std::size_t>(data->GetNumberOfPoints()), quadrille::kInvalidIndex);
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    data->GetCellPoints(c, points);
    for (const vtkIdType point : *points)
    {
      faces[static_cast<std::size_t>(point)] = static_cast<quadrille::Index>(ids->GetValue(c));
    }
  }
  return faces;
}

bool isFirstOrder(vtkPointSet* data)
{
  return data->GetMaxCellSize() <= 4;
}

void writePlaces(const std::vector<CadPlace>& places, vtkPointSet* output)
{
  const std::size_t count = places.size();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  const auto kinds =
    quadrille::newArray<vtkUnsignedCharArray>(quadrille::arrays::kCadPlace, 1, count);
  const auto ids = quadrille::newArray<vtkIntArray>(quadrille::arrays::kCadId, 1, count);
  const auto normals = quadrille::newArray<vtkDoubleArray>("CadNormal", 3, count);
  const auto curvatures = quadrille::newArray<vtkDoubleArray>("CadCurvature", 2, count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    const CadPlace& place = places[i];
    points->SetPoint(id, place.point.data());
    kinds->SetValue(id, static_cast<unsigned char>(place.kind));
    ids->SetValue(id, place.kind == CadPlaceKind::None ? -1 : static_cast<int>(place.id));
    normals->SetTuple(id, place.normal.data());
    curvatures->SetTuple(id, place.curvatures.data());
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(kinds);
  output->GetPointData()->AddArray(ids);
  output->GetPointData()->AddArray(normals);
  output->GetPointData()->AddArray(curvatures);
}

/// place: of the first one.
std::string noticeOfCorners(vtkIdType count, const std::string& place)
{
  if (count == 0)
  {
    return "";
  }
  std::ostringstream text;
  text << count << (count == 1 ? " corner" : " corners")
       << " of CAD edges longer than two edge lengths " << (count == 1 ? "has" : "have")
       << " no node, " << (count == 1 ? "that" : "the first") << " at " << place
       << ": quads of this size have no room for it, smaller ones there have";
  return text.str();
}

enum CadProblem
{
  kCornerWithoutNode,
  kNodeStays
};

void addProblem(const Vector3& place, CadProblem problem, vtkPolyData* problems)
{
  const vtkIdType point = problems->GetPoints()->InsertNextPoint(place.data());
  problems->GetVerts()->InsertNextCell(1, &point);
  vtkIntArray::SafeDownCast(problems->GetCellData()->GetScalars())->InsertNextValue(problem);
}

void addProblems(const quadrille::PlacedQuads& placed, vtkPolyData* problems)
{
  for (const Vector3& place : placed.verticesWithoutAt)
  {
    addProblem(place, kCornerWithoutNode, problems);
  }
  for (const CadPlace& place : placed.places)
  {
    if (place.kind == CadPlaceKind::None)
    {
      addProblem(place.point, kNodeStays, problems);
    }
  }
}

/// With nothing in it yet.
void beginProblems(vtkPolyData* problems)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  problems->SetPoints(points);
  problems->SetVerts(vtkNew<vtkCellArray>());
  problems->GetCellData()->SetScalars(quadrille::newArray<vtkIntArray>("CadProblem"));
}

void addCount(const char* name, vtkIdType count, vtkFieldData* fields)
{
  const auto array = quadrille::newArray<vtkIdTypeArray>(name, 1, 1);
  array->SetValue(0, count);
  fields->AddArray(array);
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadCADProjection::vtkQuadCADProjection()
{
  this->SetNumberOfOutputPorts(2);
}

vtkQuadCADProjection::~vtkQuadCADProjection() = default;

//------------------------------------------------------------------------------
int vtkQuadCADProjection::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadCADProjection::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadCADProjection::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  if (input && (!output || !output->IsA(input->GetClassName())))
  {
    outputs->GetInformationObject(0)->Set(
      vtkDataObject::DATA_OBJECT(), vtk::TakeSmartPointer(input->NewInstance()));
  }
  if (!vtkPolyData::GetData(outputs, 1))
  {
    outputs->GetInformationObject(1)->Set(vtkDataObject::DATA_OBJECT(), vtkNew<vtkPolyData>());
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkQuadCADProjection::Project(
  vtkPointSet* input, const std::string& name, vtkPointSet* output, vtkPolyData* problems)
{
  output->ShallowCopy(input);
  const quadrille::CadSource source = quadrille::cadSource(input->GetFieldData());
  quadrille::PlacementOptions options;
  options.reach = this->Reach;
  options.tangentEdges = source.tangentEdges;
  const quadrille::PlacedQuads placed = quadrille::placeQuads(source.shape, source.options,
    { pointsOf(input), cornersOf(input), isFirstOrder(input), facesOf(input) }, options);
  const std::vector<CadPlace>& places = placed.places;
  writePlaces(places, output);
  addProblems(placed, problems);
  const vtkIdType off = std::count_if(places.begin(), places.end(),
    [](const CadPlace& place) { return place.kind == CadPlaceKind::None; });
  const vtkIdType on = static_cast<vtkIdType>(places.size()) - off;
  this->NodesOnGeometry += on;
  this->NodesOffGeometry += off;
  if (!placed.verticesWithout.empty())
  {
    if (this->CornersWithoutNode == 0)
    {
      const Vector3& at = placed.verticesWithoutAt.front();
      std::ostringstream place;
      place << "(" << at.x() << ", " << at.y() << ", " << at.z() << ")"
            << (name.empty() ? "" : " of " + name);
      this->FirstCornerWithout = place.str();
    }
    this->CornersWithoutNode += static_cast<vtkIdType>(placed.verticesWithout.size());
  }
  vtkNew<vtkFieldData> fields; // of its own, whatever a shallow copy shares
  fields->ShallowCopy(input->GetFieldData());
  addCount("NodesOnGeometry", on, fields);
  addCount("NodesOffGeometry", off, fields);
  fields->RemoveArray(kWithoutNode);
  if (const std::size_t without = placed.verticesWithout.size(); without > 0)
  {
    const auto vertices = quadrille::newArray<vtkIntArray>(kWithoutNode, 1, without);
    std::copy(
      placed.verticesWithout.begin(), placed.verticesWithout.end(), vertices->GetPointer(0));
    fields->AddArray(vertices);
  }
  output->SetFieldData(fields);
}

//------------------------------------------------------------------------------
void vtkQuadCADProjection::Execute(
  vtkDataObject* input, vtkDataObject* output, vtkPolyData* problems)
{
  output->ShallowCopy(input);
  auto* quads = vtkPointSet::SafeDownCast(input);
  if (quads && quads->GetNumberOfPoints() > 0) // a rank may have none
  {
    this->Project(quads, "", vtkPointSet::SafeDownCast(output), problems);
  }
  if (quads)
  {
    return;
  }
  auto* results = vtkCompositeDataSet::SafeDownCast(output);
  const auto at = vtk::TakeSmartPointer(vtkCompositeDataSet::SafeDownCast(input)->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    auto* leaf = vtkPointSet::SafeDownCast(at->GetCurrentDataObject());
    if (leaf && leaf->GetNumberOfPoints() > 0)
    {
      const char* name = at->HasCurrentMetaData()
        ? at->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
        : nullptr;
      const auto placed = vtk::TakeSmartPointer(leaf->NewInstance());
      this->Project(leaf, name ? name : "", placed, problems);
      results->SetDataSet(at, placed);
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadCADProjection::SetTexts()
{
  const vtkIdType on = this->NodesOnGeometry, off = this->NodesOffGeometry;
  std::ostringstream text;
  if (off == 0)
  {
    text << "All " << on << " nodes lie on the exact shape";
  }
  else
  {
    text << off << " of " << on + off << " nodes " << (off == 1 ? "stays" : "stay")
         << " on the triangles, as no place of the exact shape is near, or a quad would be turned "
            "over there";
  }
  this->NoticesText = noticeOfCorners(this->CornersWithoutNode, this->FirstCornerWithout);
  this->Verdict = text.str() + (this->NoticesText.empty() ? "" : "; " + this->NoticesText);
}

//------------------------------------------------------------------------------
int vtkQuadCADProjection::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  this->NoticesText.clear();
  this->NodesOnGeometry = 0;
  this->NodesOffGeometry = 0;
  this->CornersWithoutNode = 0;
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  vtkPolyData* problems = vtkPolyData::GetData(outputs, 1);
  beginProblems(problems);
  try
  {
    this->Execute(vtkDataObject::GetData(inputs[0], 0), output, problems);
    this->SetTexts();
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    this->OutcomeText = "there is not enough memory";
  }
  catch (const std::exception& error)
  {
    this->OutcomeText = error.what();
  }
  this->Verdict = "Failed: " + this->OutcomeText;
  output->Initialize();
  problems->Initialize();
  vtkErrorMacro(<< this->OutcomeText);
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadCADProjection::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Reach: " << this->Reach << "\n";
  os << indent << "NodesOnGeometry: " << this->NodesOnGeometry << "\n";
  os << indent << "NodesOffGeometry: " << this->NodesOffGeometry << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "Verdict: " << this->Verdict << "\n";
}
