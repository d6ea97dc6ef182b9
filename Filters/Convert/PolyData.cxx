// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/PolyData.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/VtkVersions.h"
#include "Convert/AskedArrays.h"
#include "Convert/MeshArrays.h"
#include "Convert/Tuples.h"
#include "Mesh/Topology.h"
#include "Requests/CurveRequests.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstdint>

namespace quadrille
{

namespace
{

/// Sine of the angle to the normal below which a direction says nothing about a face.
constexpr double kLeastTangent = 0.01;

template <class Real>
void copyPoints(const Real* from, int threads, std::vector<Vector3>& to)
{
  forEachIndex(to.size(), threads,
    [&](std::size_t i) { to[i] = Vector3(from[3 * i], from[3 * i + 1], from[3 * i + 2]); });
}

/// The first cell that is no triangle of points that there are; the number of cells where all are.
template <class Offset, class Id>
std::size_t copyTriangles(
  const Offset* offsets, const Id* ids, vtkIdType points, int threads, std::vector<Index>& corners)
{
  return firstRefused(corners.size() / 3, kLightChunk, threads,
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

} // namespace

//------------------------------------------------------------------------------
std::vector<Vector3> readPointPositions(vtkPolyData* data, int threads)
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

//------------------------------------------------------------------------------
std::vector<Index> readCorners(vtkPolyData* data, int threads)
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

//------------------------------------------------------------------------------
void readFeatureFlags(vtkPolyData* data, Mesh& mesh, int threads)
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
  parallelForEach(mesh.halfEdgeCount(), kLightChunk, threads,
    [&](Index h)
    {
      if (isMarked(h) || (!mesh.isBoundary(h) && isMarked(mesh.twin[h])))
      {
        flags[h] |= kFeatureEdge;
      }
    });
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

//------------------------------------------------------------------------------
Mesh readMesh(vtkPolyData* data, int threads)
{
  Mesh mesh;
  mesh.origin = readCorners(data, threads);
  mesh.position = readPointPositions(data, threads);
  mesh.sizing = pointSizes(data);
  weldSplitPoints(data, mesh, threads);
  if (!readTwins(data, mesh))
  {
    mesh.twin = pairHalfEdges(mesh.origin, mesh.vertexCount(), threads);
  }
  readFeatureFlags(data, mesh, threads);
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

//------------------------------------------------------------------------------
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
    const bool exact = (tangent - direction).norm() < kRounding;
    if (exact || tangent.norm() > kLeastTangent)
    {
      guides.back() = { exact ? direction : Vector3(tangent.normalized()),
        direction.isZero(0) ? 0.0F : static_cast<float>(given.weight(f)) };
    }
  }
  return guides;
}

//------------------------------------------------------------------------------
std::vector<int> readTargetValences(vtkPolyData* data, const Mesh& mesh)
{
  const std::vector<int> valences = readPointValences(data);
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

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

} // namespace quadrille
