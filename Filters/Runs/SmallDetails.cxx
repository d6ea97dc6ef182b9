// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/SmallDetails.h"

#include "Common/NewArray.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <initializer_list>

namespace quadrille
{

vtkSmartPointer<vtkPolyData> writeSmallDetails(
  const std::vector<SmallDetail>& details, const std::vector<GivenUpCurve>& features)
{
  auto kind = newArray<vtkStringArray>("Kind");
  auto size = newArray<vtkDoubleArray>("Size");
  auto decision = newArray<vtkStringArray>("Decision");
  auto result = newArray<vtkStringArray>("Result");
  auto decisionId = newArray<vtkIntArray>("DecisionId");
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  const auto add = [&](const Vector3& place, const char* what, double length,
                     DetailDecision decided, const std::string& became)
  {
    const vtkIdType point = points->InsertNextPoint(place.data());
    vertices->InsertNextCell(1, &point);
    kind->InsertNextValue(what);
    size->InsertNextValue(length);
    decision->InsertNextValue(nameOf(decided));
    result->InsertNextValue(became);
    decisionId->InsertNextValue(static_cast<int>(decided));
  };
  for (const SmallDetail& detail : details)
  {
    add(detail.place, nameOf(detail.kind), detail.size, detail.decision, detail.result);
  }
  for (const GivenUpCurve& curve : features)
  {
    add(curve.place, "feature", curve.lengthInQuads, DetailDecision::Simplify,
      whyNotFollowed(curve.reason));
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

} // namespace quadrille
