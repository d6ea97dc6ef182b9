// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Blocks/Shared.h"

#include "Blocks/BlockRun.h"
#include "Convert/Pieces.h"
#include "Ranks/Ranks.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace quadrille
{

namespace
{

/// A vtkPolyData that is put together from points and cells of others.
class Assembly
{
public:
  explicit Assembly(const std::vector<vtkSmartPointer<vtkPolyData>>& sources) : sources_(sources) {}

  /// A cell with its points, as a cell of this kind.
  void addCell(std::size_t source, vtkIdType cell, int kind, const std::vector<vtkIdType>& points)
  {
    std::vector<vtkIdType> ids;
    for (const vtkIdType point : points)
    {
      ids.push_back(addPoint(source, point));
    }
    cells_[kind]->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    cellOrigins_[kind].push_back({ source, cell });
  }

  vtkIdType addPoint(std::size_t source, vtkIdType point)
  {
    const auto [found, isNew] =
      ids_.emplace(std::pair(source, point), static_cast<vtkIdType>(pointOrigins_.size()));
    if (isNew)
    {
      pointOrigins_.push_back({ source, point });
    }
    return found->second;
  }

  vtkSmartPointer<vtkPolyData> write(std::vector<std::string>& notices) const
  {
    if (pointOrigins_.empty())
    {
      return nullptr;
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const TupleOrigin& origin : pointOrigins_)
    {
      points->InsertNextPoint(sources_[origin.source]->GetPoint(origin.tuple));
    }
    data->SetPoints(points);
    data->SetVerts(cells_[0]);
    data->SetLines(cells_[1]);
    data->SetPolys(cells_[2]);
    std::vector<TupleOrigin> cellOrigins;
    for (const std::vector<TupleOrigin>& ofKind : cellOrigins_)
    {
      cellOrigins.insert(cellOrigins.end(), ofKind.begin(), ofKind.end());
    }
    std::vector<vtkDataSetAttributes*> pointData, cellData;
    for (vtkPolyData* source : sources_)
    {
      pointData.push_back(source->GetPointData());
      cellData.push_back(source->GetCellData());
    }
    gatherArrays(pointData, pointOrigins_, data->GetPointData(), notices);
    gatherArrays(cellData, cellOrigins, data->GetCellData(), notices);
    data->GetFieldData()->PassData(sources_[0]->GetFieldData());
    return data;
  }

private:
  std::vector<vtkSmartPointer<vtkPolyData>> sources_;
  std::map<std::pair<std::size_t, vtkIdType>, vtkIdType> ids_;
  std::vector<TupleOrigin> pointOrigins_;
  std::array<vtkNew<vtkCellArray>, 3> cells_; ///< vertices, lines, polygons
  std::array<std::vector<TupleOrigin>, 3> cellOrigins_;
};

std::vector<vtkIdType> pointsOf(vtkPolyData* data, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  data->GetCellPoints(cell, ids);
  return { ids->begin(), ids->end() };
}

/// 0 vertices, 1 lines, 2 polygons and strips, by the order of cells in a vtkPolyData.
int kindOf(vtkPolyData* data, vtkIdType cell)
{
  const vtkIdType lines = data->GetNumberOfVerts();
  return cell < lines ? 0 : cell < lines + data->GetNumberOfLines() ? 1 : 2;
}

struct Item
{
  vtkIdType cell =
    -1; ///< a line or polygon, or the vertex cell of a single point; -1: a point without cell
  std::vector<vtkIdType> points;
};

/// Vertex cells may hold many points, which need not belong together.
std::vector<Item> itemsOf(vtkPolyData* data)
{
  std::vector<Item> items;
  std::vector<bool> isUsed(static_cast<std::size_t>(data->GetNumberOfPoints()), false);
  for (const bool ofVertices : { false, true })
  {
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
    {
      if ((kindOf(data, cell) == 0) != ofVertices)
      {
        continue;
      }
      const std::vector<vtkIdType> points = pointsOf(data, cell);
      for (const vtkIdType point : points)
      {
        isUsed[static_cast<std::size_t>(point)] = true;
        if (ofVertices)
        {
          items.push_back({ cell, { point } });
        }
      }
      if (!ofVertices)
      {
        items.push_back({ cell, points });
      }
    }
  }
  for (std::size_t point = 0; point < isUsed.size(); ++point)
  {
    if (!isUsed[point])
    {
      items.push_back({ -1, { static_cast<vtkIdType>(point) } });
    }
  }
  return items;
}

} // namespace

vtkSmartPointer<vtkPolyData> joinShared(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces, std::vector<std::string>& notices)
{
  std::vector<vtkSmartPointer<vtkPolyData>> parts;
  for (vtkDataObject* piece : pieces)
  {
    if (auto* part = vtkPolyData::SafeDownCast(piece); part && part->GetNumberOfPoints() > 0)
    {
      parts.emplace_back(part);
    }
  }
  if (parts.size() < 2)
  {
    return parts.empty() ? nullptr : parts[0];
  }
  Assembly assembly(parts);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (vtkIdType cell = 0; cell < parts[p]->GetNumberOfCells(); ++cell)
    {
      assembly.addCell(p, cell, kindOf(parts[p], cell), pointsOf(parts[p], cell));
    }
    for (vtkIdType point = 0; point < parts[p]->GetNumberOfPoints(); ++point)
    {
      assembly.addPoint(p, point);
    }
  }
  return assembly.write(notices);
}

std::size_t sharedItems(vtkPolyData* shared)
{
  return shared ? itemsOf(shared).size() : 0;
}

std::vector<double> itemDistances(vtkPolyData* shared, vtkPolyData* surface)
{
  const std::vector<Item> items = itemsOf(shared);
  std::vector<double> distances(items.size(), std::numeric_limits<double>::infinity());
  if (!surface || surface->GetNumberOfCells() == 0)
  {
    return distances;
  }
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    double sum = 0;
    for (const vtkIdType point : items[i].points)
    {
      double x[3], closest[3], squared = 0;
      shared->GetPoint(point, x);
      vtkIdType cell = -1;
      int part = 0;
      locator->FindClosestPoint(x, closest, cell, part, squared);
      sum += std::sqrt(squared);
    }
    distances[i] = sum / static_cast<double>(items[i].points.size());
  }
  return distances;
}

vtkSmartPointer<vtkPolyData> selectItems(vtkPolyData* shared, const std::vector<bool>& isChosen)
{
  const std::vector<Item> items = itemsOf(shared);
  Assembly assembly({ shared });
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    if (isChosen[i] && items[i].cell >= 0)
    {
      assembly.addCell(0, items[i].cell, kindOf(shared, items[i].cell), items[i].points);
    }
    else if (isChosen[i])
    {
      assembly.addPoint(0, items[i].points[0]);
    }
  }
  std::vector<std::string> notices; // one source has no arrays that differ
  return assembly.write(notices);
}

//------------------------------------------------------------------------------
void shareOut(BlockRun& run)
{
  for (std::size_t port = 0; port < run.shared.size(); ++port)
  {
    auto* shared = vtkPolyData::SafeDownCast(run.shared[port]);
    if (!shared)
    {
      continue;
    }
    if (run.works.size() == 1)
    {
      run.works[0].block.inputs[port] = shared;
      continue;
    }
    const std::size_t items = sharedItems(shared);
    Packer packer;
    for (const BlockWork& work : run.works)
    {
      packer.count(run.owns(work));
      if (run.owns(work))
      {
        for (const double distance : itemDistances(shared, work.block.input()))
        {
          packer.number(distance);
        }
      }
    }
    // Of several surfaces at the same distance the first one.
    std::vector<double> least(items, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> nearest(items, 0);
    const std::vector<std::string> all = run.ranks.gather(packer.bytes());
    std::vector<Unpacker> unpackers(all.begin(), all.end());
    for (std::size_t w = 0; w < run.works.size(); ++w)
    {
      run.works[w].isChanged = true; // it may have got what another one had
      for (Unpacker& unpacker : unpackers)
      {
        const bool isThere = unpacker.count() != 0;
        for (std::size_t i = 0; isThere && i < items; ++i)
        {
          const double distance = unpacker.number();
          if (distance < least[i])
          {
            least[i] = distance;
            nearest[i] = w;
          }
        }
      }
    }
    for (std::size_t w = 0; w < run.works.size(); ++w)
    {
      std::vector<bool> isChosen(items, false);
      for (std::size_t i = 0; i < items; ++i)
      {
        isChosen[i] = nearest[i] == w;
      }
      if (run.owns(run.works[w]))
      {
        run.works[w].block.inputs[port] = selectItems(shared, isChosen);
      }
    }
  }
}

} // namespace quadrille
