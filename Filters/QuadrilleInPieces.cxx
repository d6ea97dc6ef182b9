// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleInPieces.h"

#include "Base/Parallel.h"
#include "QuadrilleArrayNames.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::size_t kOffsetChunk = std::size_t{ 1 } << 20;

template <typename Coordinate, typename Id>
class PolyDataTriangles : public TriangleSource
{
public:
  PolyDataTriangles(vtkPolyData* surface, const Coordinate* points, const Id* corners)
    : points_(points), corners_(corners),
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
  const Id* corners_;
  std::size_t pointCount_, triangleCount_;
};

template <typename Id>
bool hasThreeEach(const Id* offsets, std::size_t triangles)
{
  return firstRefused(triangles + 1, kOffsetChunk, 0,
           [&](std::size_t i) { return offsets[i] == static_cast<Id>(3 * i); }) == triangles + 1;
}

template <typename Coordinate>
std::unique_ptr<TriangleSource> trianglesOf(vtkPolyData* surface, const Coordinate* points)
{
  vtkCellArray* const cells = surface->GetPolys();
  const auto triangles = static_cast<std::size_t>(cells->GetNumberOfCells());
  if (cells->IsStorage64Bit())
  {
    const vtkTypeInt64* const corners = cells->GetConnectivityArray64()->GetPointer(0);
    return hasThreeEach(cells->GetOffsetsArray64()->GetPointer(0), triangles)
      ? std::make_unique<PolyDataTriangles<Coordinate, vtkTypeInt64>>(surface, points, corners)
      : nullptr;
  }
  const vtkTypeInt32* const corners = cells->GetConnectivityArray32()->GetPointer(0);
  return hasThreeEach(cells->GetOffsetsArray32()->GetPointer(0), triangles)
    ? std::make_unique<PolyDataTriangles<Coordinate, vtkTypeInt32>>(surface, points, corners)
    : nullptr;
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

void addPieceSources(const PiecesResult& made, const QuadMesh& mesh,
  const ConvertedSurface& converted, vtkPolyData* surface, QuadSource& source)
{
  std::vector<SourceLocation> ofPoints = made.pointSource;
  const auto isMissing = [](const SourceLocation& at) { return at.polygon == kInvalidIndex; };
  for (bool hasChanged = true; hasChanged;)
  {
    hasChanged = false;
    for (const std::array<Index, 4>& quad : mesh.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        SourceLocation& at = ofPoints[quad[i]];
        const SourceLocation& next = ofPoints[quad[(i + 1) % 4]];
        if (isMissing(at) && !isMissing(next))
        {
          at = next;
          hasChanged = true;
        }
      }
    }
  }
  for (const SourceLocation& at : ofPoints)
  {
    source.pointOrigins.push_back(pointOrigin(at, converted, surface));
    source.pointCells.push_back(converted.cell(at.polygon));
  }
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
  {
    const SourceLocation& at = made.quadSource[q];
    source.quadCells.push_back(
      converted.cell(isMissing(at) ? ofPoints[mesh.quads[q][0]].polygon : at.polygon));
  }
}

} // namespace quadrille
