// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadCADProjection.h"

#include "Cad/PlacedQuads.h"
#include "Common/NewArray.h"
#include "Files/CadData.h"
#include "Files/CadNames.h"

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

std::string noticeOfVertices(const quadrille::PlacedQuads& placed)
{
  const std::size_t count = placed.verticesWithout.size();
  if (count == 0)
  {
    return "";
  }
  const Vector3& at = placed.verticesWithoutAt.front();
  std::ostringstream text;
  text << count << (count == 1 ? " corner" : " corners")
       << " of CAD edges longer than two edge lengths " << (count == 1 ? "has" : "have")
       << " no node, " << (count == 1 ? "that" : "the first") << " at (" << at.x() << ", " << at.y()
       << ", " << at.z() << "): quads of this size have no room for it, smaller ones there have";
  return text.str();
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadCADProjection::vtkQuadCADProjection() = default;
vtkQuadCADProjection::~vtkQuadCADProjection() = default;

//------------------------------------------------------------------------------
int vtkQuadCADProjection::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

//------------------------------------------------------------------------------
void vtkQuadCADProjection::Project(vtkPointSet* input, vtkPointSet* output)
{
  output->ShallowCopy(input);
  const quadrille::CadSource source = quadrille::cadSource(input->GetFieldData());
  quadrille::PlacementOptions options;
  options.reach = this->Reach;
  options.tangentEdges = source.tangentEdges;
  const quadrille::PlacedQuads placed = quadrille::placeQuads(source.shape, source.options,
    { pointsOf(input), cornersOf(input), isFirstOrder(input) }, options);
  const std::vector<CadPlace>& places = placed.places;
  this->NoticesText = noticeOfVertices(placed);
  writePlaces(places, output);
  this->NodesOnGeometry = 0;
  for (const CadPlace& place : places)
  {
    this->NodesOnGeometry += place.kind == CadPlaceKind::None ? 0 : 1;
  }
  this->NodesOffGeometry = static_cast<vtkIdType>(places.size()) - this->NodesOnGeometry;
  vtkNew<vtkFieldData> fields; // of its own, whatever a shallow copy shares
  fields->ShallowCopy(input->GetFieldData());
  const auto on = quadrille::newArray<vtkIdTypeArray>("NodesOnGeometry", 1, 1);
  const auto off = quadrille::newArray<vtkIdTypeArray>("NodesOffGeometry", 1, 1);
  on->SetValue(0, this->NodesOnGeometry);
  off->SetValue(0, this->NodesOffGeometry);
  fields->AddArray(on);
  fields->AddArray(off);
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
int vtkQuadCADProjection::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  this->NoticesText.clear();
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  try
  {
    this->Project(vtkPointSet::GetData(inputs[0], 0), output);
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
  output->Initialize();
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
}
