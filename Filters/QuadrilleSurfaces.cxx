// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleSurfaces.h"

#include "QuadrilleRefuse.h"

#include <vtkAppendPolyData.h>
#include <vtkCleanPolyData.h>
#include <vtkDataSet.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <array>

namespace quadrille
{

namespace
{

std::size_t volumeCells(vtkDataSet* data)
{
  std::array<int, VTK_NUMBER_OF_CELL_TYPES> dimensions;
  dimensions.fill(-1);
  vtkNew<vtkGenericCell> cell;
  std::size_t count = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    const int type = data->GetCellType(i);
    int& dimension = dimensions[static_cast<std::size_t>(type)];
    if (dimension < 0)
    {
      cell->SetCellType(type);
      dimension = cell->GetCellDimension();
    }
    count += dimension == 3;
  }
  return count;
}

bool hasAnything(vtkDataObject* data)
{
  return hasCells(data) || (data && data->GetFieldData()->GetNumberOfArrays() > 0);
}

vtkSmartPointer<vtkPolyData> append(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
{
  vtkNew<vtkAppendPolyData> all;
  for (vtkPolyData* piece : pieces)
  {
    all->AddInputData(piece);
  }
  all->Update();
  return all->GetOutput();
}

} // namespace

bool hasCells(vtkDataObject* data)
{
  auto* set = vtkDataSet::SafeDownCast(data);
  return set && set->GetNumberOfCells() > 0;
}

vtkSmartPointer<vtkPolyData> surfaceOf(vtkDataObject* data, std::vector<std::string>& notices)
{
  if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    return surface;
  }
  auto* set = vtkDataSet::SafeDownCast(data);
  if (!set)
  {
    refuse("a ", data->GetClassName(), " has no surface");
  }
  vtkNew<vtkDataSetSurfaceFilter> filter;
  filter->SetInputData(set);
  filter->SetPieceInvariant(0);
  filter->PassThroughCellIdsOn();
  filter->PassThroughPointIdsOn();
  filter->Update();
  if (const std::size_t volumes = volumeCells(set))
  {
    notices.push_back("the surface of " + std::to_string(volumes) + " volume cells was taken: " +
      std::to_string(filter->GetOutput()->GetNumberOfPolys()) + " faces");
  }
  return filter->GetOutput();
}

vtkSmartPointer<vtkPolyData> joinSurface(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces, std::vector<std::string>& notices)
{
  std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
  for (vtkDataObject* piece : pieces)
  {
    if (hasCells(piece) || pieces.size() == 1)
    {
      surfaces.push_back(surfaceOf(piece, notices));
    }
  }
  if (surfaces.size() < 2)
  {
    return surfaces.empty() ? nullptr : surfaces[0];
  }
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(append(surfaces));
  clean->SetTolerance(0);
  clean->Update();
  return clean->GetOutput();
}

vtkSmartPointer<vtkDataObject> joinExact(const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  vtkSmartPointer<vtkDataObject> found;
  for (const vtkSmartPointer<vtkDataObject>& piece : pieces)
  {
    if (found && hasAnything(found) && hasAnything(piece))
    {
      refuse("the input comes in several pieces; take the output of a filter of Quadrille as it is");
    }
    if (!found || hasAnything(piece))
    {
      found = piece;
    }
  }
  return found;
}

vtkSmartPointer<vtkDataObject> joinShared(const BlockTree& tree)
{
  std::vector<vtkSmartPointer<vtkPolyData>> parts;
  for (const auto& [path, node] : tree)
  {
    for (vtkDataObject* piece : node.pieces)
    {
      if (auto* part = vtkPolyData::SafeDownCast(piece); part && part->GetNumberOfPoints() > 0)
      {
        parts.emplace_back(part);
      }
    }
  }
  return parts.empty() ? nullptr : parts.size() == 1 ? parts[0] : append(parts);
}

} // namespace quadrille
