// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Stamps.h"

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

namespace quadrille
{

namespace
{

class Stamps
{
public:
  void addWhole(vtkDataObject* data) { add(data); }

  void addTable(vtkTable* data)
  {
    addAttributes(data->GetRowData());
    addArrays(data->GetFieldData());
  }

  void addSurface(vtkPolyData* data)
  {
    add(data->GetPoints());
    add(data->GetPoints() ? data->GetPoints()->GetData() : nullptr);
    for (vtkCellArray* cells :
      { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
    {
      add(cells);
      add(cells->GetOffsetsArray());
      add(cells->GetConnectivityArray());
    }
    addAttributes(data->GetPointData());
    addAttributes(data->GetCellData());
    addArrays(data->GetFieldData());
  }

  std::vector<Stamp> stamps;

private:
  void add(vtkObject* object) { stamps.emplace_back(object, object ? object->GetMTime() : 0); }

  void addArrays(vtkFieldData* arrays)
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      add(arrays->GetAbstractArray(i));
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
};

} // namespace

void addStamps(vtkDataObject* data, std::vector<Stamp>& stamps)
{
  Stamps added;
  if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    added.addSurface(surface);
  }
  else if (auto* table = vtkTable::SafeDownCast(data))
  {
    added.addTable(table);
  }
  else
  {
    added.addWhole(data);
  }
  stamps.insert(stamps.end(), added.stamps.begin(), added.stamps.end());
}

} // namespace quadrille
