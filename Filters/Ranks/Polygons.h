// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A walk through the polygons of a surface.
#pragma once

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

namespace quadrille
{

/// Calls visit(cell, number of corners, ids of the corners).
template <class Visit>
void visitPolygons(vtkPolyData* data, const Visit& visit)
{
  const vtkIdType first = data->GetNumberOfVerts() + data->GetNumberOfLines();
  auto cells = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    visit(first + cells->GetCurrentCellId(), count, ids);
  }
}

} // namespace quadrille
