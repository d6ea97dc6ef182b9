// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/InPieces.h"

#include "Common/VtkVersions.h"
#include "Convert/ArrayNames.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

template <typename Coordinate, typename Id>
class PolyDataTriangles : public TriangleSource
{
public:
  /// ids: what holds the corners, which may be a copy.
  PolyDataTriangles(vtkPolyData* surface, const Coordinate* points,
    const vtkSmartPointer<vtkDataArray>& ids, const Id* corners)
    : points_(points), ids_(ids), corners_(corners),
      pointCount_(static_cast<std::size_t>(surface->GetNumberOfPoints())),
      triangleCount_(static_cast<std::size_t>(surface->GetNumberOfPolys()))
  {
  }

  std::size_t pointCount() const override { return pointCount_; }
  std::size_t triangleCount() const override { return triangleCount_; }
  void corners(std::size_t begin, std::size_t end, Index* ids) const override
  {
    std::transform(corners_ + 3 * begin, corners_ + 3 * end, ids,
      [](Id id)
      {
        return id >= 0 && static_cast<std::uint64_t>(id) < kInvalidIndex ? static_cast<Index>(id)
                                                                         : kInvalidIndex;
      });
  }
  void positions(const Index* ids, std::size_t count, Vector3* places) const override
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      const Coordinate* const p = points_ + 3 * std::size_t{ ids[i] };
      places[i] = Vector3(double{ p[0] }, double{ p[1] }, double{ p[2] });
    }
  }

private:
  const Coordinate* points_;
  vtkSmartPointer<vtkDataArray> ids_;
  const Id* corners_;
  std::size_t pointCount_, triangleCount_;
};

template <typename Coordinate>
std::unique_ptr<TriangleSource> trianglesOf(vtkPolyData* surface, const Coordinate* points)
{
  vtkCellArray* const cells = surface->GetPolys();
  if (cells->IsHomogeneous() != 3 ||
    cells->GetNumberOfConnectivityIds() != 3 * cells->GetNumberOfCells())
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkDataArray> ids = plainIds(cells->GetConnectivityArray());
  return withIds(ids,
    [&](const auto* corners) -> std::unique_ptr<TriangleSource>
    {
      using Id = std::remove_const_t<std::remove_pointer_t<decltype(corners)>>;
      return std::make_unique<PolyDataTriangles<Coordinate, Id>>(surface, points, ids, corners);
    });
}

} // namespace

std::unique_ptr<TriangleSource> trianglesOf(vtkPolyData* surface)
{
  if (!surface->GetPoints() || surface->GetNumberOfPolys() == 0 || surface->GetNumberOfStrips() > 0)
  {
    return nullptr;
  }
  vtkDataArray* const points = surface->GetPoints()->GetData();
  if (auto* const single = vtkFloatArray::SafeDownCast(points))
  {
    return trianglesOf(surface, single->GetPointer(0));
  }
  if (auto* const wide = vtkDoubleArray::SafeDownCast(points))
  {
    return trianglesOf(surface, wide->GetPointer(0));
  }
  return nullptr;
}

std::string constrainingArray(vtkPolyData* surface, const std::string& patchArray)
{
  std::vector<ReadArray> read = surfaceArrays(patchArray);
  read.push_back({ arrays::kDetectedFeatures, ArrayPlace::Cells, 1 });
  if (!patchArray.empty())
  {
    read.push_back({ patchArray, ArrayPlace::Cells, 1 });
  }
  for (const ReadArray& array : read)
  {
    vtkDataSetAttributes* data = surface->GetPointData();
    if (array.place == ArrayPlace::Cells)
    {
      data = surface->GetCellData();
    }
    if (data->HasArray(array.name.c_str()))
    {
      return array.name;
    }
  }
  return {};
}

ConvertedSurface polygonsOf(vtkPolyData* surface)
{
  ConvertedSurface converted;
  converted.ignoredCells =
    static_cast<std::size_t>(surface->GetNumberOfVerts() + surface->GetNumberOfLines());
  converted.firstCell = surface->GetNumberOfVerts() + surface->GetNumberOfLines();
  return converted;
}

} // namespace quadrille
