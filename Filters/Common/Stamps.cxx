// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Stamps.h"

#include "Mesh/ContentHash.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <string>

namespace quadrille
{

namespace
{

class Stamps
{
public:
  explicit Stamps(bool isOfContents) : isOfContents_(isOfContents) {}

  void add(vtkDataObject* data)
  {
    if (auto* surface = vtkPolyData::SafeDownCast(data))
    {
      addSurface(surface);
    }
    else if (auto* table = vtkTable::SafeDownCast(data))
    {
      addTable(table);
    }
    else
    {
      addObject(data);
    }
  }

  std::vector<Stamp> stamps;

private:
  void addTable(vtkTable* data)
  {
    addAttributes(data->GetRowData());
    addArrays(data->GetFieldData());
  }

  void addSurface(vtkPolyData* data)
  {
    addHolder(data->GetPoints());
    addArray(data->GetPoints() ? data->GetPoints()->GetData() : nullptr);
    for (vtkCellArray* cells :
      { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
    {
      addHolder(cells);
      addArray(cells->GetOffsetsArray());
      addArray(cells->GetConnectivityArray());
    }
    addAttributes(data->GetPointData());
    addAttributes(data->GetCellData());
    addArrays(data->GetFieldData());
  }

  void addObject(vtkObject* object)
  {
    stamps.emplace_back(object, object ? object->GetMTime() : 0);
  }

  /// Of arrays that have stamps of their own.
  void addHolder(vtkObject* object)
  {
    if (!isOfContents_)
    {
      addObject(object);
    }
  }

  void addArray(vtkAbstractArray* array)
  {
    auto* numbers = vtkDataArray::SafeDownCast(array);
    if (!isOfContents_ || !numbers || !numbers->HasStandardMemoryLayout() ||
      numbers->GetDataType() == VTK_BIT)
    {
      addObject(array);
      return;
    }
    const std::string name = numbers->GetName() ? numbers->GetName() : "";
    const auto bytes = static_cast<std::size_t>(numbers->GetNumberOfValues()) *
      static_cast<std::size_t>(numbers->GetDataTypeSize());
    stamps.emplace_back(nullptr, contentHash(name.data(), name.size(), 1));
    stamps.emplace_back(nullptr, numbers->GetDataType());
    stamps.emplace_back(nullptr, numbers->GetNumberOfComponents());
    stamps.emplace_back(nullptr, contentHash(numbers->GetVoidPointer(0), bytes, 1));
  }

  void addArrays(vtkFieldData* arrays)
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      addArray(arrays->GetAbstractArray(i));
    }
    stamps.emplace_back(nullptr, arrays->GetNumberOfArrays());
  }

  /// What arrays are used as is passed on, too.
  void addAttributes(vtkDataSetAttributes* arrays)
  {
    addArrays(arrays);
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      stamps.emplace_back(nullptr, arrays->IsArrayAnAttribute(i) + 1);
    }
  }

  bool isOfContents_;
};

void append(vtkDataObject* data, bool isOfContents, std::vector<Stamp>& stamps)
{
  Stamps added(isOfContents);
  added.add(data);
  stamps.insert(stamps.end(), added.stamps.begin(), added.stamps.end());
}

} // namespace

void addStamps(vtkDataObject* data, std::vector<Stamp>& stamps)
{
  append(data, false, stamps);
}

void addStampsOfContents(vtkDataObject* data, std::vector<Stamp>& stamps)
{
  append(data, true, stamps);
}

} // namespace quadrille
