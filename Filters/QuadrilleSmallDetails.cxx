// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleSmallDetails.h"

#include "QuadrilleNewArray.h"
#include "QuadrilleReport.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <initializer_list>

namespace quadrille
{

vtkSmartPointer<vtkPolyData> writeSmallDetails(const std::vector<SmallDetail>& details)
{
  auto kind = newArray<vtkStringArray>("Kind");
  auto size = newArray<vtkDoubleArray>("Size");
  auto decision = newArray<vtkStringArray>("Decision");
  auto result = newArray<vtkStringArray>("Result");
  auto decisionId = newArray<vtkIntArray>("DecisionId");
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (const SmallDetail& detail : details)
  {
    const vtkIdType point = points->InsertNextPoint(detail.place.data());
    vertices->InsertNextCell(1, &point);
    kind->InsertNextValue(nameOf(detail.kind));
    size->InsertNextValue(detail.size);
    decision->InsertNextValue(nameOf(detail.decision));
    result->InsertNextValue(detail.result);
    decisionId->InsertNextValue(static_cast<int>(detail.decision));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(vertices);
  for (vtkAbstractArray* array :
    std::initializer_list<vtkAbstractArray*>{ kind, size, decision, result, decisionId })
  {
    data->GetPointData()->AddArray(array);
  }
  return data;
}

void addAttempts(vtkDataObject* data, const std::vector<std::string>& attempts)
{
  addCount(data, "Attempts", attempts.size());
  std::vector<std::string> names;
  auto counts = newArray<vtkIdTypeArray>("RecoveryCounts");
  for (std::size_t i = 1; i < attempts.size(); ++i)
  {
    const std::string& step = attempts[i];
    if (std::find(names.begin(), names.end(), step) == names.end())
    {
      names.push_back(step);
      counts->InsertNextValue(
        static_cast<vtkIdType>(std::count(attempts.begin(), attempts.end(), step)));
    }
  }
  addText(data, "RecoveryNames", names);
  data->GetFieldData()->AddArray(counts);
}

} // namespace quadrille
