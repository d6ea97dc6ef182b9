// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/Problems.h"

#include "Common/NewArray.h"
#include "Common/Report.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace quadrille
{
namespace
{

enum Problem
{
  kWithoutQuads,
  kFailsHere,
  kInverted
};

/// What has no polygons is seen by its lines and vertices.
void addWithoutPolygons(vtkPolyData* surface, vtkPolyData* data, vtkCellArray* vertices)
{
  if (surface->GetNumberOfPolys() + surface->GetNumberOfStrips() == 0)
  {
    data->SetLines(surface->GetLines());
    vertices->Append(surface->GetVerts());
  }
}

/// Its polygons and strips, or those of them that are named.
void addSurface(const Problems& problems, vtkPolyData* data)
{
  if (problems.isWhole)
  {
    data->SetPolys(problems.surface->GetPolys());
    data->SetStrips(problems.surface->GetStrips());
    return;
  }
  vtkNew<vtkCellArray> polygons, strips;
  vtkNew<vtkIdList> corners;
  for (const vtkIdType cell : problems.cells)
  {
    problems.surface->GetCellPoints(cell, corners);
    const bool isStrip = problems.surface->GetCellType(cell) == VTK_TRIANGLE_STRIP;
    (isStrip ? strips : polygons)->InsertNextCell(corners);
  }
  data->SetPolys(polygons);
  data->SetStrips(strips);
}

} // namespace

Vector3 middleOf(vtkPolyData* surface, vtkIdType cell)
{
  vtkNew<vtkPolyData> same; // what says where cells begin is not made in the user's
  same->ShallowCopy(surface);
  vtkNew<vtkIdList> points;
  same->GetCellPoints(cell, points);
  Vector3 sum = Vector3::Zero();
  for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i)
  {
    Vector3 point;
    same->GetPoint(points->GetId(i), point.data());
    sum += point;
  }
  return sum / static_cast<double>(points->GetNumberOfIds());
}

vtkSmartPointer<vtkPolyData> writeProblems(const Problems& problems)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  if (problems.failed.empty() && problems.inverted.empty() && !problems.surface)
  {
    return data;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  if (problems.surface && problems.surface->GetPoints())
  {
    points->DeepCopy(problems.surface->GetPoints());
    addSurface(problems, data);
  }
  auto kind = newArray<vtkIntArray>("Problem");
  vtkNew<vtkCellArray> vertices;
  const auto mark = [&](const std::vector<Vector3>& places, Problem problem)
  {
    for (const Vector3& place : places)
    {
      const vtkIdType point = points->InsertNextPoint(place.data());
      vertices->InsertNextCell(1, &point);
      kind->InsertNextValue(problem);
    }
  };
  mark(problems.failed, kFailsHere);
  mark(problems.inverted, kInverted);
  if (problems.surface && problems.isWhole)
  {
    addWithoutPolygons(problems.surface, data, vertices);
  }
  data->SetPoints(points);
  data->SetVerts(vertices);
  while (kind->GetNumberOfValues() < data->GetNumberOfCells())
  {
    kind->InsertNextValue(kWithoutQuads);
  }
  data->GetCellData()->SetScalars(kind);
  addText(data, "Words", problems.words);
  return data;
}

} // namespace quadrille
