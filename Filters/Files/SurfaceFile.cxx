// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/SurfaceFile.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkType.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

namespace quadrille
{

namespace
{

int vtkTypeOf(NumberType type)
{
  switch (type)
  {
    case NumberType::Int8:
      return VTK_SIGNED_CHAR;
    case NumberType::UInt8:
      return VTK_UNSIGNED_CHAR;
    case NumberType::Int16:
      return VTK_SHORT;
    case NumberType::UInt16:
      return VTK_UNSIGNED_SHORT;
    case NumberType::Int32:
      return VTK_INT;
    case NumberType::UInt32:
      return VTK_UNSIGNED_INT;
    case NumberType::Int64:
      return VTK_TYPE_INT64;
    case NumberType::Float32:
      return VTK_FLOAT;
    default:
      return VTK_DOUBLE;
  }
}

void takeOver(NumberArray& numbers, vtkDataArray* array)
{
  const std::size_t values = numbers.rows() * numbers.components();
  array->SetNumberOfComponents(static_cast<int>(numbers.components()));
  array->SetVoidArray(numbers.release().release(), static_cast<vtkIdType>(values), 0,
    vtkAbstractArray::VTK_DATA_ARRAY_FREE);
}

vtkSmartPointer<vtkDataArray> arrayOf(NumberArray& numbers)
{
  auto array = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(vtkTypeOf(numbers.type())));
  takeOver(numbers, array);
  return array;
}

template <class Ids>
vtkSmartPointer<vtkCellArray> cellsOf(FileCells& from)
{
  vtkNew<Ids> offsets, ids;
  takeOver(from.offsets, offsets);
  takeOver(from.ids, ids);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets.Get(), ids.Get());
  return cells;
}

vtkSmartPointer<vtkCellArray> cellsOf(FileCells& from)
{
  return from.offsets.type() == NumberType::Int32 ? cellsOf<vtkTypeInt32Array>(from)
                                                  : cellsOf<vtkTypeInt64Array>(from);
}

void addFileArrays(std::vector<FileArray>& arrays, vtkDataSetAttributes* target)
{
  for (FileArray& from : arrays)
  {
    auto array = arrayOf(from.numbers);
    array->SetName(from.name.c_str());
    target->AddArray(array);
    if (from.role != ArrayRole::None)
    {
      target->SetActiveAttribute(from.name.c_str(),
        from.role == ArrayRole::Normals     ? vtkDataSetAttributes::NORMALS
          : from.role == ArrayRole::Colours ? vtkDataSetAttributes::SCALARS
                                            : vtkDataSetAttributes::TCOORDS);
    }
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> polyDataOf(SurfaceFile file)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(arrayOf(file.points));
  data->SetPoints(points);
  if (!file.polygons.empty())
  {
    data->SetPolys(cellsOf(file.polygons));
  }
  if (!file.strips.empty())
  {
    data->SetStrips(cellsOf(file.strips));
  }
  addFileArrays(file.pointData, data->GetPointData());
  addFileArrays(file.cellData, data->GetCellData());
  return data;
}

} // namespace quadrille
