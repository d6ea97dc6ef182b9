// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/SpreadCells.h"

#include "Base/Memory.h"
#include "Common/NewArray.h"
#include "Convert/Pieces.h"
#include "Ranks/Packing.h"
#include "Ranks/Polygons.h"
#include "Ranks/SpreadArrays.h"

#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace quadrille
{

namespace
{

/// Cells of the box along each axis, as a power of two: with 2^18 of them the parts are even, and their counts take 2
/// MB.
constexpr unsigned kBinBits = 6;
constexpr std::size_t kCellBins = std::size_t{ 1 } << (3 * kBinBits);

/// The number of a cell of the box along the curve: the bits of its three coordinates in turn [Morton 1966].
std::size_t curveBin(const Vector3& x, const vtkBoundingBox& box)
{
  std::size_t bin = 0;
  std::array<std::size_t, 3> cell{};
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = box.GetLength(axis);
    const double part = length > 0 ? (x[axis] - box.GetMinPoint()[axis]) / length : 0;
    constexpr double last = (1U << kBinBits) - 1;
    cell[static_cast<std::size_t>(axis)] =
      static_cast<std::size_t>(std::clamp(part * (last + 1), 0.0, last));
  }
  for (unsigned bit = kBinBits; bit-- > 0;)
  {
    for (const std::size_t coordinate : cell)
    {
      bin = 2 * bin + (coordinate >> bit & 1U);
    }
  }
  return bin;
}

/// Of triangles that were strips: the cell that they come from.
constexpr const char* kStripCell = "QuadrilleStripCell";

/// Strips as triangles.
vtkSmartPointer<vtkPolyData> withoutStrips(vtkPolyData* data)
{
  if (data->GetNumberOfStrips() == 0)
  {
    return data;
  }
  auto cells =
    newArray<vtkIdTypeArray>(kStripCell, 1, static_cast<std::size_t>(data->GetNumberOfCells()));
  std::iota(cells->GetPointer(0), cells->GetPointer(data->GetNumberOfCells()), vtkIdType{ 0 });
  vtkNew<vtkPolyData> marked;
  marked->ShallowCopy(data);
  marked->GetCellData()->AddArray(cells);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(marked);
  triangles->Update();
  return triangles->GetOutput();
}

/// Of each polygon its cell of the box, in the order of visitPolygons.
std::vector<std::uint32_t> binsOf(vtkPolyData* data, const vtkBoundingBox& box)
{
  std::vector<std::uint32_t> bins;
  bins.reserve(static_cast<std::size_t>(data->GetNumberOfPolys()));
  visitPolygons(data,
    [&](vtkIdType, vtkIdType count, const vtkIdType* ids)
    {
      Vector3 centre = Vector3::Zero();
      for (vtkIdType i = 0; i < count; ++i)
      {
        Vector3 x;
        data->GetPoint(ids[i], x.data());
        centre += x / static_cast<double>(count);
      }
      bins.push_back(static_cast<std::uint32_t>(curveBin(centre, box)));
    });
  return bins;
}

/// The rank of each cell of the box: parts of the curve with about the same number of polygons.
std::vector<std::uint32_t> ranksOfBins(const std::vector<vtkIdType>& polygons, std::size_t ranks)
{
  const vtkIdType all = std::accumulate(polygons.begin(), polygons.end(), vtkIdType{ 0 });
  std::vector<std::uint32_t> rank(polygons.size(), 0);
  vtkIdType before = 0;
  for (std::size_t i = 0; i < polygons.size() && all > 0; ++i)
  {
    // By the middle of the cell's own polygons.
    const double part = (static_cast<double>(before) + 0.5 * static_cast<double>(polygons[i])) /
      static_cast<double>(all);
    rank[i] = static_cast<std::uint32_t>(
      std::min(static_cast<double>(ranks - 1), part * static_cast<double>(ranks)));
    before += polygons[i];
  }
  return rank;
}

vtkBoundingBox commonBox(const Ranks& ranks, const std::vector<vtkSmartPointer<vtkPolyData>>& all)
{
  vtkBoundingBox mine;
  for (vtkPolyData* data : all)
  {
    mine.AddBounds(data->GetBounds());
  }
  double bounds[6];
  mine.IsValid() ? mine.GetBounds(bounds) : vtkMath::UninitializeBounds(bounds);
  Packer packer;
  packer.values(bounds, 6);
  vtkBoundingBox box;
  for (const std::string& bytes : ranks.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    box.AddBounds(unpacker.values<double>().data());
  }
  return box;
}

/// The polygons of one piece that go to one rank.
class Parcel
{
public:
  void add(vtkIdType cell, vtkIdType count, const vtkIdType* ids, std::vector<vtkIdType>& newId)
  {
    cells_.push_back(cell);
    sizes_.push_back(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      vtkIdType& id = newId[static_cast<std::size_t>(ids[i])];
      if (id < 0)
      {
        id = static_cast<vtkIdType>(points_.size());
        points_.push_back(ids[i]);
      }
      corners_.push_back(id);
    }
  }

  void pack(vtkPolyData* data, int rank, Packer& packer) const
  {
    auto part = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataType(data->GetPoints()->GetDataType());
    points->SetNumberOfPoints(static_cast<vtkIdType>(points_.size()));
    std::vector<TupleOrigin> ofPoints, ofCells;
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
      points->SetPoint(static_cast<vtkIdType>(i), data->GetPoint(points_[i]));
      ofPoints.push_back({ 0, points_[i] });
    }
    vtkNew<vtkCellArray> polys;
    const vtkIdType* at = corners_.data();
    vtkDataArray* stripCells = data->GetCellData()->GetArray(kStripCell);
    std::vector<int> sourceRank;
    std::vector<vtkIdType> sourceCell;
    for (std::size_t i = 0; i < cells_.size(); ++i)
    {
      polys->InsertNextCell(sizes_[i], at);
      at += sizes_[i];
      ofCells.push_back({ 0, cells_[i] });
      sourceRank.push_back(rank);
      sourceCell.push_back(
        stripCells ? static_cast<vtkIdType>(stripCells->GetComponent(cells_[i], 0)) : cells_[i]);
    }
    part->SetPoints(points);
    part->SetPolys(polys);
    std::vector<std::string> notices; // there is one source, so nothing can differ
    gatherArrays({ data->GetPointData() }, ofPoints, part->GetPointData(), notices);
    gatherArrays({ data->GetCellData() }, ofCells, part->GetCellData(), notices);
    part->GetFieldData()->PassData(data->GetFieldData());
    packSurface(part, packer);
    packer.values(sourceRank);
    packer.values(sourceCell);
  }

private:
  std::vector<vtkIdType> cells_, sizes_, points_, corners_;
};

/// What each rank gets of one piece.
void packPiece(vtkPolyData* data, const std::vector<std::uint32_t>& bins,
  const std::vector<std::uint32_t>& rankOfBin, int rank, std::vector<Packer>& packers)
{
  for (std::size_t target = 0; target < packers.size(); ++target)
  {
    Parcel parcel;
    std::vector<vtkIdType> newId(static_cast<std::size_t>(data->GetNumberOfPoints()), -1);
    std::size_t polygon = 0;
    visitPolygons(data,
      [&](vtkIdType cell, vtkIdType count, const vtkIdType* ids)
      {
        if (rankOfBin[bins[polygon++]] == target)
        {
          parcel.add(cell, count, ids, newId);
        }
      });
    parcel.pack(data, rank, packers[target]);
  }
}

/// What tells points apart: their place, or their global id.
std::array<std::uint64_t, 3> pointKey(
  vtkPolyData* data, vtkIdType point, vtkDataArray* ids, double unit)
{
  if (ids)
  {
    return { static_cast<std::uint64_t>(ids->GetComponent(point, 0)), 0, 0 };
  }
  return placeKey(data, point, unit);
}

/// One piece of parts with common points.
SpreadPiece merge(
  const std::vector<vtkSmartPointer<vtkPolyData>>& parts, vtkPolyData* model, double unit)
{
  struct Use
  {
    std::array<std::uint64_t, 3> key;
    TupleOrigin origin;
  };
  std::vector<Use> uses;
  std::size_t pointCount = 0, cellCount = 0;
  for (vtkPolyData* part : parts)
  {
    pointCount += static_cast<std::size_t>(part->GetNumberOfPoints());
    cellCount += static_cast<std::size_t>(part->GetNumberOfPolys());
  }
  uses.reserve(pointCount);
  std::vector<std::vector<vtkIdType>> joined; // of each part, of each point
  bool inDouble = false;
  vtkDataArray* modelIds = model->GetPointData()->GetGlobalIds();
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    vtkDataArray* ids =
      modelIds ? parts[p]->GetPointData()->GetArray(modelIds->GetName()) : nullptr;
    for (vtkIdType i = 0; i < parts[p]->GetNumberOfPoints(); ++i)
    {
      uses.push_back({ pointKey(parts[p], i, ids, unit), { p, i } });
    }
    joined.emplace_back(static_cast<std::size_t>(parts[p]->GetNumberOfPoints()));
    inDouble = inDouble || parts[p]->GetPoints()->GetDataType() != VTK_FLOAT;
  }
  std::sort(uses.begin(), uses.end(),
    [](const Use& a, const Use& b)
    {
      return std::tie(a.key, a.origin.source, a.origin.tuple) <
        std::tie(b.key, b.origin.source, b.origin.tuple);
    });
  std::vector<TupleOrigin> ofPoints, ofCells;
  ofCells.reserve(cellCount);
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    if (i == 0 || uses[i].key != uses[i - 1].key)
    {
      ofPoints.push_back(uses[i].origin);
    }
    joined[uses[i].origin.source][static_cast<std::size_t>(uses[i].origin.tuple)] =
      static_cast<vtkIdType>(ofPoints.size()) - 1;
  }
  std::vector<Use>().swap(uses);
  SpreadPiece piece;
  piece.data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(inDouble ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(ofPoints.size()));
  for (std::size_t i = 0; i < ofPoints.size(); ++i)
  {
    points->SetPoint(
      static_cast<vtkIdType>(i), parts[ofPoints[i].source]->GetPoint(ofPoints[i].tuple));
  }
  vtkNew<vtkCellArray> polys;
  std::vector<vtkIdType> corners;
  std::vector<vtkDataSetAttributes*> pointData, cellData;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    visitPolygons(parts[p],
      [&](vtkIdType cell, vtkIdType count, const vtkIdType* ids)
      {
        corners.clear();
        for (vtkIdType i = 0; i < count; ++i)
        {
          corners.push_back(joined[p][static_cast<std::size_t>(ids[i])]);
        }
        polys->InsertNextCell(count, corners.data());
        ofCells.push_back({ p, cell });
      });
    pointData.push_back(parts[p]->GetPointData());
    cellData.push_back(parts[p]->GetCellData());
  }
  piece.data->SetPoints(points);
  piece.data->SetPolys(polys);
  gatherInModelsOrder(pointData, ofPoints, model->GetPointData(), piece.data->GetPointData());
  gatherInModelsOrder(cellData, ofCells, model->GetCellData(), piece.data->GetCellData());
  piece.data->GetFieldData()->PassData(parts.front()->GetFieldData());
  return piece;
}

} // namespace

void gatherInModelsOrder(const std::vector<vtkDataSetAttributes*>& sources,
  const std::vector<TupleOrigin>& origins, vtkDataSetAttributes* model,
  vtkDataSetAttributes* target)
{
  vtkNew<vtkPointData> gathered;
  std::vector<std::string> notices; // all have the arrays of the model
  std::vector<vtkDataSetAttributes*> all = sources;
  all.push_back(model); // where there is no source
  gatherArrays(all, origins, gathered, notices);
  for (int i = 0; i < model->GetNumberOfArrays(); ++i)
  {
    target->AddArray(gathered->GetAbstractArray(model->GetAbstractArray(i)->GetName()));
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    if (vtkAbstractArray* active = model->GetAbstractAttribute(type))
    {
      target->SetActiveAttribute(active->GetName(), type);
    }
  }
}

std::size_t estimatedBorder(const SpreadPiece& piece, bool byIds, double unit)
{
  // One of so many edges is looked at, the same in all polygons that have it.
  constexpr std::uint64_t share = 64;
  std::vector<std::uint64_t> numbers(static_cast<std::size_t>(piece.data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    numbers[i] =
      static_cast<std::uint64_t>(pointNumber(piece, static_cast<vtkIdType>(i), byIds, unit)) *
      0x9e3779b97f4a7c15U;
  }
  std::vector<std::uint64_t> edges;
  visitPolygons(piece.data,
    [&](vtkIdType, vtkIdType count, const vtkIdType* ids)
    {
      for (vtkIdType i = 0; i < count; ++i)
      {
        const std::array<vtkIdType, 2> ends{ ids[i], ids[(i + 1) % count] };
        if (std::min(ends[0], ends[1]) < 0 ||
          std::max(ends[0], ends[1]) >= static_cast<vtkIdType>(numbers.size()))
        {
          return; // is refused when the piece is converted
        }
        const std::uint64_t edge = (numbers[static_cast<std::size_t>(ends[0])] +
                                     numbers[static_cast<std::size_t>(ends[1])]) *
          0xbf58476d1ce4e5b9U;
        if ((edge >> 32U) % share == 0)
        {
          edges.push_back(edge);
        }
      }
    });
  std::sort(edges.begin(), edges.end());
  std::size_t alone = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    alone +=
      (i == 0 || edges[i] != edges[i - 1]) && (i + 1 == edges.size() || edges[i] != edges[i + 1])
      ? 1
      : 0;
  }
  return share * alone;
}

std::vector<SpreadPiece> redistributeCells(const Ranks& ranks, std::vector<SpreadPiece> pieces,
  vtkPolyData* model, double unit, SpreadFigures& figures)
{
  std::vector<vtkSmartPointer<vtkPolyData>> data;
  std::vector<std::vector<std::uint32_t>> bins;
  std::vector<vtkIdType> polygons;
  ranks.together("redistributing the surface",
    [&]
    {
      for (SpreadPiece& piece : pieces)
      {
        piece.piece.reset();
        data.push_back(withoutStrips(piece.data));
      }
    });
  const vtkBoundingBox box = commonBox(ranks, data);
  ranks.together("redistributing the surface",
    [&]
    {
      polygons.resize(kCellBins, 0);
      for (vtkPolyData* one : data)
      {
        bins.push_back(binsOf(one, box));
        for (const std::uint32_t bin : bins.back())
        {
          ++polygons[bin];
        }
      }
    });
  ranks.sum(polygons);
  std::vector<std::string> messages(static_cast<std::size_t>(ranks.size()));
  ranks.together("redistributing the surface",
    [&]
    {
      const std::vector<std::uint32_t> rankOfBin = ranksOfBins(polygons, messages.size());
      std::vector<Packer> packers(messages.size());
      for (std::size_t p = 0; p < data.size(); ++p)
      {
        packPiece(data[p], bins[p], rankOfBin, ranks.rank(), packers);
      }
      for (std::size_t r = 0; r < messages.size(); ++r)
      {
        messages[r] = packers[r].take();
        figures.redistributed += static_cast<int>(r) != ranks.rank() ? messages[r].size() : 0;
      }
    });
  pieces.clear();
  data.clear();
  bins.clear();
  releaseFreedMemory();
  std::vector<std::string> received = ranks.exchange(std::move(messages));
  ranks.together("redistributing the surface",
    [&]
    {
      std::vector<vtkSmartPointer<vtkPolyData>> parts;
      std::vector<int> sourceRank;
      std::vector<vtkIdType> sourceCell;
      for (std::string& bytes : received)
      {
        Unpacker unpacker(bytes);
        while (!unpacker.isAtEnd())
        {
          parts.push_back(unpackSurface(unpacker));
          const auto fromRank = unpacker.values<int>();
          const auto fromCell = unpacker.values<vtkIdType>();
          sourceRank.insert(sourceRank.end(), fromRank.begin(), fromRank.end());
          sourceCell.insert(sourceCell.end(), fromCell.begin(), fromCell.end());
        }
        std::string().swap(bytes);
      }
      if (!sourceCell.empty())
      {
        pieces.push_back(merge(parts, model, unit));
        pieces.back().sourceRank = std::move(sourceRank);
        pieces.back().sourceCell = std::move(sourceCell);
        parts.clear();
        releaseFreedMemory();
      }
    });
  return pieces;
}

} // namespace quadrille
