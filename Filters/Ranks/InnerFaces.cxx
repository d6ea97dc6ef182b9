// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/InnerFaces.h"

#include "Convert/Pieces.h"
#include "Ranks/Polygons.h"
#include "Ranks/SpreadArrays.h"
#include "Ranks/SpreadCells.h"

#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace quadrille
{

namespace
{

/// The boxes of the pieces of all other ranks, and of the other pieces of this one, a little larger.
std::vector<std::vector<vtkBoundingBox>> boxesOfOthers(
  const Ranks& ranks, const std::vector<SpreadPiece>& pieces, double unit)
{
  Packer packer;
  packer.count(pieces.size());
  for (const SpreadPiece& piece : pieces)
  {
    packer.values(piece.data->GetBounds(), 6);
  }
  std::vector<std::vector<vtkBoundingBox>> others(pieces.size());
  const std::vector<std::string> all = ranks.gather(packer.bytes());
  for (std::size_t r = 0; r < all.size(); ++r)
  {
    Unpacker unpacker(all[r]);
    const std::uint64_t count = unpacker.count();
    for (std::uint64_t i = 0; i < count; ++i)
    {
      vtkBoundingBox box(unpacker.values<double>().data());
      box.Inflate(2 * unit);
      for (std::size_t p = 0; p < pieces.size(); ++p)
      {
        if (static_cast<int>(r) != ranks.rank() || p != i)
        {
          others[p].push_back(box);
        }
      }
    }
  }
  return others;
}

/// Faces of volume cells that may be those of another piece, too, in the order of visitPolygons, and a number of each:
/// the same for the same points, whatever the order.
struct InnerFaces
{
  std::vector<vtkIdType> cells;
  std::vector<std::uint64_t> numbers;

  InnerFaces(
    const SpreadPiece& piece, const std::vector<vtkBoundingBox>& others, bool byIds, double unit)
  {
    visitPolygons(piece.data,
      [&](vtkIdType cell, vtkIdType count, const vtkIdType* ids)
      {
        if (!piece.ofVolume || piece.ofVolume->GetComponent(cell, 0) == 0)
        {
          return;
        }
        vtkBoundingBox box;
        for (vtkIdType i = 0; i < count; ++i)
        {
          box.AddPoint(piece.data->GetPoint(ids[i]));
        }
        if (std::none_of(others.begin(), others.end(),
              [&box](const vtkBoundingBox& other) { return other.Intersects(box) != 0; }))
        {
          return;
        }
        std::uint64_t number = 0;
        for (vtkIdType i = 0; i < count; ++i)
        {
          const auto point = static_cast<std::uint64_t>(pointNumber(piece, ids[i], byIds, unit));
          number += (point ^ (point >> 31U)) * 0x9e3779b97f4a7c15U;
        }
        cells.push_back(cell);
        numbers.push_back(number);
      });
  }
};

/// The piece without some of its polygons, ascending; other cells go, too.
void removePolygons(SpreadPiece& piece, const std::vector<vtkIdType>& removed)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkCellArray> polys;
  std::vector<TupleOrigin> ofCells;
  visitPolygons(piece.data,
    [&](vtkIdType cell, vtkIdType count, const vtkIdType* ids)
    {
      if (!std::binary_search(removed.begin(), removed.end(), cell))
      {
        polys->InsertNextCell(count, ids);
        ofCells.push_back({ 0, cell });
      }
    });
  data->SetPoints(piece.data->GetPoints());
  data->SetPolys(polys);
  data->GetPointData()->PassData(piece.data->GetPointData());
  data->GetFieldData()->PassData(piece.data->GetFieldData());
  gatherInModelsOrder(
    { piece.data->GetCellData() }, ofCells, piece.data->GetCellData(), data->GetCellData());
  piece.data = data;
}

} // namespace

void dropInnerFaces(const Ranks& ranks, std::vector<SpreadPiece>& pieces, bool byIds, double unit,
  std::vector<std::string>& notices)
{
  bool hasVolumes = false;
  for (const SpreadPiece& piece : pieces)
  {
    hasVolumes = hasVolumes || (piece.ofVolume && piece.ofVolume->GetRange(0)[1] > 0);
  }
  std::vector<vtkIdType> count{ hasVolumes ? 1 : 0 };
  ranks.sum(count);
  if (count[0] == 0)
  {
    return;
  }
  const auto others = boxesOfOthers(ranks, pieces, unit);
  std::vector<InnerFaces> faces;
  std::vector<std::vector<std::uint64_t>> numbers;
  ranks.together("the faces of volumes",
    [&]
    {
      for (std::size_t p = 0; p < pieces.size(); ++p)
      {
        faces.emplace_back(pieces[p], others[p], byIds, unit);
        numbers.push_back(faces.back().numbers);
      }
    });
  const std::vector<std::vector<std::uint8_t>> isShared = findShared(ranks, numbers);
  count[0] = 0;
  ranks.together("the faces of volumes",
    [&]
    {
      for (std::size_t p = 0; p < pieces.size(); ++p)
      {
        std::vector<vtkIdType> removed;
        for (std::size_t i = 0; i < isShared[p].size(); ++i)
        {
          if (isShared[p][i] != 0)
          {
            removed.push_back(faces[p].cells[i]);
          }
        }
        count[0] += static_cast<vtkIdType>(removed.size());
        if (!removed.empty())
        {
          removePolygons(pieces[p], removed);
        }
        pieces[p].ofVolume = nullptr;
      }
      pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                     [](const SpreadPiece& piece) {
                       return piece.data->GetNumberOfPolys() + piece.data->GetNumberOfStrips() == 0;
                     }),
        pieces.end());
    });
  ranks.sum(count);
  if (count[0] > 0)
  {
    notices.push_back(
      std::to_string(count[0]) + " faces where volumes meet were left out, counted on both sides");
  }
}

} // namespace quadrille
