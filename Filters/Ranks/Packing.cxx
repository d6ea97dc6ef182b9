// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Packing.h"

#include "Common/NewArray.h"
#include "Ranks/Ranks.h"

#include <vtkAbstractArray.h>
#include <vtkBitArray.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace quadrille
{

namespace
{

std::size_t valueCount(vtkAbstractArray* array)
{
  return static_cast<std::size_t>(array->GetNumberOfTuples() * array->GetNumberOfComponents());
}

void packValues(vtkAbstractArray* array, Packer& packer)
{
  const std::size_t count = valueCount(array);
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      packer.text(strings->GetValue(static_cast<vtkIdType>(i)));
    }
  }
  else if (auto* bits = vtkBitArray::SafeDownCast(array))
  {
    std::vector<std::uint8_t> values(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      values[i] = static_cast<std::uint8_t>(bits->GetValue(static_cast<vtkIdType>(i)));
    }
    packer.values(values);
  }
  else
  {
    const auto bytes = count * static_cast<std::size_t>(array->GetDataTypeSize());
    packer.values(
      static_cast<const std::uint8_t*>(count > 0 ? array->GetVoidPointer(0) : nullptr), bytes);
  }
}

void unpackValues(Unpacker& unpacker, vtkAbstractArray* array)
{
  const std::size_t count = valueCount(array);
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      strings->SetValue(static_cast<vtkIdType>(i), unpacker.text());
    }
    return;
  }
  const auto bytes = unpacker.values<std::uint8_t>();
  if (auto* bits = vtkBitArray::SafeDownCast(array))
  {
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
      bits->SetValue(static_cast<vtkIdType>(i), bytes[i]);
    }
  }
  else if (!bytes.empty())
  {
    std::memcpy(array->GetVoidPointer(0), bytes.data(), bytes.size());
  }
}

} // namespace

bool canBePacked(vtkAbstractArray* array)
{
  return vtkDataArray::SafeDownCast(array) || vtkStringArray::SafeDownCast(array);
}

void packArrays(vtkFieldData* data, Packer& packer)
{
  std::vector<vtkAbstractArray*> arrays;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    if (canBePacked(data->GetAbstractArray(i)))
    {
      arrays.push_back(data->GetAbstractArray(i));
    }
  }
  packer.count(arrays.size());
  for (vtkAbstractArray* array : arrays)
  {
    packer.text(array->GetName() ? array->GetName() : "");
    packer.count(static_cast<std::uint64_t>(array->GetDataType()));
    packer.count(static_cast<std::uint64_t>(array->GetNumberOfComponents()));
    packer.count(array->HasAComponentName() ? 1 : 0);
    for (int c = 0; array->HasAComponentName() && c < array->GetNumberOfComponents(); ++c)
    {
      packer.text(array->GetComponentName(c) ? array->GetComponentName(c) : "");
    }
    packer.count(static_cast<std::uint64_t>(array->GetNumberOfTuples()));
    packValues(array, packer);
  }
}

void unpackArrays(Unpacker& unpacker, vtkFieldData* data)
{
  const std::uint64_t count = unpacker.count();
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::string name = unpacker.text();
    auto array =
      vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(static_cast<int>(unpacker.count())));
    array->SetName(name.c_str());
    array->SetNumberOfComponents(static_cast<int>(unpacker.count()));
    const bool hasNames = unpacker.count() != 0;
    for (int c = 0; hasNames && c < array->GetNumberOfComponents(); ++c)
    {
      array->SetComponentName(c, unpacker.text().c_str());
    }
    array->SetNumberOfTuples(static_cast<vtkIdType>(unpacker.count()));
    unpackValues(unpacker, array);
    data->AddArray(array);
  }
}

void packSurface(vtkPolyData* surface, Packer& packer)
{
  vtkPoints* points = surface->GetPoints();
  const auto pointCount = static_cast<std::size_t>(surface->GetNumberOfPoints());
  const bool inFloat = points && points->GetDataType() == VTK_FLOAT;
  packer.count(inFloat ? 1 : 0);
  std::vector<float> floats;
  std::vector<double> doubles;
  for (std::size_t i = 0; i < pointCount; ++i)
  {
    double x[3];
    points->GetPoint(static_cast<vtkIdType>(i), x);
    for (const double coordinate : x)
    {
      if (inFloat)
      {
        floats.push_back(static_cast<float>(coordinate));
      }
      else
      {
        doubles.push_back(coordinate);
      }
    }
  }
  if (inFloat)
  {
    packer.values(floats);
  }
  else
  {
    packer.values(doubles);
  }
  std::vector<std::uint32_t> sizes;
  std::vector<vtkIdType> corners;
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    sizes.push_back(static_cast<std::uint32_t>(count));
    corners.insert(corners.end(), ids, ids + count);
  }
  packer.values(sizes);
  packer.values(corners);
  packArrays(surface->GetPointData(), packer);
  packArrays(surface->GetCellData(), packer);
  packArrays(surface->GetFieldData(), packer);
}

vtkSmartPointer<vtkPolyData> unpackSurface(Unpacker& unpacker)
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  const auto fill = [&](const auto& coordinates)
  {
    points->SetNumberOfPoints(static_cast<vtkIdType>(coordinates.size() / 3));
    for (std::size_t i = 0; i < coordinates.size() / 3; ++i)
    {
      points->SetPoint(static_cast<vtkIdType>(i), static_cast<double>(coordinates[3 * i]),
        static_cast<double>(coordinates[3 * i + 1]), static_cast<double>(coordinates[3 * i + 2]));
    }
  };
  if (unpacker.count() != 0)
  {
    points->SetDataTypeToFloat();
    fill(unpacker.values<float>());
  }
  else
  {
    points->SetDataTypeToDouble();
    fill(unpacker.values<double>());
  }
  const auto sizes = unpacker.values<std::uint32_t>();
  const auto corners = unpacker.values<vtkIdType>();
  auto offsets = newArray<vtkIdTypeArray>("", 1, sizes.size() + 1);
  auto connectivity = newArray<vtkIdTypeArray>("", 1, corners.size());
  vtkIdType at = 0;
  offsets->SetValue(0, 0);
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    at += static_cast<vtkIdType>(sizes[i]);
    offsets->SetValue(static_cast<vtkIdType>(i + 1), at);
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    connectivity->SetValue(static_cast<vtkIdType>(i), corners[i]);
  }
  vtkNew<vtkCellArray> polys;
  polys->SetData(offsets.Get(), connectivity.Get());
  surface->SetPoints(points);
  surface->SetPolys(polys);
  unpackArrays(unpacker, surface->GetPointData());
  unpackArrays(unpacker, surface->GetCellData());
  unpackArrays(unpacker, surface->GetFieldData());
  return surface;
}

} // namespace quadrille
