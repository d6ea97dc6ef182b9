// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What VTK 9.1 (Debian's) lacks and the VTK of ParaView 5.11 has. Each is a pair of templates: the first one is left
/// out where the class lacks the function, the second one does the same with what VTK 9.1 has.
#pragma once

#include <vtkIdList.h>
#include <vtkType.h>

namespace quadrille
{

/// The corners of a cell: `count` ids, valid as long as the cells and `copy` are. Several threads may ask, each with a
/// `copy` of its own.
template <class CellArray>
auto getCorners(CellArray* cells, vtkIdType cell, vtkIdType& count, const vtkIdType*& ids,
  vtkIdList* copy) -> decltype(cells->GetCellAtId(cell, count, ids, copy))
{
  cells->GetCellAtId(cell, count, ids, copy);
}
template <class CellArray, class... None>
void getCorners(CellArray* cells, vtkIdType cell, vtkIdType& count, const vtkIdType*& ids,
  vtkIdList* copy, None...)
{
  cells->GetCellAtId(cell, copy);
  count = copy->GetNumberOfIds();
  ids = copy->GetPointer(0);
}

/// Whether the filter was asked to stop; by VTK 9.2 on also where a filter below it was.
template <class Algorithm>
auto isAskedToStop(Algorithm* algorithm) -> decltype(algorithm->CheckAbort())
{
  return algorithm->CheckAbort();
}
template <class Algorithm, class... None>
bool isAskedToStop(Algorithm* algorithm, None...)
{
  return algorithm->GetAbortExecute() != 0;
}

/// As if nobody had asked.
template <class Algorithm>
auto forgetStop(Algorithm* algorithm) -> decltype(algorithm->SetAbortOutput(false))
{
  algorithm->SetAbortExecute(0);
  algorithm->SetAbortOutput(false);
}
template <class Algorithm, class... None>
void forgetStop(Algorithm* algorithm, None...)
{
  algorithm->SetAbortExecute(0);
}

} // namespace quadrille
