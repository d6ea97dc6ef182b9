// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/CadData.h"

#include "Base/Refuse.h"
#include "Cad/Calls.h"
#include "Common/NewArray.h"
#include "Convert/PolyData.h"
#include "ElementGrids/Elements.h"
#include "Files/CadNames.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace quadrille
{

namespace
{

vtkSmartPointer<vtkPoints> pointsOf(const std::vector<Vector3>& from)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(from.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), from[i].data());
  }
  return points;
}

void addCellArrays(const CadPart& part, CadFollow follow, vtkPolyData* data)
{
  const CadSurface& surface = part.surface;
  const std::size_t count = surface.triangles.size();
  const auto faces = newArray<vtkIntArray>(arrays::kCadFaceId, 1, count);
  const auto names = newArray<vtkStringArray>(arrays::kPatchNames, 1, count);
  const auto features = newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, count);
  const auto colours = newArray<vtkUnsignedCharArray>("CadColour", 3, count);
  const auto curvatures = newArray<vtkFloatArray>(arrays::kKnownCurvature, 6, count);
  const CadCells cells = cadCells(surface, follow);
  bool hasColours = false;
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto cell = static_cast<vtkIdType>(t);
    const Index face = surface.faceOf[t];
    faces->SetValue(cell, static_cast<int>(face));
    names->SetValue(cell, nameOfFace(part, face));
    features->SetValue(cell, cells.features[t]);
    curvatures->SetTypedTuple(cell, cells.curvatures[t].data());
    constexpr std::array<double, 3> kGrey{ 0.8, 0.8, 0.8 };
    const std::array<double, 3> colour = part.faceColours[face].value_or(kGrey);
    hasColours = hasColours || part.faceColours[face].has_value();
    for (int k = 0; k < 3; ++k)
    {
      const double value = std::round(255 * colour[static_cast<std::size_t>(k)]);
      colours->SetTypedComponent(cell, k, static_cast<unsigned char>(value));
    }
  }
  vtkCellData* ofCells = data->GetCellData();
  ofCells->AddArray(faces);
  ofCells->AddArray(names);
  ofCells->AddArray(features);
  ofCells->AddArray(curvatures);
  if (hasColours)
  {
    ofCells->AddArray(colours);
  }
}

vtkSmartPointer<vtkStringArray> stringArray(
  const char* name, const std::vector<std::string>& values)
{
  auto array = newArray<vtkStringArray>(name, 1, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  }
  return array;
}

vtkSmartPointer<vtkDoubleArray> vectorArray(const char* name, const std::vector<Vector3>& values)
{
  auto array = newArray<vtkDoubleArray>(name, 3, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetTuple(static_cast<vtkIdType>(i), values[i].data());
  }
  return array;
}

/// Names of edges and vertices, and where these are, see CadNames.h.
void addNames(const CadPart& part, vtkFieldData* fields)
{
  const CadLines lines = cadLines(part.surface);
  const auto vertexPoints = vectorArray(arrays::kCadVertexPoints, lines.vertexPoints);
  const auto points = vectorArray(arrays::kCadEdgePoints, lines.points);
  const std::size_t edges = lines.counts.size();
  const auto ends = newArray<vtkIntArray>(arrays::kCadEdgeEnds, 2, edges);
  const auto counts = newArray<vtkIntArray>(arrays::kCadEdgeCounts, 1, edges);
  for (std::size_t e = 0; e < edges; ++e)
  {
    ends->SetTypedTuple(static_cast<vtkIdType>(e), lines.ends[e].data());
    counts->SetValue(static_cast<vtkIdType>(e), lines.counts[e]);
  }
  const auto edgeNames = stringArray(arrays::kCadEdgeNames, part.edgeNames);
  const auto vertexNames = stringArray(arrays::kCadVertexNames, part.vertexNames);
  for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{
         edgeNames, vertexNames, ends, counts, points, vertexPoints })
  {
    fields->AddArray(array);
  }
}

void addFieldArrays(const CadPart& part, const std::string& unit,
  const TessellationOptions& options, CadFollow follow, vtkFieldData* fields)
{
  const std::vector<std::uint8_t> bytes = cadCalls().bytesOfShape(part.shape);
  const auto shape = newArray<vtkUnsignedCharArray>(arrays::kCadShape, 1, bytes.size());
  std::copy(bytes.begin(), bytes.end(), shape->GetPointer(0));
  const auto tessellation = newArray<vtkDoubleArray>(arrays::kCadTessellation, 1, 4);
  tessellation->SetValue(0, options.chordError);
  tessellation->SetValue(1, options.angle);
  tessellation->SetValue(2, options.sharpAngle);
  tessellation->SetValue(3, follow == CadFollow::All ? 1 : 0);
  const std::size_t faces = part.surface.surfaceKinds.size();
  const auto names = newArray<vtkStringArray>("CadFaceNames", 1, faces);
  const auto kinds = newArray<vtkStringArray>("CadSurfaceKinds", 1, faces);
  for (std::size_t f = 0; f < faces; ++f)
  {
    names->SetValue(static_cast<vtkIdType>(f), nameOfFace(part, f));
    kinds->SetValue(static_cast<vtkIdType>(f), wordOf(part.surface.surfaceKinds[f]));
  }
  addNames(part, fields);
  const auto unitOfFile = newArray<vtkStringArray>("CadUnitOfFile", 1, 1);
  unitOfFile->SetValue(0, unit);
  for (vtkAbstractArray* array :
    std::initializer_list<vtkAbstractArray*>{ shape, tessellation, names, kinds, unitOfFile })
  {
    fields->AddArray(array);
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> cadPolyData(const CadPart& part, const std::string& unit,
  const TessellationOptions& options, CadFollow follow)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(pointsOf(part.surface.points));
  vtkNew<vtkCellArray> triangles;
  for (const std::array<Index, 3>& c : part.surface.triangles)
  {
    const std::array<vtkIdType, 3> ids{ c[0], c[1], c[2] };
    triangles->InsertNextCell(3, ids.data());
  }
  data->SetPolys(triangles);
  addCellArrays(part, follow, data);
  addFieldArrays(part, unit, options, follow, data->GetFieldData());
  return data;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> cadEdges(const std::vector<CadPart>& parts)
{
  std::vector<Vector3> points;
  vtkNew<vtkCellArray> lines;
  const auto numbers = newArray<vtkIntArray>("CadPart");
  const auto ids = newArray<vtkIntArray>("CadEdgeId");
  const auto kinds = newArray<vtkStringArray>("CadEdgeKind");
  const auto angles = newArray<vtkDoubleArray>("CadEdgeAngle");
  const auto names = newArray<vtkStringArray>("CadEdgeName");
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const CadSurface& surface = parts[p].surface;
    const std::size_t first = points.size();
    points.insert(points.end(), surface.points.begin(), surface.points.end());
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
    {
      const CadEdge& edge = surface.edges[e];
      if (edge.points.size() < 2)
      {
        continue;
      }
      lines->InsertNextCell(static_cast<int>(edge.points.size()));
      for (const Index point : edge.points)
      {
        lines->InsertCellPoint(static_cast<vtkIdType>(first + point));
      }
      numbers->InsertNextValue(static_cast<int>(p));
      ids->InsertNextValue(static_cast<int>(e));
      kinds->InsertNextValue(wordOf(edge.kind));
      angles->InsertNextValue(vtkMath::DegreesFromRadians(edge.angle));
      names->InsertNextValue(parts[p].edgeNames[e]);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(pointsOf(points));
  data->SetLines(lines);
  for (vtkAbstractArray* array :
    std::initializer_list<vtkAbstractArray*>{ numbers, ids, kinds, angles, names })
  {
    data->GetCellData()->AddArray(array);
  }
  return data;
}

//------------------------------------------------------------------------------
CadSource cadSource(vtkFieldData* fields)
{
  auto* shape = vtkUnsignedCharArray::SafeDownCast(fields->GetAbstractArray(arrays::kCadShape));
  vtkDataArray* options = fields->GetArray(arrays::kCadTessellation);
  refuseIf(!shape || !options || options->GetNumberOfTuples() != 4, "the field data have no ",
    arrays::kCadShape, " with ", arrays::kCadTessellation,
    ": take quads that were made on a surface from the CAD reader");
  CadSource source;
  const unsigned char* bytes = shape->GetPointer(0);
  source.shape =
    cadCalls().shapeOfBytes(std::vector<std::uint8_t>(bytes, bytes + shape->GetNumberOfValues()));
  source.options.chordError = options->GetTuple1(0);
  source.options.angle = options->GetTuple1(1);
  source.options.sharpAngle = options->GetTuple1(2);
  source.tangentEdges = options->GetTuple1(3) != 0;
  return source;
}

} // namespace quadrille
