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

namespace
{

const char* whyNotFollowed(FeatureLoss reason)
{
  switch (reason)
  {
    case FeatureLoss::NoCrease:
      return "not followed: its curve is no crease as a whole";
    case FeatureLoss::ShortArc:
      return "not followed: it ends at an arc that is too short for a quad";
    case FeatureLoss::FailedMap:
      return "not followed: with it there was no map, or no quads";
    case FeatureLoss::MidLine:
      return "not followed: it lies in the mirror plane, which quads straddle";
    default:
      return "not followed: too short, too tangled or too near another one";
  }
}

} // namespace

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
