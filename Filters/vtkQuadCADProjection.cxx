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

#include <array>
#include <exception>
#include <new>
#include <vector>

vtkStandardNewMacro(vtkQuadCADProjection);

namespace
{

using quadrille::CadPlace;
using quadrille::CadPlaceKind;
using quadrille::Vector3;

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
  const std::vector<CadPlace> places = quadrille::placeQuads(source.shape, source.options,
    { pointsOf(input), cornersOf(input), isFirstOrder(input) }, options);
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
  output->SetFieldData(fields);
}

//------------------------------------------------------------------------------
int vtkQuadCADProjection::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
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
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
}
