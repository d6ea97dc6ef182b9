// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/MeshArrays.h"

#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Base/Types.h"
#include "Common/NewArray.h"
#include "Convert/PolyData.h"
#include "Convert/Tuples.h"
#include "Mesh/Topology.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace quadrille
{

namespace
{

void copyIds(const std::vector<Index>& ids, vtkIdTypeArray* array, int threads)
{
  vtkIdType* to = array->GetPointer(0);
  forEachIndex(ids.size(), threads, [&](std::size_t i) { to[i] = ids[i]; });
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

} // namespace

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
void checkPointId(vtkIdType id, vtkIdType pointCount, vtkIdType cell)
{
  if (id < 0 || id >= pointCount)
  {
    refuse("cell ", cell, " refers to point ", id, ", but there are ", pointCount, " points");
  }
}

//------------------------------------------------------------------------------
std::vector<Index> readIds(vtkDataArray* array, std::size_t limit, int threads)
{
  std::vector<Index> ids(static_cast<std::size_t>(array->GetNumberOfTuples()));
  auto* whole = vtkIdTypeArray::SafeDownCast(array);
  const vtkIdType* values = whole ? whole->GetPointer(0) : nullptr;
  const auto value = [&](std::size_t i)
  {
    return values ? static_cast<double>(values[i])
                  : array->GetComponent(static_cast<vtkIdType>(i), 0);
  };
  const std::size_t refused = firstRefused(ids.size(), kLightChunk, threads,
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

//------------------------------------------------------------------------------
vtkSmartPointer<vtkIdTypeArray> writeIds(
  const char* name, const std::vector<Index>& ids, int threads)
{
  auto array = newArray<vtkIdTypeArray>(name, 1, ids.size());
  copyIds(ids, array, threads);
  return array;
}

//------------------------------------------------------------------------------
std::vector<Index> identity(Index count)
{
  std::vector<Index> ids(count);
  for (Index i = 0; i < count; ++i)
  {
    ids[i] = i;
  }
  return ids;
}

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

//------------------------------------------------------------------------------
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

} // namespace quadrille
