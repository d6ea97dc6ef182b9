// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Surfaces.h"

#include "Base/Refuse.h"
#include "Base/Types.h"
#include "Convert/Pieces.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{

namespace
{

/// Dimensions of cells by type.
class CellDimensions
{
public:
  CellDimensions()
  {
    dimensions_.fill(0);
    for (int type = 1; type < VTK_NUMBER_OF_CELL_TYPES; ++type)
    {
      // Numbers between the kinds of cells are of none.
      if (vtkCell* known = vtkGenericCell::InstantiateCell(type))
      {
        dimensions_[static_cast<std::size_t>(type)] = known->GetCellDimension();
        known->Delete();
      }
    }
  }
  int of(int type) const { return dimensions_.at(static_cast<std::size_t>(type)); }

private:
  std::array<int, VTK_NUMBER_OF_CELL_TYPES> dimensions_;
};

std::size_t volumeCells(vtkDataSet* data, const CellDimensions& dimensions)
{
  std::size_t count = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    count += dimensions.of(data->GetCellType(i)) == 3;
  }
  return count;
}

bool hasAnything(vtkDataObject* data)
{
  return cellCount(data) > 0 || (data && data->GetFieldData()->GetNumberOfArrays() > 0);
}

/// Marks the faces that come from volume cells of the data set.
void markFaces(vtkPolyData* surface, vtkDataSet* data, const CellDimensions& dimensions)
{
  vtkNew<vtkUnsignedCharArray> marks;
  marks->SetName(kVolumeFace);
  marks->SetNumberOfValues(surface->GetNumberOfCells());
  vtkDataArray* cells = surface->GetCellData()->GetArray("vtkOriginalCellIds");
  for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i)
  {
    const auto cell = static_cast<vtkIdType>(cells->GetTuple1(i));
    marks->SetValue(i, dimensions.of(data->GetCellType(cell)) == 3);
  }
  surface->GetCellData()->AddArray(marks);
}

/// 0 where a corner is no point; whoever takes the surface refuses it.
double triangleArea(vtkPolyData* surface, vtkIdType i, vtkIdType j, vtkIdType k)
{
  const vtkIdType points = surface->GetNumberOfPoints();
  if (std::min({ i, j, k }) < 0 || std::max({ i, j, k }) >= points)
  {
    return 0;
  }
  Vector3 a, b, c;
  surface->GetPoint(i, a.data());
  surface->GetPoint(j, b.data());
  surface->GetPoint(k, c.data());
  return 0.5 * (b - a).cross(c - a).norm();
}

/// Number of cells that stand for cells of other pieces, or for finer cells.
std::size_t ghostCells(vtkDataSet* data)
{
  vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
  std::size_t count = 0;
  for (vtkIdType i = 0; ghosts && i < ghosts->GetNumberOfValues(); ++i)
  {
    constexpr int ghost = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL |
      vtkDataSetAttributes::REFINEDCELL;
    count += (ghosts->GetValue(i) & ghost) != 0;
  }
  return count;
}

} // namespace

std::vector<std::string> SurfaceCounts::notices() const
{
  std::vector<std::string> texts;
  if (volumeCells > 0)
  {
    texts.push_back("the surface of " + std::to_string(volumeCells) + " volume cells was taken");
  }
  if (ghostCells > 0)
  {
    texts.push_back(std::to_string(ghostCells) + " ghost cells were left out");
  }
  return texts;
}

std::size_t cellCount(vtkDataObject* data)
{
  auto* set = vtkDataSet::SafeDownCast(data);
  return set ? static_cast<std::size_t>(set->GetNumberOfCells()) : 0;
}

vtkSmartPointer<vtkPolyData> surfaceOf(
  vtkDataObject* data, bool markVolumeFaces, SurfaceCounts& counts)
{
  auto* set = vtkDataSet::SafeDownCast(data);
  if (!set)
  {
    refuse("a ", data->GetClassName(), " has no surface");
  }
  const std::size_t ghosts = ghostCells(set);
  counts.ghostCells += ghosts;
  vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(data);
  if (!surface)
  {
    vtkNew<vtkDataSetSurfaceFilter> filter;
    filter->SetInputData(set);
    filter->SetPieceInvariant(0);
    filter->PassThroughCellIdsOn();
    filter->PassThroughPointIdsOn();
    filter->Update();
    surface = filter->GetOutput();
    const CellDimensions dimensions;
    counts.volumeCells += volumeCells(set, dimensions);
    if (markVolumeFaces)
    {
      markFaces(surface, set, dimensions);
    }
  }
  if (ghosts > 0)
  {
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->ShallowCopy(surface);
    copy->RemoveGhostCells();
    surface = copy;
  }
  return surface;
}

vtkSmartPointer<vtkDataObject> onlyPiece(const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  vtkSmartPointer<vtkDataObject> found;
  for (const vtkSmartPointer<vtkDataObject>& piece : pieces)
  {
    if (found && hasAnything(found) && hasAnything(piece))
    {
      refuse(
        "the input comes in several pieces; take the output of a filter of Quadrille as it is");
    }
    if (!found || hasAnything(piece))
    {
      found = piece;
    }
  }
  return found;
}

double areaOf(vtkPolyData* surface)
{
  double area = 0;
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i)
    {
      area += triangleArea(surface, ids[0], ids[i - 1], ids[i]);
    }
  }
  auto strips = vtk::TakeSmartPointer(surface->GetStrips()->NewIterator());
  for (strips->GoToFirstCell(); !strips->IsDoneWithTraversal(); strips->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    strips->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i)
    {
      area += triangleArea(surface, ids[i - 2], ids[i - 1], ids[i]);
    }
  }
  return std::isfinite(area) ? area : 0;
}

} // namespace quadrille
