// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/VtkVersions.h"
#include "Convert/ArrayNames.h"
#include "Convert/Attributes.h"
#include "Mesh/Topology.h"
#include "Requests/AskedValues.h"
#include "Requests/CurveRequests.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace quadrille
{

namespace
{

/// Below this a coordinate on the 2^-24 grid fits the 53 bits of a double.
constexpr std::int64_t kLargestExact = std::int64_t{ 1 } << (28 + kFractionBits);
/// Sine of the angle to the normal below which a direction says nothing about a face.
constexpr double kLeastTangent = 0.01;
constexpr double kTangentRounding = 1e-9;
constexpr std::size_t kTupleChunk = std::size_t{ 1 } << 16;

/// body(i) for all i below count, by all threads.
template <class Body>
void forEachIndex(std::size_t count, int threads, const Body& body)
{
  parallelFor(count, kTupleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        body(i);
      }
    });
}

//------------------------------------------------------------------------------
// The user's surface

template <class Real>
void copyPoints(const Real* from, int threads, std::vector<Vector3>& to)
{
  forEachIndex(to.size(), threads,
    [&](std::size_t i) { to[i] = Vector3(from[3 * i], from[3 * i + 1], from[3 * i + 2]); });
}

std::vector<Vector3> readPoints(vtkPolyData* data, int threads)
{
  std::vector<Vector3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  if (points.empty())
  {
    return points;
  }
  vtkDataArray* array = data->GetPoints()->GetData();
  if (auto* floats = vtkFloatArray::SafeDownCast(array))
  {
    copyPoints(floats->GetPointer(0), threads, points);
  }
  else if (auto* doubles = vtkDoubleArray::SafeDownCast(array))
  {
    copyPoints(doubles->GetPointer(0), threads, points);
  }
  else
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      pollNowAndThen(i);
      array->GetTuple(static_cast<vtkIdType>(i), points[i].data());
    }
  }
  return points;
}

void checkPointId(vtkIdType id, vtkIdType pointCount, vtkIdType cell)
{
  if (id < 0 || id >= pointCount)
  {
    refuse("cell ", cell, " refers to point ", id, ", but there are ", pointCount, " points");
  }
}

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
  return firstRefused(input.polygonPoints.size(), kTupleChunk, threads,
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

//------------------------------------------------------------------------------
// What the user asks for

/// A real array with so many components, or null where there is none of this name.
vtkDataArray* realArray(
  vtkDataSetAttributes* attributes, const char* element, const char* name, int components)
{
  vtkDataArray* array = attributes->GetArray(name);
  if (!array)
  {
    if (attributes->HasArray(name))
    {
      refuse(element, " array '", name, "' does not hold numbers");
    }
    return nullptr;
  }
  const int type = array->GetDataType();
  if (array->GetNumberOfComponents() != components || (type != VTK_FLOAT && type != VTK_DOUBLE))
  {
    refuse(element, " array '", name, "' must have ", components, " real number(s) a ", element,
      ", it has ", array->GetNumberOfComponents(), " of type ", array->GetDataTypeAsString());
  }
  return array;
}

/// Direction and weight of single cells; nothing where there are no directions.
class GuideArrays
{
public:
  explicit GuideArrays(vtkPolyData* data)
    : directions_(realArray(data->GetCellData(), "cell", arrays::kGuidingDirection, 3)),
      weights_(realArray(data->GetCellData(), "cell", arrays::kGuidingWeight, 1))
  {
  }
  bool empty() const { return !directions_; }
  bool hasWeights() const { return weights_ != nullptr; }

  Vector3 direction(vtkIdType cell) const
  {
    Vector3 d;
    directions_->GetTuple(cell, d.data());
    requireDirection(cell, d);
    return d;
  }
  /// Of a cell with a direction.
  double weight(vtkIdType cell) const
  {
    const double weight = weights_ ? weights_->GetTuple1(cell) : 1;
    requireGuideWeight(cell, weight);
    return weight;
  }

private:
  vtkDataArray* directions_;
  vtkDataArray* weights_;
};

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

/// #points, or empty where the array is missing.
std::vector<float> pointSizes(vtkPolyData* data)
{
  std::vector<float> sizes;
  vtkDataArray* array = realArray(data->GetPointData(), "point", arrays::kSizing, 1);
  if (!array)
  {
    return sizes;
  }
  sizes.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    pollNowAndThen(i);
    const auto point = static_cast<vtkIdType>(i);
    sizes[i] = requireSize(point, array->GetTuple1(point));
  }
  return sizes;
}

/// #points, or empty where the array is missing.
std::vector<int> pointValences(vtkPolyData* data)
{
  std::vector<int> valences;
  vtkDataArray* array = data->GetPointData()->GetArray(arrays::kTargetValence);
  if (!array)
  {
    if (data->GetPointData()->HasArray(arrays::kTargetValence))
    {
      refuse("point array '", arrays::kTargetValence, "' does not hold numbers");
    }
    return valences;
  }
  if (array->GetNumberOfComponents() != 1)
  {
    refuse("point array '", arrays::kTargetValence, "' must have one whole number a point");
  }
  requireWhole(array, "point");
  valences.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < valences.size(); ++i)
  {
    const auto point = static_cast<vtkIdType>(i);
    const double valence = array->GetTuple1(point);
    requireValence(point, Vector3(data->GetPoint(point)), valence);
    valences[i] = static_cast<int>(valence);
  }
  return valences;
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
  const std::size_t refused = firstRefused(bits.size(), kTupleChunk, threads,
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

//------------------------------------------------------------------------------
// Arrays

vtkDataArray* requireArray(
  vtkDataSetAttributes* attributes, const char* name, int components, const char* madeBy)
{
  vtkDataArray* array = attributes->GetArray(name);
  if (!array || array->GetNumberOfComponents() != components)
  {
    refuse("the input has no array '", name, "' with ", components,
      " component(s) a tuple; it is made by ", madeBy);
  }
  return array;
}

std::vector<Index> readIds(vtkDataArray* array, std::size_t limit, int threads = 1)
{
  std::vector<Index> ids(static_cast<std::size_t>(array->GetNumberOfTuples()));
  auto* whole = vtkIdTypeArray::SafeDownCast(array);
  const vtkIdType* values = whole ? whole->GetPointer(0) : nullptr;
  const auto value = [&](std::size_t i)
  {
    return values ? static_cast<double>(values[i])
                  : array->GetComponent(static_cast<vtkIdType>(i), 0);
  };
  const std::size_t refused = firstRefused(ids.size(), kTupleChunk, threads,
    [&](std::size_t i)
    {
      const double id = value(i);
      if (!(id >= 0 && id < static_cast<double>(limit)))
      {
        return false;
      }
      ids[i] = static_cast<Index>(id);
      return true;
    });
  if (refused < ids.size())
  {
    refuse("array '", array->GetName(), "' has the value ", value(refused), " at ", refused,
      ", but only 0 to ", limit, " - 1 exist; it belongs to another surface");
  }
  return ids;
}

void copyIds(const std::vector<Index>& ids, vtkIdTypeArray* array, int threads)
{
  vtkIdType* to = array->GetPointer(0);
  forEachIndex(ids.size(), threads, [&](std::size_t i) { to[i] = ids[i]; });
}

vtkSmartPointer<vtkIdTypeArray> writeIds(
  const char* name, const std::vector<Index>& ids, int threads = 1)
{
  auto array = newArray<vtkIdTypeArray>(name, 1, ids.size());
  copyIds(ids, array, threads);
  return array;
}

vtkSmartPointer<vtkCellArray> writeTriangles(const std::vector<Index>& corners, int threads)
{
  auto offsets = newArray<vtkIdTypeArray>("", 1, corners.size() / 3 + 1);
  auto connectivity = newArray<vtkIdTypeArray>("", 1, corners.size());
  vtkIdType* to = offsets->GetPointer(0);
  forEachIndex(corners.size() / 3 + 1, threads,
    [to](std::size_t i) { to[i] = static_cast<vtkIdType>(3 * i); });
  copyIds(corners, connectivity, threads);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

void addFeatureEdges(vtkPolyData* data, const Mesh& mesh, int threads)
{
  auto array = newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, mesh.faceCount());
  unsigned char* bits = array->GetPointer(0);
  forEachIndex(mesh.faceCount(), threads,
    [&](std::size_t f)
    {
      const Index h = static_cast<Index>(3 * f);
      bits[f] = static_cast<unsigned char>((mesh.isFeature(h) ? 1 : 0) |
        (mesh.isFeature(h + 1) ? 2 : 0) | (mesh.isFeature(h + 2) ? 4 : 0));
    });
  data->GetCellData()->AddArray(array);
}

/// Sheets of a surface that was not manifold may share both ends of an edge; then the twins have to
/// be told.
bool cornersTellTwins(const Mesh& mesh, int threads)
{
  try
  {
    return pairHalfEdges(mesh.origin, mesh.vertexCount(), threads) == mesh.twin;
  }
  catch (const InvalidInput&)
  {
    return false;
  }
}

void addTwinsWhereNeeded(vtkPolyData* data, const Mesh& mesh, int threads)
{
  if (cornersTellTwins(mesh, threads))
  {
    return;
  }
  auto array = newArray<vtkIdTypeArray>(arrays::kTwin, 3, mesh.faceCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    array->SetValue(h, mesh.isBoundary(h) ? -1 : static_cast<vtkIdType>(mesh.twin[h]));
  }
  data->GetCellData()->AddArray(array);
}

/// Twins from the array, where it is there and fits the corners.
bool readTwins(vtkPolyData* data, Mesh& mesh)
{
  auto* array = vtkIdTypeArray::SafeDownCast(data->GetCellData()->GetArray(arrays::kTwin));
  if (!array || array->GetNumberOfValues() != static_cast<vtkIdType>(mesh.halfEdgeCount()))
  {
    return false;
  }
  mesh.twin.assign(mesh.halfEdgeCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const vtkIdType g = array->GetValue(h);
    if (g < 0)
    {
      continue;
    }
    if (g >= array->GetNumberOfValues() || array->GetValue(g) != static_cast<vtkIdType>(h) ||
      mesh.origin[static_cast<Index>(g)] != mesh.target(h))
    {
      return false; // some filter in between took or reordered cells
    }
    mesh.twin.edit()[h] = static_cast<Index>(g);
  }
  return true;
}

void readFlags(vtkPolyData* data, Mesh& mesh, int threads)
{
  mesh.flags.assign(mesh.halfEdgeCount(), 0);
  vtkDataArray* array = data->GetCellData()->GetArray(arrays::kFeatureEdges);
  if (!array)
  {
    return;
  }
  auto* bytes = vtkUnsignedCharArray::SafeDownCast(array);
  const unsigned char* values = bytes ? bytes->GetPointer(0) : nullptr;
  const int stride = array->GetNumberOfComponents();
  const auto isMarked = [&](Index h)
  {
    const vtkIdType f = Mesh::face(h);
    const int bits = values ? values[f * stride] : static_cast<int>(array->GetComponent(f, 0));
    return ((bits >> (h % 3)) & 1) != 0;
  };
  std::uint8_t* const flags = mesh.flags.edit();
  parallelFor(mesh.halfEdgeCount(), kTupleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Index h = static_cast<Index>(begin); h < end; ++h)
      {
        if (isMarked(h) || (!mesh.isBoundary(h) && isMarked(mesh.twin[h])))
        {
          flags[h] |= kFeatureEdge;
        }
      }
    });
}

/// The first cell that is no triangle of points that there are; the number of cells where all are.
template <class Offset, class Id>
std::size_t copyTriangles(
  const Offset* offsets, const Id* ids, vtkIdType points, int threads, std::vector<Index>& corners)
{
  return firstRefused(corners.size() / 3, kTupleChunk, threads,
    [=, &corners](std::size_t f)
    {
      if (offsets[f + 1] - offsets[f] != 3)
      {
        return false;
      }
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Id id = ids[static_cast<std::size_t>(offsets[f]) + i];
        if (id < 0 || id >= points)
        {
          return false;
        }
        corners[3 * f + i] = static_cast<Index>(id);
      }
      return true;
    });
}

[[noreturn]] void refuseTriangle(vtkPolyData* data, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  data->GetPolys()->GetCellAtId(cell, ids);
  for (const vtkIdType id : *ids)
  {
    checkPointId(id, data->GetNumberOfPoints(), cell);
  }
  refuse("cell ", cell, " has ", ids->GetNumberOfIds(),
    " corners, a triangle is needed; the surface and its map have to be triangulated first");
}

std::vector<Index> readTriangles(vtkPolyData* data, int threads = 1)
{
  if (data->GetNumberOfPolys() != data->GetNumberOfCells())
  {
    refuse("the input has cells other than triangles (vertices, lines or strips); keep the "
           "triangles only");
  }
  vtkCellArray* cells = data->GetPolys();
  const vtkIdType points = data->GetNumberOfPoints();
  std::vector<Index> corners(3 * static_cast<std::size_t>(cells->GetNumberOfCells()));
  const vtkSmartPointer<vtkDataArray> plainCorners = plainIds(cells->GetConnectivityArray());
  const std::size_t refused = withIds(plainIds(cells->GetOffsetsArray()),
    [&](const auto* offsets)
    {
      return withIds(plainCorners,
        [&](const auto* ids) { return copyTriangles(offsets, ids, points, threads, corners); });
    });
  if (3 * refused < corners.size())
  {
    refuseTriangle(data, static_cast<vtkIdType>(refused));
  }
  return corners;
}

/// Joins the points that were split at seams for display.
void weldSplitPoints(vtkPolyData* data, Mesh& mesh, int threads)
{
  vtkDataArray* array = data->GetPointData()->GetArray(arrays::kSurfacePointId);
  if (!array)
  {
    return;
  }
  const std::vector<Index> id = readIds(array, mesh.position.size(), threads);
  Index count = 0;
  for (const Index i : id)
  {
    count = std::max(count, i + 1);
  }
  std::vector<Vector3> position(count);
  std::vector<float> sizing(mesh.sizing.empty() ? 0 : count, 1.0F);
  for (std::size_t i = 0; i < id.size(); ++i)
  {
    position[id[i]] = mesh.position[i];
    if (!sizing.empty())
    {
      sizing[id[i]] = mesh.sizing[i];
    }
  }
  Index* const origin = mesh.origin.edit();
  forEachIndex(mesh.origin.size(), threads, [&](std::size_t h) { origin[h] = id[origin[h]]; });
  mesh.position = std::move(position);
  mesh.sizing = std::move(sizing);
}

//------------------------------------------------------------------------------
// The mapped surface

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

vtkSmartPointer<vtkPoints> writePoints(
  const Mesh& mesh, const std::vector<Index>& pointVertex, int threads)
{
  auto array = newArray<vtkDoubleArray>("Points", 3, pointVertex.size());
  double* to = array->GetPointer(0);
  forEachIndex(pointVertex.size(), threads,
    [&](std::size_t i)
    {
      const Vector3& p = mesh.position[pointVertex[i]];
      std::copy(p.data(), p.data() + 3, to + 3 * i);
    });
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(array);
  return points;
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

std::vector<Index> identity(Index count)
{
  std::vector<Index> ids(count);
  for (Index i = 0; i < count; ++i)
  {
    ids[i] = i;
  }
  return ids;
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

std::vector<std::string> carryPointsToSurface(vtkPolyData* data, const PreparedSurface& surface,
  vtkPolyData* source, const std::vector<Index>& pointVertex, int threads)
{
  const std::vector<Index> outgoing = outgoingHalfEdges(surface.mesh);
  std::vector<PointOrigin> points(pointVertex.size());
  forEachIndex(points.size(), threads,
    [&](std::size_t i)
    {
      const Index h = outgoing[pointVertex[i]];
      std::array<double, 3> corner{};
      corner[h % 3] = 1;
      const SourceLocation at = surface.locate(Mesh::face(h), corner);
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
  surface.input.points = readPoints(data, threads);
  readPolygons(data, surface, threads);
  readStrips(data, surface);
  readFeatureEdges(data, surface, threads);
  readDetectedFeatures(data, surface);
  readPatchIds(data, patchArray, surface, threads);
  readGuides(data, surface);
  surface.input.targetValences = pointValences(data);
  surface.input.sizing = pointSizes(data);
  return surface;
}

namespace
{

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

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> writeMesh(const Mesh& mesh)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(writePoints(mesh, identity(mesh.vertexCount()), 1));
  data->SetPolys(writeTriangles(mesh.origin, 1));
  if (!mesh.sizing.empty())
  {
    auto sizes = newArray<vtkFloatArray>(arrays::kSizing, 1, mesh.sizing.size());
    std::copy(mesh.sizing.begin(), mesh.sizing.end(), sizes->GetPointer(0));
    data->GetPointData()->AddArray(sizes);
  }
  addFeatureEdges(data, mesh, 1);
  addTwinsWhereNeeded(data, mesh, 1);
  return data;
}

std::vector<Index> readCorners(vtkPolyData* data, int threads)
{
  return readTriangles(data, threads);
}

std::vector<Vector3> readPointPositions(vtkPolyData* data, int threads)
{
  return readPoints(data, threads);
}

void readFeatureFlags(vtkPolyData* data, Mesh& mesh, int threads)
{
  readFlags(data, mesh, threads);
}

std::vector<int> readPointValences(vtkPolyData* data)
{
  return pointValences(data);
}

Mesh readMesh(vtkPolyData* data, int threads)
{
  Mesh mesh;
  mesh.origin = readTriangles(data, threads);
  mesh.position = readPoints(data, threads);
  mesh.sizing = pointSizes(data);
  weldSplitPoints(data, mesh, threads);
  if (!readTwins(data, mesh))
  {
    mesh.twin = pairHalfEdges(mesh.origin, mesh.vertexCount(), threads);
  }
  readFlags(data, mesh, threads);
  return mesh;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> writeLevel(const Level& level, const std::vector<int>& targetValences)
{
  vtkSmartPointer<vtkPolyData> data = writeMesh(level.mesh);
  if (!level.guides.empty())
  {
    auto directions = newArray<vtkDoubleArray>(arrays::kGuidingDirection, 3, level.guides.size());
    auto weights = newArray<vtkFloatArray>(arrays::kGuidingWeight, 1, level.guides.size());
    for (std::size_t f = 0; f < level.guides.size(); ++f)
    {
      directions->SetTuple(static_cast<vtkIdType>(f), level.guides[f].direction.data());
      weights->SetValue(static_cast<vtkIdType>(f), level.guides[f].weight);
    }
    data->GetCellData()->AddArray(directions);
    data->GetCellData()->AddArray(weights);
  }
  if (!targetValences.empty())
  {
    auto valences = newArray<vtkIntArray>(arrays::kTargetValence, 1, targetValences.size());
    std::copy(targetValences.begin(), targetValences.end(), valences->GetPointer(0));
    data->GetPointData()->AddArray(valences);
  }
  data->GetPointData()->AddArray(writeIds(arrays::kFineVertex, level.fineVertex));
  data->GetCellData()->AddArray(writeIds(arrays::kFineFace, level.fineFace));
  return data;
}

std::vector<Guide> readGuides(vtkPolyData* data, const Mesh& mesh)
{
  std::vector<Guide> guides;
  const GuideArrays given(data);
  for (Index f = 0; f < mesh.faceCount() && !given.empty(); ++f)
  {
    guides.emplace_back();
    const Vector3 n = mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).stableNormalized();
    const Vector3 direction = given.direction(f);
    const Vector3 tangent = direction.stableNormalized() - n * n.dot(direction.stableNormalized());
    // What writeLevel wrote comes back with every bit.
    const bool exact = (tangent - direction).norm() < kTangentRounding;
    if (exact || tangent.norm() > kLeastTangent)
    {
      guides.back() = { exact ? direction : Vector3(tangent.normalized()),
        direction.isZero(0) ? 0.0F : static_cast<float>(given.weight(f)) };
    }
  }
  return guides;
}

std::vector<int> readTargetValences(vtkPolyData* data, const Mesh& mesh)
{
  const std::vector<int> valences = pointValences(data);
  vtkDataArray* array = data->GetPointData()->GetArray(arrays::kSurfacePointId);
  if (valences.empty() || !array)
  {
    return valences;
  }
  const std::vector<Index> vertex = readIds(array, mesh.vertexCount());
  std::vector<int> result(mesh.vertexCount(), 0);
  for (std::size_t i = 0; i < vertex.size(); ++i)
  {
    result[vertex[i]] = std::max(result[vertex[i]], valences[i]);
  }
  return result;
}

void addCurveRequests(vtkPolyData* data, const std::vector<CurveRequest>& curves)
{
  if (curves.empty())
  {
    return;
  }
  auto kinds = newArray<vtkIntArray>(arrays::kCurveKinds, 1, curves.size());
  auto sizes = newArray<vtkIntArray>(arrays::kCurveSizes, 1, curves.size());
  vtkNew<vtkDoubleArray> points;
  points->SetName(arrays::kCurvePoints);
  points->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    kinds->SetValue(static_cast<vtkIdType>(i), static_cast<int>(curves[i].kind));
    sizes->SetValue(static_cast<vtkIdType>(i), static_cast<int>(curves[i].points.size()));
    for (const Vector3& p : curves[i].points)
    {
      points->InsertNextTuple(p.data());
    }
  }
  data->GetFieldData()->AddArray(kinds);
  data->GetFieldData()->AddArray(sizes);
  data->GetFieldData()->AddArray(points);
}

std::vector<CurveRequest> readCurveRequests(vtkPolyData* data)
{
  vtkFieldData* field = data->GetFieldData();
  vtkDataArray* kinds = field->GetArray(arrays::kCurveKinds);
  vtkDataArray* sizes = field->GetArray(arrays::kCurveSizes);
  vtkDataArray* points = field->GetArray(arrays::kCurvePoints);
  std::vector<CurveRequest> curves;
  if (kinds == nullptr && sizes == nullptr && points == nullptr)
  {
    return curves;
  }
  const auto fail = []()
  {
    refuse("the field arrays '", arrays::kCurveKinds, "', '", arrays::kCurveSizes, "' and '",
      arrays::kCurvePoints,
      "' do not fit each other: take the coarse output of vtkDecimationHierarchy as it is, or "
      "remove all three");
  };
  if (kinds == nullptr || sizes == nullptr || points == nullptr ||
    points->GetNumberOfComponents() != 3 ||
    kinds->GetNumberOfTuples() != sizes->GetNumberOfTuples())
  {
    fail();
  }
  vtkIdType next = 0;
  for (vtkIdType i = 0; i < kinds->GetNumberOfTuples(); ++i)
  {
    const double kind = kinds->GetTuple1(i);
    const double size = sizes->GetTuple1(i);
    if ((kind != 0 && kind != 1) || !(size >= 0) ||
      size > static_cast<double>(points->GetNumberOfTuples() - next))
    {
      fail();
    }
    CurveRequest curve;
    curve.kind = kind == 0 ? CurveKind::Connection : CurveKind::Cycle;
    for (double k = 0; k < size; ++k)
    {
      curve.points.emplace_back(points->GetTuple3(next++));
    }
    checkCurve(curve, static_cast<std::size_t>(i));
    curves.push_back(std::move(curve));
  }
  return curves;
}

Level readLevel(vtkPolyData* data, const Mesh& fine)
{
  constexpr const char* kMadeBy = "vtkDecimationHierarchy";
  Level level;
  level.mesh = readMesh(data);
  level.fineVertex = readIds(
    requireArray(data->GetPointData(), arrays::kFineVertex, 1, kMadeBy), fine.vertexCount());
  level.fineFace =
    readIds(requireArray(data->GetCellData(), arrays::kFineFace, 1, kMadeBy), fine.faceCount());
  return level;
}

//------------------------------------------------------------------------------
void addMap(vtkPolyData* data, const std::vector<FixedVec2>& uv, int threads)
{
  const std::size_t faces = uv.size() / 3;
  auto igm = newArray<vtkDoubleArray>(arrays::kIgm, 6, faces);
  auto determinants = newArray<vtkDoubleArray>(arrays::kDeterminant, 1, faces);
  double* value = igm->GetPointer(0);
  const std::size_t refused = firstRefused(uv.size(), kTupleChunk, threads,
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
  const std::size_t refused = firstRefused(uv.size(), kTupleChunk, threads,
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

void addMatching(vtkPolyData* data, const std::vector<std::int8_t>& matching)
{
  auto array = newArray<vtkSignedCharArray>(arrays::kMatching, 3, matching.size() / 3);
  std::copy(matching.begin(), matching.end(), array->GetPointer(0));
  data->GetCellData()->AddArray(array);
}

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
