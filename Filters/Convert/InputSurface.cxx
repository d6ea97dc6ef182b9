// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Common/VtkVersions.h"
#include "Convert/ArrayNames.h"
#include "Convert/AskedArrays.h"
#include "Convert/MeshArrays.h"
#include "Convert/Tuples.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstdint>

namespace quadrille
{

namespace
{

template <class Id>
void copyOffsets(const Id* offsets, int threads, SurfaceInput& input)
{
  Index* const own = input.polygonOffsets.edit();
  forEachIndex(input.polygonOffsets.size(), threads,
    [&](std::size_t i) { own[i] = static_cast<Index>(offsets[i]); });
}

/// The first place in the connectivity with a point that is not there; the number of places where there is none.
template <class Id>
std::size_t copyPolygonPoints(const Id* ids, vtkIdType points, int threads, SurfaceInput& input)
{
  Index* const own = input.polygonPoints.edit();
  return firstRefused(input.polygonPoints.size(), kLightChunk, threads,
    [&](std::size_t i)
    {
      own[i] = static_cast<Index>(ids[i]);
      return ids[i] >= 0 && ids[i] < points;
    });
}

void readPolygons(vtkPolyData* data, ConvertedSurface& surface, int threads)
{
  SurfaceInput& input = surface.input;
  vtkCellArray* polys = data->GetPolys();
  const vtkIdType points = data->GetNumberOfPoints();
  input.polygonOffsets.assign(static_cast<std::size_t>(polys->GetNumberOfCells()) + 1, 0);
  input.polygonPoints.resize(static_cast<std::size_t>(polys->GetNumberOfConnectivityIds()));
  if (polys->GetNumberOfCells() == 0)
  {
    return;
  }
  withIds(plainIds(polys->GetOffsetsArray()),
    [&](const auto* offsets) { copyOffsets(offsets, threads, input); });
  const std::size_t refused = withIds(plainIds(polys->GetConnectivityArray()),
    [&](const auto* ids) { return copyPolygonPoints(ids, points, threads, input); });
  if (refused < input.polygonPoints.size())
  {
    const auto after =
      std::upper_bound(input.polygonOffsets.begin(), input.polygonOffsets.end(), refused);
    checkPointId(static_cast<vtkIdType>(
                   polys->GetConnectivityArray()->GetComponent(static_cast<vtkIdType>(refused), 0)),
      points, surface.firstCell + (after - input.polygonOffsets.begin()) - 1);
  }
}

/// Triangle i of a strip is (i, i + 1, i + 2), every second one turned round.
void readStrips(vtkPolyData* data, ConvertedSurface& surface)
{
  if (data->GetNumberOfStrips() == 0)
  {
    return;
  }
  SurfaceInput& input = surface.input;
  const vtkIdType polys = data->GetNumberOfPolys();
  for (vtkIdType i = 0; i < polys; ++i)
  {
    surface.cellOfPolygon.push_back(surface.firstCell + i);
  }
  vtkIdType cell = surface.firstCell + polys;
  auto iterator = vtk::TakeSmartPointer(data->GetStrips()->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(count, ids);
    for (vtkIdType i = 0; i + 2 < count; ++i)
    {
      const vtkIdType odd = i & 1;
      for (const vtkIdType id : { ids[i], ids[i + 1 + odd], ids[i + 2 - odd] })
      {
        checkPointId(id, data->GetNumberOfPoints(), cell);
        input.polygonPoints.push_back(static_cast<Index>(id));
      }
      const Index* corner = input.polygonPoints.data() + input.polygonPoints.size() - 3;
      surface.stripTriangles.push_back({ corner[0], corner[1], corner[2] });
      input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
      surface.cellOfPolygon.push_back(cell);
    }
    ++cell;
  }
}

std::size_t polygonCount(const SurfaceInput& input)
{
  return input.polygonOffsets.size() - 1;
}

void readGuides(vtkPolyData* data, ConvertedSurface& surface)
{
  const GuideArrays guides(data);
  if (guides.empty())
  {
    return;
  }
  SurfaceInput& input = surface.input;
  input.guideDirections.resize(polygonCount(input));
  input.guideWeights.resize(guides.hasWeights() ? polygonCount(input) : 0);
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    const vtkIdType cell = surface.cell(static_cast<Index>(i));
    input.guideDirections[i] = guides.direction(cell);
    if (guides.hasWeights() && !input.guideDirections[i].isZero(0))
    {
      input.guideWeights[i] = guides.weight(cell);
    }
  }
}

/// Only the pieces of a spread surface have them, as Filters/Ranks/Spread.h writes them.
void readDetectedFeatures(vtkPolyData* data, ConvertedSurface& surface)
{
  auto* array =
    vtkUnsignedCharArray::SafeDownCast(data->GetCellData()->GetArray(arrays::kDetectedFeatures));
  if (!array)
  {
    return;
  }
  surface.input.detectedFeatures.resize(polygonCount(surface.input));
  for (std::size_t i = 0; i < surface.input.detectedFeatures.size(); ++i)
  {
    surface.input.detectedFeatures[i] = array->GetValue(surface.cell(static_cast<Index>(i)));
  }
}

/// The bits name corners of a polygon, so that they say nothing about a strip.
void readFeatureEdges(vtkPolyData* data, ConvertedSurface& surface, int threads)
{
  vtkDataArray* array = data->GetCellData()->GetArray(arrays::kFeatureEdges);
  if (!array)
  {
    return;
  }
  if (array->GetNumberOfComponents() != 1)
  {
    refuse("cell array ", arrays::kFeatureEdges, " must have one whole number a cell, it has ",
      array->GetNumberOfComponents());
  }
  requireWhole(array, "cell");
  // The type of our own arrays is read without a call for each cell.
  const auto* bytes = array->GetDataType() == VTK_UNSIGNED_CHAR
    ? static_cast<const std::uint8_t*>(array->GetVoidPointer(0))
    : nullptr;
  const auto valueOf = [&](std::size_t i)
  {
    const vtkIdType cell = surface.cell(static_cast<Index>(i));
    return bytes ? static_cast<double>(bytes[cell]) : array->GetComponent(cell, 0);
  };
  std::vector<std::uint8_t>& bits = surface.input.featureEdges;
  bits.resize(polygonCount(surface.input));
  const vtkIdType firstStrip = surface.firstCell + data->GetNumberOfPolys();
  const std::size_t refused = firstRefused(bits.size(), kLightChunk, threads,
    [&](std::size_t i)
    {
      const double value = valueOf(i);
      if (!(value >= 0 && value <= 255))
      {
        return false;
      }
      bits[i] = static_cast<std::uint8_t>(value);
      return bits[i] == 0 || surface.cell(static_cast<Index>(i)) < firstStrip;
    });
  if (refused == bits.size())
  {
    return;
  }
  const vtkIdType cell = surface.cell(static_cast<Index>(refused));
  if (cell >= firstStrip)
  {
    refuse("cell ", cell, " is a triangle strip with ", arrays::kFeatureEdges,
      " set; triangulate it first");
  }
  refuse("cell ", cell, " has ", arrays::kFeatureEdges, " ", valueOf(refused),
    ", but bits of at most 8 edges are read: 0 to 255");
}

/// Polygons of more corners and strips have none.
void readKnownCurvature(vtkPolyData* data, ConvertedSurface& surface)
{
  vtkDataArray* array = data->GetCellData()->GetArray(arrays::kKnownCurvature);
  if (!array)
  {
    return;
  }
  refuseIf(array->GetNumberOfComponents() != 6, "cell array ", arrays::kKnownCurvature,
    " must have six numbers a triangle, it has ", array->GetNumberOfComponents());
  SurfaceInput& input = surface.input;
  const vtkIdType firstStrip = surface.firstCell + data->GetNumberOfPolys();
  input.curvatures.assign(polygonCount(input), kNoCurvature);
  for (std::size_t i = 0; i < input.curvatures.size(); ++i)
  {
    const vtkIdType cell = surface.cell(static_cast<Index>(i));
    for (std::size_t k = 0; k < 3 && cell < firstStrip; ++k)
    {
      const auto at = static_cast<int>(k);
      input.curvatures[i].atCorner[k] = static_cast<float>(array->GetComponent(cell, at));
      input.curvatures[i].alongSide[k] = static_cast<float>(array->GetComponent(cell, 3 + at));
    }
  }
}

template <class Value>
void copyPatchIds(
  const Value* values, const ConvertedSurface& surface, int threads, std::vector<std::int64_t>& ids)
{
  forEachIndex(ids.size(), threads,
    [&](std::size_t i)
    { ids[i] = static_cast<std::int64_t>(values[surface.cell(static_cast<Index>(i))]); });
}

void readPatchIds(
  vtkPolyData* data, const std::string& name, ConvertedSurface& surface, int threads)
{
  if (name.empty() || name == "(none)")
  {
    return;
  }
  vtkDataArray* array = data->GetCellData()->GetArray(name.c_str());
  if (!array)
  {
    if (name != arrays::kPatchId)
    {
      refuse("there is no cell array named '", name, "' with patch ids");
    }
    return;
  }
  if (array->GetNumberOfComponents() != 1)
  {
    refuse("cell array '", name, "' must have one whole number a cell to be used as patch ids");
  }
  requireWhole(array, "cell");
  surface.patchArray = name;
  std::vector<std::int64_t>& ids = surface.input.patchIds;
  ids.resize(polygonCount(surface.input));
  switch (array->GetDataType())
  {
    vtkTemplateMacro(
      copyPatchIds(static_cast<const VTK_TT*>(array->GetVoidPointer(0)), surface, threads, ids));
    default: // bits have no bytes of their own
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        const vtkIdType cell = surface.cell(static_cast<Index>(i));
        ids[i] = static_cast<std::int64_t>(array->GetVariantValue(cell).ToLongLong());
      }
  }
}

/// A finite vector of an array of three numbers.
Vector3 vectorAt(vtkDataArray* array, const char* element, vtkIdType i)
{
  Vector3 d;
  array->GetTuple(i, d.data());
  if (!d.allFinite())
  {
    refuse(element, " ", i, " has a vector in the guiding array '", array->GetName(),
      "' that is not finite; correct it, or set it to zero to ask for nothing there");
  }
  return d;
}

/// The direction that the vectors have in common whatever their signs are; zero where all are.
Vector3 mainDirection(vtkDataArray* array, const Index* begin, const Index* end)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Index* point = begin; point != end; ++point)
  {
    const Vector3 d = vectorAt(array, "point", *point).stableNormalized();
    sum += d * d.transpose();
  }
  return sum.isZero(0)
    ? Vector3(Vector3::Zero())
    : Vector3(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2));
}

} // namespace

//------------------------------------------------------------------------------
std::optional<std::array<Index, 3>> ConvertedSurface::triangle(
  vtkPolyData* surface, Index polygon) const
{
  const vtkIdType polygons = surface->GetNumberOfPolys();
  if (static_cast<vtkIdType>(polygon) >= polygons)
  {
    return stripTriangles[polygon - static_cast<std::size_t>(polygons)];
  }
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  vtkNew<vtkIdList> copy;
  getCorners(surface->GetPolys(), polygon, count, ids, copy);
  if (count != 3)
  {
    return std::nullopt;
  }
  return std::array<Index, 3>{ static_cast<Index>(ids[0]), static_cast<Index>(ids[1]),
    static_cast<Index>(ids[2]) };
}

//------------------------------------------------------------------------------
ConvertedSurface convertSurface(vtkPolyData* data, const std::string& patchArray, int threads)
{
  // Ids of Core are 32 bits wide, and a half-edge is three times a face.
  if (data->GetNumberOfPoints() >= static_cast<vtkIdType>(kInvalidIndex) ||
    data->GetNumberOfCells() >= static_cast<vtkIdType>(kInvalidIndex / 3))
  {
    refuse("the surface has ", data->GetNumberOfPoints(), " points and ", data->GetNumberOfCells(),
      " cells, more than 32-bit ids can name");
  }
  ConvertedSurface surface;
  surface.ignoredCells =
    static_cast<std::size_t>(data->GetNumberOfVerts() + data->GetNumberOfLines());
  surface.firstCell = static_cast<vtkIdType>(surface.ignoredCells);
  surface.input.points = readPointPositions(data, threads);
  readPolygons(data, surface, threads);
  readStrips(data, surface);
  readFeatureEdges(data, surface, threads);
  surface.input.isDesigned = data->GetFieldData()->HasArray(arrays::kCadShape);
  readDetectedFeatures(data, surface);
  readKnownCurvature(data, surface);
  readPatchIds(data, patchArray, surface, threads);
  readGuides(data, surface);
  surface.input.targetValences = readPointValences(data);
  surface.input.sizing = pointSizes(data);
  return surface;
}

//------------------------------------------------------------------------------
void addGuideArray(vtkPolyData* data, const std::string& name, ConvertedSurface& surface)
{
  vtkDataArray* const ofCells = data->GetCellData()->GetArray(name.c_str());
  vtkDataArray* const array = ofCells ? ofCells : data->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    refuse("there is no array named '", name,
      "' on the cells or points of the surface to guide the quads: choose another one, or none");
  }
  if (array->GetNumberOfComponents() != 3)
  {
    refuse("the guiding array '", name, "' must have 3 numbers a cell or point, it has ",
      array->GetNumberOfComponents());
  }
  SurfaceInput& input = surface.input;
  input.guideDirections.resize(polygonCount(input), Vector3::Zero());
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    pollNowAndThen(i);
    if (!input.guideDirections[i].isZero(0))
    {
      continue;
    }
    const auto polygon = static_cast<Index>(i);
    const Index* const points = input.polygonPoints.data();
    input.guideDirections[i] = ofCells ? vectorAt(array, "cell", surface.cell(polygon))
                                       : mainDirection(array, points + input.polygonOffsets[i],
                                           points + input.polygonOffsets[i + 1]);
    if (!input.guideWeights.empty() && !input.guideDirections[i].isZero(0))
    {
      input.guideWeights[i] = 1;
    }
  }
}

} // namespace quadrille
