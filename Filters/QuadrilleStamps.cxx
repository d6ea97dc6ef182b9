// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleStamps.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformationVector.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace quadrille
{

namespace
{

class Stamps
{
public:
  void addData(vtkPolyData* data)
  {
    add(data ? data->GetPoints() : nullptr);
    if (!data)
    {
      return;
    }
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

std::vector<Stamp> stampsOf(vtkInformationVector** inputs, int ports)
{
  Stamps result;
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      result.addData(vtkPolyData::GetData(inputs[port], i));
    }
    result.stamps.emplace_back(nullptr, inputs[port]->GetNumberOfInformationObjects());
  }
  return result.stamps;
}

} // namespace quadrille
