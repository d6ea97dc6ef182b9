// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/NamedSizes.h"

#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Convert/AskedArrays.h"
#include "Convert/PolyData.h"
#include "ElementGrids/Elements.h"
#include "Files/CadNames.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVariant.h>

#include <algorithm>
#include <limits>

namespace quadrille
{

namespace
{

std::vector<std::string> stringsOf(vtkFieldData* data, const char* name)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(name));
  std::vector<std::string> strings;
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    strings.push_back(array->GetValue(i));
  }
  return strings;
}

std::vector<Vector3> vectorsOf(vtkDataArray* array)
{
  std::vector<Vector3> vectors(array ? static_cast<std::size_t>(array->GetNumberOfTuples()) : 0);
  for (std::size_t i = 0; i < vectors.size(); ++i)
  {
    array->GetTuple(static_cast<vtkIdType>(i), vectors[i].data());
  }
  return vectors;
}

void readTriangles(vtkPolyData* data, NamedSurface& surface)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    data->GetCellPoints(c, ids);
    refuseIf(data->GetNumberOfPolys() != data->GetNumberOfCells() || ids->GetNumberOfIds() != 3,
      "sizes by name are for surfaces of triangles, and cell ", c,
      " is none: triangulate it first");
    std::array<Index, 3>& corners = surface.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
    {
      corners[k] = static_cast<Index>(ids->GetId(static_cast<vtkIdType>(k)));
    }
  }
}

void readKnownOfTriangles(vtkCellData* cells, NamedSurface& surface)
{
  surface.faceNames = stringsOf(cells, arrays::kPatchNames);
  vtkDataArray* const bits = cells->GetArray(arrays::kFeatureEdges);
  vtkDataArray* const curvatures = cells->GetArray(arrays::kKnownCurvature);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    const auto cell = static_cast<vtkIdType>(t);
    if (bits)
    {
      surface.featureEdges.push_back(static_cast<std::uint8_t>(bits->GetComponent(cell, 0)));
    }
    if (curvatures)
    {
      std::array<float, 6>& known = surface.knownCurvature.emplace_back();
      for (std::size_t k = 0; k < known.size(); ++k)
      {
        known[k] = static_cast<float>(curvatures->GetComponent(cell, static_cast<int>(k)));
      }
    }
  }
}

void readNamedEdges(vtkFieldData* fields, NamedSurface& surface)
{
  const std::vector<Vector3> points = vectorsOf(fields->GetArray(arrays::kCadEdgePoints));
  vtkDataArray* const counts = fields->GetArray(arrays::kCadEdgeCounts);
  surface.edgeNames = stringsOf(fields, arrays::kCadEdgeNames);
  surface.edgeLines.resize(surface.edgeNames.size());
  std::size_t at = 0;
  for (std::size_t e = 0; counts && e < surface.edgeLines.size(); ++e)
  {
    const auto count = static_cast<std::size_t>(counts->GetComponent(static_cast<vtkIdType>(e), 0));
    refuseIf(count > points.size() - at, "the surface has fewer points in ", arrays::kCadEdgePoints,
      " than ", arrays::kCadEdgeCounts, " tells: read the CAD file again");
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(at);
    surface.edgeLines[e].assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    at += count;
  }
  surface.vertexNames = stringsOf(fields, arrays::kCadVertexNames);
  surface.vertexPoints = vectorsOf(fields->GetArray(arrays::kCadVertexPoints));
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  surface.vertexPoints.resize(surface.vertexNames.size(), Vector3::Constant(kNowhere));
}

/// Real numbers in the middle of two points are their average, all else is that of one of them; nobody asks for a
/// valence there.
void extend(vtkAbstractArray* array, const std::vector<std::array<Index, 2>>& middles)
{
  vtkIdType point = array->GetNumberOfTuples();
  array->Resize(point + static_cast<vtkIdType>(middles.size()));
  const bool isReal = array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
  const bool isValence =
    array->GetName() && std::string(array->GetName()) == arrays::kTargetValence;
  for (const auto& [a, b] : middles)
  {
    if (isReal)
    {
      array->InterpolateTuple(point, a, array, b, array, 0.5);
    }
    else
    {
      array->InsertTuple(point, a, array);
    }
    if (isValence)
    {
      array->SetVariantValue(point, 0);
    }
    ++point;
  }
}

void addCellArrays(const SizedTriangles& triangles, vtkCellData* from, vtkCellData* to)
{
  const std::size_t count = triangles.triangles.size();
  to->CopyAllOn();
  to->CopyGlobalIdsOff(); // several triangles have one
  to->CopyAllocate(from, static_cast<vtkIdType>(count));
  for (std::size_t t = 0; t < count; ++t)
  {
    to->CopyData(from, triangles.parents[t], static_cast<vtkIdType>(t));
  }
  if (!triangles.featureEdges.empty())
  {
    const auto bits = newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, count);
    std::copy(triangles.featureEdges.begin(), triangles.featureEdges.end(), bits->GetPointer(0));
    to->AddArray(bits);
  }
  if (!triangles.knownCurvature.empty())
  {
    const auto known = newArray<vtkFloatArray>(arrays::kKnownCurvature, 6, count);
    for (std::size_t t = 0; t < count; ++t)
    {
      known->SetTypedTuple(static_cast<vtkIdType>(t), triangles.knownCurvature[t].data());
    }
    to->AddArray(known);
  }
}

} // namespace

NamedSurface namedSurface(vtkPolyData* data)
{
  NamedSurface surface;
  surface.points = vectorsOf(data->GetPoints() ? data->GetPoints()->GetData() : nullptr);
  readTriangles(data, surface);
  readKnownOfTriangles(data->GetCellData(), surface);
  surface.sizes = pointSizes(data);
  readNamedEdges(data->GetFieldData(), surface);
  return surface;
}

vtkSmartPointer<vtkPolyData> sizedPolyData(const SizedTriangles& triangles, vtkPolyData* data)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(triangles.points.size()));
  for (std::size_t i = 0; i < triangles.points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), triangles.points[i].data());
  }
  result->SetPoints(points);
  vtkPointData* const pointData = result->GetPointData();
  pointData->DeepCopy(data->GetPointData());
  for (int i = 0; i < pointData->GetNumberOfArrays(); ++i)
  {
    extend(pointData->GetAbstractArray(i), triangles.middles);
  }
  vtkNew<vtkCellArray> cells;
  for (const std::array<Index, 3>& corners : triangles.triangles)
  {
    const std::array<vtkIdType, 3> ids{ corners[0], corners[1], corners[2] };
    cells->InsertNextCell(3, ids.data());
  }
  result->SetPolys(cells);
  addCellArrays(triangles, data->GetCellData(), result->GetCellData());
  const auto sizing = newArray<vtkFloatArray>(arrays::kSizing, 1, triangles.sizes.size());
  std::copy(triangles.sizes.begin(), triangles.sizes.end(), sizing->GetPointer(0));
  pointData->AddArray(sizing);
  result->GetFieldData()->ShallowCopy(data->GetFieldData());
  return result;
}

} // namespace quadrille
