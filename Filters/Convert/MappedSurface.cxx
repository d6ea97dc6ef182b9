// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Base/Types.h"
#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/MeshArrays.h"
#include "Convert/Tuples.h"
#include "Mesh/FlatSources.h"
#include "Mesh/Topology.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace quadrille
{

namespace
{

/// Below this a coordinate on the 2^-24 grid fits the 53 bits of a double.
constexpr std::int64_t kLargestExact = std::int64_t{ 1 } << (28 + kFractionBits);

/// Corner ids with a point of its own for each image of a vertex; pointVertex says whose image it is.
std::vector<Index> splitCorners(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, std::vector<Index>& pointVertex)
{
  struct Image
  {
    FixedVec2 uv;
    Index next;
  };
  std::vector<Image> images;
  std::vector<Index> first(mesh.vertexCount(), kInvalidIndex);
  std::vector<Index> corners(mesh.halfEdgeCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index v = mesh.origin[h];
    Index i = first[v];
    while (i != kInvalidIndex && images[i].uv != uv[h])
    {
      i = images[i].next;
    }
    if (i == kInvalidIndex)
    {
      i = static_cast<Index>(images.size());
      images.push_back({ uv[h], first[v] });
      pointVertex.push_back(v);
      first[v] = i;
    }
    corners[h] = i;
  }
  return corners;
}

void addTextureCoordinates(
  vtkPolyData* data, const std::vector<Index>& corners, const std::vector<FixedVec2>& uv)
{
  auto array = newArray<vtkFloatArray>(
    arrays::kTextureCoordinates, 2, static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t h = 0; h < corners.size(); ++h)
  {
    array->SetValue(2 * corners[h], static_cast<float>(toDouble(uv[h].u)));
    array->SetValue(2 * corners[h] + 1, static_cast<float>(toDouble(uv[h].v)));
  }
  data->GetPointData()->SetTCoords(array);
}

/// Cell arrays, where they are there.
void shareArrays(vtkPolyData* from, std::initializer_list<const char*> names, vtkPolyData* to)
{
  for (const char* name : names)
  {
    if (vtkAbstractArray* array = from->GetCellData()->GetAbstractArray(name))
    {
      to->GetCellData()->AddArray(array);
    }
  }
}

void addSourceArrays(
  vtkPolyData* data, const PreparedSurface& surface, const ConvertedSurface& converted, int threads)
{
  const std::size_t faces = surface.mesh.faceCount();
  auto cells = newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, faces);
  auto points = newArray<vtkIdTypeArray>(arrays::kSourcePointIds, 3, faces);
  vtkIdType* cell = cells->GetPointer(0);
  vtkIdType* point = points->GetPointer(0);
  forEachIndex(faces, threads,
    [&](std::size_t f)
    {
      cell[f] = converted.cell(surface.sourcePolygon[f]);
      std::copy(surface.sourcePoints[f].begin(), surface.sourcePoints[f].end(), point + 3 * f);
    });
  data->GetCellData()->AddArray(cells);
  data->GetCellData()->AddArray(points);
  if (surface.refinedEntry.empty())
  {
    return;
  }
  auto weights = newArray<vtkDoubleArray>(arrays::kSourceWeights, 9, faces);
  double* weight = weights->GetPointer(0);
  forEachIndex(faces, threads,
    [&](std::size_t f)
    {
      const Index entry = surface.refinedEntry[f];
      for (std::size_t i = 0; i < 9; ++i)
      {
        weight[9 * f + i] =
          entry == kInvalidIndex ? double(i % 4 == 0) : surface.cornerWeights[entry][i / 3][i % 3];
      }
    });
  data->GetCellData()->AddArray(weights);
}

/// The user's triangles under faces that come from several: their cells, their points, and where these are.
void addFlatTriangles(vtkPolyData* data, const PreparedSurface& surface,
  const ConvertedSurface& converted, vtkPolyData* source)
{
  if (!surface.beforeFlips)
  {
    return;
  }
  const std::vector<FlatSources::Triangle> triangles = surface.beforeFlips->triangles();
  auto cells = newArray<vtkIdTypeArray>(arrays::kFlatCellId, 1, triangles.size());
  auto ids = newArray<vtkIdTypeArray>(arrays::kFlatPointIds, 3, triangles.size());
  auto points = newArray<vtkDoubleArray>(arrays::kFlatPoints, 9, triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const auto row = static_cast<vtkIdType>(t);
    cells->SetValue(row, converted.cell(triangles[t].polygon));
    for (int k = 0; k < 3; ++k)
    {
      const auto id = static_cast<vtkIdType>(triangles[t].points[static_cast<std::size_t>(k)]);
      ids->SetTypedComponent(row, k, id);
      source->GetPoint(id, points->GetPointer(9 * row + 3 * k));
    }
  }
  data->GetFieldData()->AddArray(cells);
  data->GetFieldData()->AddArray(ids);
  data->GetFieldData()->AddArray(points);
}

std::vector<std::string> carryPointsToSurface(vtkPolyData* data, const PreparedSurface& surface,
  vtkPolyData* source, const std::vector<Index>& pointVertex, int threads)
{
  const std::vector<Index> outgoing = outgoingHalfEdges(surface.mesh);
  std::vector<PointOrigin> points(pointVertex.size());
  forEachIndex(points.size(), threads,
    [&](std::size_t i)
    {
      const Index h = outgoing[pointVertex[i]];
      const SourceLocation at = surface.locate(Mesh::face(h), cornerWeight(h));
      points[i] = { { at.points[0], at.points[1], at.points[2] }, at.weights };
    });
  return carryPointArrays(
    source->GetPointData(), source->GetNumberOfPoints(), data->GetPointData(), points, threads);
}

std::vector<std::string> carryCellsToSurface(vtkPolyData* data, const PreparedSurface& surface,
  vtkPolyData* source, const ConvertedSurface& converted, int threads)
{
  std::vector<vtkIdType> cells(surface.sourcePolygon.size());
  forEachIndex(cells.size(), threads,
    [&](std::size_t f) { cells[f] = converted.cell(surface.sourcePolygon[f]); });
  return carryCellArrays(
    source->GetCellData(), source->GetNumberOfCells(), data->GetCellData(), cells, threads);
}

/// Returns what could not be carried. Memory for where things come from is taken only where there is something to
/// carry.
std::vector<std::string> carryToSurface(vtkPolyData* data, const PreparedSurface& surface,
  vtkPolyData* source, const ConvertedSurface& converted, const std::vector<Index>& pointVertex,
  int threads)
{
  std::vector<std::string> notCarried;
  if (source->GetPointData()->GetNumberOfArrays() > 0)
  {
    notCarried = carryPointsToSurface(data, surface, source, pointVertex, threads);
  }
  if (source->GetCellData()->GetNumberOfArrays() > 0)
  {
    const std::vector<std::string> ofCells =
      carryCellsToSurface(data, surface, source, converted, threads);
    notCarried.insert(notCarried.end(), ofCells.begin(), ofCells.end());
  }
  return notCarried;
}

} // namespace

//------------------------------------------------------------------------------
void addMap(vtkPolyData* data, const std::vector<FixedVec2>& uv, int threads)
{
  const std::size_t faces = uv.size() / 3;
  auto igm = newArray<vtkDoubleArray>(arrays::kIgm, 6, faces);
  auto determinants = newArray<vtkDoubleArray>(arrays::kDeterminant, 1, faces);
  double* value = igm->GetPointer(0);
  const std::size_t refused = firstRefused(uv.size(), kLightChunk, threads,
    [&](std::size_t h)
    {
      value[2 * h] = toDouble(uv[h].u);
      value[2 * h + 1] = toDouble(uv[h].v);
      return std::abs(uv[h].u) < kLargestExact && std::abs(uv[h].v) < kLargestExact;
    });
  if (refused < uv.size())
  {
    refuse("the map of face ", refused / 3, " reaches ", toDouble(uv[refused].u), ", ",
      toDouble(uv[refused].v), ", beyond what can be written exactly");
  }
  const double unit = 1.0 / (static_cast<double>(kOne) * static_cast<double>(kOne));
  double* area = determinants->GetPointer(0);
  forEachIndex(faces, threads,
    [&](std::size_t f)
    {
      const Int128 d = determinant(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]);
      area[f] = static_cast<double>(d) * unit;
    });
  data->GetCellData()->AddArray(igm);
  data->GetCellData()->AddArray(determinants);
}

//------------------------------------------------------------------------------
std::vector<FixedVec2> readMap(vtkPolyData* data, int threads)
{
  vtkDataArray* array = requireArray(data->GetCellData(), arrays::kIgm, 6,
    "vtkIntegerGridMap, vtkIntegerGridMapUpmap or vtkQuadRemesh");
  const double limit = toDouble(kLargestExact);
  auto* doubles = vtkDoubleArray::SafeDownCast(array);
  const double* values = doubles ? doubles->GetPointer(0) : nullptr;
  const auto corner = [&](std::size_t h)
  {
    const auto f = static_cast<vtkIdType>(h / 3);
    const int first = static_cast<int>(2 * (h % 3));
    return values ? Vector2(values[2 * h], values[2 * h + 1])
                  : Vector2(array->GetComponent(f, first), array->GetComponent(f, first + 1));
  };
  std::vector<FixedVec2> uv(3 * static_cast<std::size_t>(array->GetNumberOfTuples()));
  const std::size_t refused = firstRefused(uv.size(), kLightChunk, threads,
    [&](std::size_t h)
    {
      const Vector2 p = corner(h);
      // Written so that NaN is refused as well.
      if (!(std::abs(p.x()) < limit && std::abs(p.y()) < limit))
      {
        return false;
      }
      uv[h] = toFixed(p);
      return true;
    });
  if (refused < uv.size())
  {
    const Vector2 p = corner(refused);
    refuse(
      "array ", arrays::kIgm, " has the corner (", p.x(), ", ", p.y(), ") in cell ", refused / 3);
  }
  return uv;
}

//------------------------------------------------------------------------------
void addMatching(vtkPolyData* data, const std::vector<std::int8_t>& matching)
{
  auto array = newArray<vtkSignedCharArray>(arrays::kMatching, 3, matching.size() / 3);
  std::copy(matching.begin(), matching.end(), array->GetPointer(0));
  data->GetCellData()->AddArray(array);
}

//------------------------------------------------------------------------------
void addTurns(vtkPolyData* data, const Mesh& mesh, const std::vector<int>& turns)
{
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  auto turnArray = newArray<vtkIntArray>(arrays::kTurns, 1, turns.size());
  auto indexArray = newArray<vtkIntArray>(arrays::kIndex, 1, turns.size());
  for (std::size_t v = 0; v < turns.size(); ++v)
  {
    const bool boundary = outgoing[v] == kInvalidIndex || mesh.isBoundary(outgoing[v]);
    turnArray->SetValue(static_cast<vtkIdType>(v), turns[v]);
    indexArray->SetValue(static_cast<vtkIdType>(v), (boundary ? 2 : 4) - turns[v]);
  }
  data->GetPointData()->AddArray(turnArray);
  data->GetPointData()->AddArray(indexArray);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> writeMappedSurface(const PreparedSurface& surface,
  const std::vector<FixedVec2>& uv, const std::vector<std::int8_t>& matching,
  const std::vector<int>& turns, vtkPolyData* source, const ConvertedSurface& converted,
  bool splitSeams, int threads, std::vector<std::string>* notCarried, vtkPolyData* earlier)
{
  const Mesh& mesh = surface.mesh;
  auto data = vtkSmartPointer<vtkPolyData>::New();
  std::vector<Index> pointVertex, corners;
  if (splitSeams)
  {
    corners = splitCorners(mesh, uv, pointVertex);
  }
  else
  {
    pointVertex = identity(mesh.vertexCount());
  }
  data->SetPoints(writePoints(mesh, pointVertex, threads));
  data->SetPolys(writeTriangles(splitSeams ? corners : mesh.origin.vector(), threads));
  std::vector<std::string> left =
    carryToSurface(data, surface, source, converted, pointVertex, threads);
  if (notCarried)
  {
    *notCarried = std::move(left);
  }
  if (earlier)
  {
    shareArrays(
      earlier, { arrays::kSourceCellId, arrays::kSourcePointIds, arrays::kSourceWeights }, data);
    addFeatureEdges(data, mesh, threads);
    shareArrays(earlier, { arrays::kTwin }, data);
  }
  else
  {
    addSourceArrays(data, surface, converted, threads);
    addFlatTriangles(data, surface, converted, source);
    addFeatureEdges(data, mesh, threads);
    addTwinsWhereNeeded(data, mesh, threads);
  }
  addMap(data, uv, threads);
  addMatching(data, matching);
  // One value a vertex becomes one a point: addTurns works on vertices, so spread it afterwards.
  vtkNew<vtkPolyData> perVertex;
  addTurns(perVertex, mesh, turns);
  for (const char* name : { arrays::kTurns, arrays::kIndex })
  {
    const int* from =
      vtkIntArray::SafeDownCast(perVertex->GetPointData()->GetArray(name))->GetPointer(0);
    auto array = newArray<vtkIntArray>(name, 1, pointVertex.size());
    int* to = array->GetPointer(0);
    forEachIndex(pointVertex.size(), threads, [&](std::size_t i) { to[i] = from[pointVertex[i]]; });
    data->GetPointData()->AddArray(array);
  }
  if (splitSeams)
  {
    data->GetPointData()->AddArray(writeIds(arrays::kSurfacePointId, pointVertex, threads));
    addTextureCoordinates(data, corners, uv);
  }
  return data;
}

} // namespace quadrille
