// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/NewArray.h"
#include "Constraints/Constraints.h"
#include "Evaluation/ConstraintMeasures.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>

namespace quadrille
{

namespace
{

/// Beside the kinds: what is not met, one above its kind.
constexpr int kMissed = 1;

/// Along the path at its point i.
Vector3 directionAt(const std::vector<Vector3>& path, std::size_t i)
{
  const Vector3 along = path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1];
  return along.norm() > 0 ? Vector3(along.normalized()) : Vector3(Vector3::Zero());
}

bool asksForValence(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Valence || constraint.kind == ConstraintKind::Move;
}

/// Where it is shown as a vertex; nowhere if it is a line.
std::optional<Vector3> vertexOf(const PlacedConstraint& constraint)
{
  if (constraint.kind == ConstraintKind::Move && constraint.whyNot.empty())
  {
    return constraint.path.back();
  }
  return asksForValence(constraint) || constraint.path.size() == 1
    ? std::optional<Vector3>(constraint.path.front())
    : std::nullopt;
}

} // namespace

vtkSmartPointer<vtkPolyData> writeConstraints(
  const std::vector<PlacedConstraint>& placed, const QuadMesh& mesh, const std::vector<bool>& isMet)
{
  auto met = newArray<vtkIntArray>("Met");
  auto kind = newArray<vtkIntArray>("Constraint");
  auto source = newArray<vtkIdTypeArray>("SourceId");
  auto distance = newArray<vtkDoubleArray>("Distance");
  auto weight = newArray<vtkDoubleArray>(arrays::kGuidingWeight);
  auto asked = newArray<vtkIntArray>(arrays::kTargetValence);
  auto valence = newArray<vtkIntArray>(arrays::kValence);
  auto direction = newArray<vtkDoubleArray>("Direction", 3);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> verts;
  vtkNew<vtkCellArray> lines;
  ConstraintMeasures measures(mesh);
  const auto add = [&](std::size_t i, const std::vector<Vector3>& path, vtkCellArray* cells)
  {
    const PlacedConstraint& constraint = placed[i];
    const bool hasTwoCodes =
      constraint.kind != ConstraintKind::Feature && constraint.kind != ConstraintKind::Stroke;
    cells->InsertNextCell(static_cast<int>(path.size()));
    for (std::size_t k = 0; k < path.size(); ++k)
    {
      cells->InsertCellPoint(points->InsertNextPoint(path[k].data()));
      direction->InsertNextTuple(directionAt(path, k).data());
    }
    met->InsertNextValue(isMet.at(i) ? 1 : 0);
    kind->InsertNextValue(
      static_cast<int>(constraint.kind) + (hasTwoCodes && !isMet.at(i) ? kMissed : 0));
    source->InsertNextValue(constraint.source);
    distance->InsertNextValue(constraint.distance);
    weight->InsertNextValue(constraint.weight);
    asked->InsertNextValue(constraint.valence);
    valence->InsertNextValue(
      asksForValence(constraint) ? measures.valenceShown(path.front(), constraint.valence) : 0);
  };
  // Vertices come before lines in the order of cells.
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (const std::optional<Vector3> vertex = vertexOf(placed[i]))
    {
      add(i, { *vertex }, verts);
    }
  }
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (!vertexOf(placed[i]) && placed[i].path.size() > 1)
    {
      const std::optional<LineInQuads> found =
        isLine(placed[i]) && isMet.at(i) ? measures.lineInQuads(placed[i]) : std::nullopt;
      add(i, found ? found->chain : placed[i].path, lines);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(verts);
  data->SetLines(lines);
  data->GetPointData()->AddArray(direction);
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ met, kind, source, distance, weight, asked, valence })
  {
    data->GetCellData()->AddArray(array);
  }
  data->GetCellData()->SetActiveScalars("Met");
  return data;
}

} // namespace quadrille
