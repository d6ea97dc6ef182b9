// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What differs between the versions of VTK, from 9.1 to 9.6; Documentation/Installation.md lists them. A pair of
/// templates: the first one is left out where the class lacks the function, the second one does the same with what the
/// other version has. So a version between two releases, which ParaView brings, is no case of its own.
#pragma once

#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

namespace quadrille
{

/// Offsets or corners of cells whose values lie one after the other in memory: the array itself, or a copy. Up to VTK
/// 9.5 a vtkCellArray has no others; in that of 9.6 offsets may be computed (all its filters that make triangles only
/// have such) and both may be arrays of any class and type.
inline vtkSmartPointer<vtkDataArray> plainIds(vtkDataArray* ids)
{
  switch (ids->GetDataType())
  {
    case VTK_INT:
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE:
      if (ids->HasStandardMemoryLayout())
      {
        return ids;
      }
      break;
    default:
      break;
  }
  auto copy = vtkSmartPointer<vtkIdTypeArray>::New();
  copy->DeepCopy(ids);
  return copy;
}

/// Calls body with a pointer to the values of what plainIds has returned, and returns what it returns.
template <class Body>
auto withIds(vtkDataArray* plain, const Body& body)
{
  void* values = plain->GetVoidPointer(0);
  switch (plain->GetDataType())
  {
    case VTK_INT:
      return body(static_cast<const int*>(values));
    case VTK_LONG:
      return body(static_cast<const long*>(values));
    case VTK_LONG_LONG:
      return body(static_cast<const long long*>(values));
    default:
      return body(static_cast<const vtkIdType*>(values));
  }
}

/// The number of grids of a level of a vtkUniformGridAMR. By VTK 9.6 on it is a vtkPartitionedDataSetCollection with a
/// level in each partitioned data set, and its functions of before are deprecated.
template <class Levels>
auto gridCount(Levels* levels, unsigned level)
  -> decltype(levels->GetPartitionedDataSet(level)->GetNumberOfPartitions())
{
  const auto grids = levels->GetPartitionedDataSet(level);
  return grids ? grids->GetNumberOfPartitions() : 0;
}
template <class Levels, class... None>
unsigned gridCount(Levels* levels, unsigned level, None...)
{
  return levels->GetNumberOfDataSets(level);
}

/// A grid of a level, null where another rank has it.
template <class Levels>
auto gridOf(Levels* levels, unsigned level, unsigned i)
  -> decltype(levels->GetPartitionedDataSet(level)->GetPartition(i))
{
  return levels->GetPartitionedDataSet(level)->GetPartition(i);
}
template <class Levels, class... None>
auto gridOf(Levels* levels, unsigned level, unsigned i, None...)
{
  return levels->GetDataSet(level, i);
}

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
