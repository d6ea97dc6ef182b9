// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleQuads.h"

#include "QuadrilleConvert.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

template <class Array>
vtkSmartPointer<Array> newArray(const char* name, int components, std::size_t tuples)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  return array;
}

vtkSmartPointer<vtkPoints> newPoints(std::size_t count)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  return points;
}

/// Cells of `corners` points each.
vtkSmartPointer<vtkCellArray> newCells(vtkIdTypeArray* connectivity, vtkIdType corners)
{
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(connectivity->GetNumberOfValues() / corners + 1);
  for (vtkIdType i = 0; i < offsets->GetNumberOfValues(); ++i)
  {
    offsets->SetValue(i, corners * i);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

void writeGeometry(const QuadMesh& mesh, vtkPolyData* data)
{
  vtkSmartPointer<vtkPoints> points = newPoints(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[i].data());
  }
  auto connectivity = newArray<vtkIdTypeArray>("", 1, 4 * mesh.quads.size());
  vtkIdType next = 0;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (const Index corner : quad)
    {
      connectivity->SetValue(next++, corner);
    }
  }
  data->SetPoints(points);
  data->SetPolys(newCells(connectivity, 4));
}

void addPointArrays(const QuadMesh& mesh, const QuadSource& source, vtkPointData* data)
{
  const std::size_t count = mesh.points.size();
  auto valence = newArray<vtkIntArray>(arrays::kValence, 1, count);
  auto boundary = newArray<vtkUnsignedCharArray>("OnBoundary", 1, count);
  auto cell = newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, count);
  auto ids = newArray<vtkIdTypeArray>(arrays::kSourcePointIds, 3, count);
  auto weights = newArray<vtkDoubleArray>(arrays::kSourceBarycentric, 3, count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    const PointOrigin origin = source.sourcePoint(mesh.sourceFace[i], mesh.sourceWeights[i]);
    valence->SetValue(id, mesh.valence[i]);
    boundary->SetValue(id, mesh.onBoundary[i]);
    cell->SetValue(id, source.sourceCell(mesh.sourceFace[i]));
    ids->SetTypedTuple(id, origin.ids.data());
    weights->SetTypedTuple(id, origin.weights.data());
  }
  data->AddArray(cell);
  data->AddArray(ids);
  data->AddArray(weights);
  data->AddArray(boundary);
  data->AddArray(valence);
  if (!data->GetScalars())
  {
    data->SetActiveScalars(arrays::kValence);
  }
}

void addSourceCells(const QuadMesh& mesh, const QuadSource& source, vtkCellData* data)
{
  auto cell = newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, mesh.quads.size());
  for (std::size_t i = 0; i < mesh.quads.size(); ++i)
  {
    cell->SetValue(static_cast<vtkIdType>(i), source.sourceCell(mesh.quadSourceFace[i]));
  }
  data->AddArray(cell);
}

using Edge = std::pair<Index, Index>;

Edge sortedEdge(Index a, Index b)
{
  return { std::min(a, b), std::max(a, b) };
}

void addFeatureEdges(const QuadMesh& mesh, vtkCellData* data)
{
  std::vector<Edge> features;
  for (const QuadLine& line : mesh.lines)
  {
    if (!line.boundary)
    {
      features.push_back(sortedEdge(line.a, line.b));
    }
  }
  std::sort(features.begin(), features.end());
  auto array = newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, mesh.quads.size());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
  {
    int bits = 0;
    for (int i = 0; i < 4; ++i)
    {
      const Edge edge = sortedEdge(mesh.quads[q][i], mesh.quads[q][(i + 1) % 4]);
      bits |= std::binary_search(features.begin(), features.end(), edge) ? 1 << i : 0;
    }
    array->SetValue(static_cast<vtkIdType>(q), static_cast<unsigned char>(bits));
  }
  data->AddArray(array);
}

/// Only the points that lines use, in the order of their first use.
void writeLineGeometry(const QuadMesh& mesh, vtkPolyData* data)
{
  std::vector<Index> lineId(mesh.points.size(), kInvalidIndex);
  std::vector<Index> used;
  auto connectivity = newArray<vtkIdTypeArray>("", 1, 2 * mesh.lines.size());
  vtkIdType next = 0;
  for (const QuadLine& line : mesh.lines)
  {
    for (const Index end : { line.a, line.b })
    {
      if (lineId[end] == kInvalidIndex)
      {
        lineId[end] = static_cast<Index>(used.size());
        used.push_back(end);
      }
      connectivity->SetValue(next++, lineId[end]);
    }
  }
  vtkSmartPointer<vtkPoints> points = newPoints(used.size());
  auto quadPoint = newArray<vtkIdTypeArray>("QuadPointId", 1, used.size());
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[used[i]].data());
    quadPoint->SetValue(static_cast<vtkIdType>(i), used[i]);
  }
  data->SetPoints(points);
  data->SetLines(newCells(connectivity, 2));
  data->GetPointData()->AddArray(quadPoint);
}

void addPatchPairs(
  const QuadMesh& mesh, const Mesh& mapped, const QuadSource& source, vtkCellData* data)
{
  vtkDataArray* patches = source.patchArray.empty()
    ? nullptr
    : source.carrier->GetCellData()->GetArray(source.patchArray.c_str());
  if (!patches)
  {
    return;
  }
  const auto patchOf = [&](Index h)
  { return patches->GetVariantValue(source.carrierCell(Mesh::face(h))).ToLongLong(); };
  auto pairs = newArray<vtkLongLongArray>("PatchIds", 2, mesh.lines.size());
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
  {
    const Index h = mesh.lines[i].halfEdge;
    const long long left = patchOf(h);
    const long long right = mapped.isBoundary(h) ? left : patchOf(mapped.twin[h]);
    pairs->SetValue(static_cast<vtkIdType>(2 * i), std::min(left, right));
    pairs->SetValue(static_cast<vtkIdType>(2 * i + 1), std::max(left, right));
  }
  data->AddArray(pairs);
}

} // namespace

PointOrigin pointOrigin(const PreparedSurface& surface, const ConvertedSurface& converted,
  vtkPolyData* data, Index face, const std::array<double, 3>& weights)
{
  const SourceLocation at = surface.locate(face, weights);
  PointOrigin origin{ { at.points[0], at.points[1], at.points[2] }, at.weights };
  if (const auto corners = converted.triangle(data, at.polygon))
  {
    // Repair may have turned the triangle round or started it at another corner.
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Index id = (*corners)[i];
      const auto found = std::find(at.points.begin(), at.points.end(), id);
      if (found == at.points.end())
      {
        return { { at.points[0], at.points[1], at.points[2] }, at.weights };
      }
      origin.ids[i] = id;
      origin.weights[i] = at.weights[static_cast<std::size_t>(found - at.points.begin())];
    }
  }
  return origin;
}

vtkSmartPointer<vtkPolyData> writeQuads(const QuadMesh& mesh, const QuadSource& source)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  writeGeometry(mesh, data);
  carryPointArrays(source.carrier->GetPointData(), data->GetPointData(), data->GetNumberOfPoints(),
    [&](vtkIdType i)
    {
      const auto p = static_cast<std::size_t>(i);
      return source.carrierPoint(mesh.sourceFace[p], mesh.sourceWeights[p]);
    });
  carryCellArrays(source.carrier->GetCellData(), data->GetCellData(), data->GetNumberOfCells(),
    [&](vtkIdType q)
    { return source.carrierCell(mesh.quadSourceFace[static_cast<std::size_t>(q)]); });
  addPointArrays(mesh, source, data->GetPointData());
  addSourceCells(mesh, source, data->GetCellData());
  addFeatureEdges(mesh, data->GetCellData());
  return data;
}

vtkSmartPointer<vtkPolyData> writeLines(
  const QuadMesh& mesh, const Mesh& mapped, const QuadSource& source)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  writeLineGeometry(mesh, data);
  auto boundary = newArray<vtkUnsignedCharArray>("Boundary", 1, mesh.lines.size());
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
  {
    boundary->SetValue(static_cast<vtkIdType>(i), mesh.lines[i].boundary ? 1 : 0);
  }
  data->GetCellData()->AddArray(boundary);
  addPatchPairs(mesh, mapped, source, data->GetCellData());
  return data;
}

} // namespace quadrille
