// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Stages/MappedInput.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/Frame.h"
#include "Convert/MeshArrays.h"
#include "Convert/PolyData.h"
#include "ForeignMaps/MapWelding.h"
#include "Stages/SharedLevels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace quadrille
{

namespace
{

bool isReal(vtkDataArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

/// Half a unit in the last place of the largest value where they are single precision.
double errorOf(vtkDataArray* array, const std::vector<Vector2>& uv)
{
  if (array->GetDataType() != VTK_FLOAT)
  {
    return 0;
  }
  double largest = 0;
  for (const Vector2& p : uv)
  {
    largest = std::max(largest, p.lpNorm<Eigen::Infinity>());
  }
  // Values that are not numbers, or far too large, are told by the corner that has them.
  return largest < 1e6 ? std::ldexp(largest, -24) : 0;
}

//------------------------------------------------------------------------------
// The cell array IGM

template <class Array>
bool copyCellMap(vtkDataArray* array, int threads, std::vector<Vector2>& uv)
{
  auto* typed = Array::SafeDownCast(array);
  if (!typed)
  {
    return false;
  }
  const auto* values = typed->GetPointer(0);
  parallelFor(uv.size(), kLightChunk, threads,
    [values, &uv](std::size_t begin, std::size_t end)
    {
      for (std::size_t h = begin; h < end; ++h)
      {
        uv[h] = Vector2(values[2 * h], values[2 * h + 1]);
      }
    });
  return true;
}

std::vector<Vector2> readCellMap(vtkDataArray* array, int threads)
{
  if (array->GetNumberOfComponents() != 6 || !isReal(array))
  {
    refuse("cell array '", arrays::kIgm,
      "' must have 6 real numbers a cell (u and v of its three corners), it has ",
      array->GetNumberOfComponents(), " of type ", array->GetDataTypeAsString());
  }
  std::vector<Vector2> uv(3 * static_cast<std::size_t>(array->GetNumberOfTuples()));
  if (copyCellMap<vtkDoubleArray>(array, threads, uv) ||
    copyCellMap<vtkFloatArray>(array, threads, uv))
  {
    return uv;
  }
  for (std::size_t f = 0; 3 * f < uv.size(); ++f)
  {
    double t[6];
    pollNowAndThen(f);
    array->GetTuple(static_cast<vtkIdType>(f), t);
    for (std::size_t i = 0; i < 3; ++i)
    {
      uv[3 * f + i] = Vector2(t[2 * i], t[2 * i + 1]);
    }
  }
  return uv;
}

//------------------------------------------------------------------------------
// Texture coordinates

vtkDataArray* requireTexture(vtkPolyData* data)
{
  vtkDataArray* array = data->GetPointData()->GetTCoords();
  if (!array)
  {
    refuse("the input has no map: neither the cell array '", arrays::kIgm,
      "' with 6 components (made by Integer Grid Map, Integer Grid Map Upmap or Quad Remesh) nor "
      "active texture coordinates on its points");
  }
  const int components = array->GetNumberOfComponents();
  if (!isReal(array) || components < 2 || components > 3)
  {
    refuse("the texture coordinates '", array->GetName() ? array->GetName() : "",
      "' must be 2 or 3 real numbers a point, they are ", components, " of type ",
      array->GetDataTypeAsString());
  }
  return array;
}

std::vector<Vector2> readTexture(
  vtkDataArray* array, const std::vector<Index>& corners, double scale)
{
  std::vector<Vector2> uv;
  uv.reserve(corners.size());
  for (const Index p : corners)
  {
    pollNowAndThen(uv.size());
    uv.push_back(scale * Vector2(array->GetComponent(p, 0), array->GetComponent(p, 1)));
  }
  return uv;
}

/// Whether two points have the same value in every array.
bool sameData(vtkPointData* arrays, Index p, Index q)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = arrays->GetAbstractArray(i);
    const vtkIdType components = array->GetNumberOfComponents();
    for (vtkIdType k = 0; k < components; ++k)
    {
      if (array->GetVariantValue(components * p + k) != array->GetVariantValue(components * q + k))
      {
        return false;
      }
    }
  }
  return true;
}

/// More of the map's area is turned over than not: an image with its v axis downwards, as a rule.
bool isMirrored(const std::vector<Vector2>& uv)
{
  double area = 0;
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    const Vector2 a = uv[h + 1] - uv[h];
    const Vector2 b = uv[h + 2] - uv[h];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area < 0;
}

Mesh weldTexture(
  vtkPolyData* data, const std::vector<Index>& corners, const std::vector<Vector2>& uv)
{
  MappedTriangles triangles;
  triangles.corners = corners;
  triangles.position = readPointPositions(data);
  triangles.uv = uv;
  triangles.sameData = [data](Index p, Index q) { return sameData(data->GetPointData(), p, q); };
  Mesh mesh = weldMap(triangles);
  readFeatureFlags(data, mesh);
  return mesh;
}

//------------------------------------------------------------------------------

std::vector<std::int8_t> readMatching(vtkPolyData* data, int threads)
{
  std::vector<std::int8_t> matching;
  vtkDataArray* array = data->GetCellData()->GetArray(arrays::kMatching);
  if (!array)
  {
    return matching;
  }
  if (array->GetNumberOfComponents() != 3)
  {
    refuse("cell array '", arrays::kMatching,
      "' must have three whole numbers a cell, the quarter turns over its edges; it has ",
      array->GetNumberOfComponents());
  }
  matching.resize(3 * static_cast<std::size_t>(array->GetNumberOfTuples()));
  const auto turnsAt = [array](std::size_t h)
  { return array->GetComponent(static_cast<vtkIdType>(h / 3), static_cast<int>(h % 3)); };
  const std::size_t refused = firstRefused(matching.size(), kLightChunk, threads,
    [&](std::size_t h)
    {
      const double turns = turnsAt(h);
      if (!(std::abs(turns) < 1e9) || turns != std::round(turns))
      {
        return false;
      }
      matching[h] = static_cast<std::int8_t>(static_cast<long long>(turns) & 3);
      return true;
    });
  if (refused < matching.size())
  {
    refuse("cell array '", arrays::kMatching, "' has ", turnsAt(refused), " over edge ",
      refused % 3, " of cell ", refused / 3, ", which is no number of quarter turns");
  }
  return matching;
}

/// A mesh in a frame that `data` was written from, as readMesh would read it.
Mesh onSurface(const Mesh& inFrame, const Frame& frame, vtkPolyData* data, int threads)
{
  Mesh mesh = inFrame;
  const std::vector<Vector3> points = readPointPositions(data, threads);
  vtkDataArray* split = data->GetPointData()->GetArray(arrays::kSurfacePointId);
  Vector3* const position = mesh.position.edit();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    position[split ? static_cast<std::size_t>(split->GetTuple1(static_cast<vtkIdType>(i))) : i] =
      points[i];
  }
  if (frame.reversed)
  {
    reverseFaces(mesh);
  }
  return mesh;
}

void checkNotEmpty(const Mesh& mesh)
{
  if (mesh.faceCount() == 0)
  {
    refuse("the input has no triangles");
  }
}

} // namespace

//------------------------------------------------------------------------------
MappedInput readMappedInput(vtkPolyData* data, double textureScale, int threads)
{
  MappedInput result;
  if (const auto hash = mappedSurfaceHash(data, threads))
  {
    result.shared = findSharedMap(*hash);
  }
  if (result.shared)
  {
    result.map.uv = readMap(data, threads);
    result.frame = result.shared->frame;
    result.mesh = onSurface(result.meshInFrame(), result.frame, data, threads);
    return result;
  }
  std::vector<Vector2> uv;
  SnapOptions options;
  options.threads = threads;
  options.matching = readMatching(data, threads);
  if (vtkDataArray* igm = data->GetCellData()->GetArray(arrays::kIgm))
  {
    uv = readCellMap(igm, threads);
    options.valueError = errorOf(igm, uv);
    result.mesh = readMesh(data, threads);
    checkNotEmpty(result.mesh);
  }
  else
  {
    vtkDataArray* texture = requireTexture(data);
    const std::vector<Index> corners = readCorners(data, threads);
    uv = readTexture(texture, corners, textureScale);
    result.mirrored = isMirrored(uv);
    for (std::size_t h = 0; result.mirrored && h < uv.size(); ++h)
    {
      uv[h].y() = -uv[h].y();
    }
    for (std::size_t h = 0; result.mirrored && h < options.matching.size(); ++h)
    {
      options.matching[h] = static_cast<std::int8_t>(-options.matching[h] & 3);
    }
    options.valueError = errorOf(texture, uv);
    result.mesh = weldTexture(data, corners, uv);
    checkNotEmpty(result.mesh);
  }
  result.map = snapMap(result.mesh, uv, options);
  result.ownMeshInFrame = result.mesh;
  result.frame = enterFrame(data, result.ownMeshInFrame);
  return result;
}

const Mesh& MappedInput::meshInFrame() const
{
  return shared ? shared->finest->surface.mesh : ownMeshInFrame;
}

std::string MappedInput::notice() const
{
  std::ostringstream text;
  if (mirrored)
  {
    text << "the texture coordinates are mirrored on the surface, v was taken with the other sign";
  }
  if (map.largestMove > 0)
  {
    text << (mirrored ? "; " : "")
         << "the map was not exact and has been rounded: corners moved by up to " << map.largestMove
         << " quads (cell " << map.largestMoveCorner / 3 << "), " << map.snappedToFixedPoint
         << " vertices were put on the fixed point of the turns round them";
  }
  if (map.inconsistent > 0)
  {
    text << (text.tellp() > 0 ? "; " : "") << "at " << map.inconsistent
         << " vertices the translations do not add up to nothing (the first is in cell "
         << map.inconsistentCorner / 3 << "), so there the map is torn";
  }
  return text.str();
}

std::vector<Index> requestedVertices(vtkPolyData* data, const Mesh& mesh)
{
  std::vector<Index> vertices;
  const std::vector<int> valences = readPointValences(data);
  if (valences.empty())
  {
    return vertices;
  }
  const std::vector<Index> corners = readCorners(data);
  for (std::size_t h = 0; h < corners.size(); ++h)
  {
    const int valence = valences[corners[h]];
    if (valence != 0 && valence != kRegularValence)
    {
      vertices.push_back(mesh.origin[h]);
    }
  }
  sortUnique(vertices);
  return vertices;
}

void addSmoothingGuides(const std::vector<FaceGuide>& guides, const Frame& frame, vtkPolyData* data)
{
  if (guides.empty())
  {
    return;
  }
  auto cells = newArray<vtkIdTypeArray>(arrays::kSmoothedCells, 1, guides.size());
  auto along = newArray<vtkDoubleArray>(arrays::kSmoothedAlong, 3, guides.size());
  for (std::size_t i = 0; i < guides.size(); ++i)
  {
    const auto at = static_cast<vtkIdType>(i);
    cells->SetValue(at, guides[i].face);
    along->SetTuple(at, frame.mirrored(guides[i].guide.direction).eval().data());
  }
  data->GetFieldData()->AddArray(cells);
  data->GetFieldData()->AddArray(along);
}

std::vector<FaceGuide> readSmoothingGuides(vtkPolyData* data, const Mesh& mesh, const Frame& frame)
{
  vtkDataArray* cells = data->GetFieldData()->GetArray(arrays::kSmoothedCells);
  vtkDataArray* along = data->GetFieldData()->GetArray(arrays::kSmoothedAlong);
  std::vector<FaceGuide> guides;
  if (cells == nullptr && along == nullptr)
  {
    return guides;
  }
  refuseIf(cells == nullptr || along == nullptr || cells->GetNumberOfComponents() != 1 ||
      along->GetNumberOfComponents() != 3 ||
      cells->GetNumberOfTuples() != along->GetNumberOfTuples(),
    "the field arrays '", arrays::kSmoothedCells, "' and '", arrays::kSmoothedAlong,
    "' do not fit each other: take the output of vtkIntegerGridMapUpmap as it is, or remove both");
  const std::vector<Index> faces = readIds(cells, mesh.faceCount());
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    refuseIf(i > 0 && faces[i] <= faces[i - 1], "the field array '", arrays::kSmoothedCells,
      "' has to ascend, but entry ", i, " does not");
    Vector3 direction;
    along->GetTuple(static_cast<vtkIdType>(i), direction.data());
    guides.push_back({ faces[i], { frame.mirrored(direction), 1 } });
  }
  return guides;
}

void addMapReport(vtkDataObject* data, const MappedInput& input)
{
  addNumber(data, "MapLargestMove", input.map.largestMove);
  addCount(data, "MapFixedPoints", input.map.snappedToFixedPoint);
  addCount(data, "MapInconsistentVertices", input.map.inconsistent);
}

} // namespace quadrille
