// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PlaceText.h"
#include "Evaluation/LinesInQuads.h"
#include "Evaluation/QuadPlaces.h"
#include "QuadrilleConstraints.h"
#include "QuadrilleNewArray.h"

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

/// The search for them is worth its time only then.
bool asksForValences(const std::vector<PlacedConstraint>& placed)
{
  return std::any_of(placed.begin(), placed.end(),
    [](const PlacedConstraint& constraint) { return constraint.kind == ConstraintKind::Valence; });
}

} // namespace

std::vector<std::string> missedValences(
  const std::vector<PlacedConstraint>& placed, const QuadMesh& mesh)
{
  std::vector<std::string> missed;
  if (mesh.quads.empty() || !asksForValences(placed))
  {
    return missed;
  }
  const ReachedValences reached(mesh);
  for (const PlacedConstraint& constraint : placed)
  {
    const bool asks = constraint.kind == ConstraintKind::Valence && constraint.whyNot.empty();
    const int there = asks ? reached.at(constraint.path.front()) : 0;
    if (asks && there != constraint.valence)
    {
      missed.push_back("valence " + std::to_string(constraint.valence) + " was asked for at " +
        placeText(constraint.path.front()) + ", but the quads have " + std::to_string(there) +
        " there: move the point away from sharp edges and other points, or ask for smaller quads");
    }
  }
  return missed;
}

vtkSmartPointer<vtkPolyData> writeConstraints(const std::vector<PlacedConstraint>& placed,
  const std::vector<CurveOutcome>& outcomes, const QuadMesh& mesh)
{
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
  const QuadMesh none;
  const ReachedValences reached(asksForValences(placed) ? mesh : none);
  const LinesInQuads chains(std::any_of(placed.begin(), placed.end(), isLine) ? mesh : none);
  const auto add = [&](const PlacedConstraint& constraint, vtkCellArray* cells)
  {
    const bool point = constraint.kind == ConstraintKind::Valence;
    const int there = point ? reached.at(constraint.path.front()) : 0;
    const std::vector<Vector3> chain =
      isLine(constraint) ? chains.chainOf(constraint, outcomes) : std::vector<Vector3>{};
    const std::vector<Vector3>& path = chain.empty() ? constraint.path : chain;
    const bool isMet = isLine(constraint) ? !chain.empty() : !point || there == constraint.valence;
    cells->InsertNextCell(static_cast<int>(path.size()));
    for (std::size_t i = 0; i < path.size(); ++i)
    {
      cells->InsertCellPoint(points->InsertNextPoint(path[i].data()));
      direction->InsertNextTuple(directionAt(path, i).data());
    }
    kind->InsertNextValue(static_cast<int>(constraint.kind) + (isMet ? 0 : kMissed));
    source->InsertNextValue(constraint.source);
    distance->InsertNextValue(constraint.distance);
    weight->InsertNextValue(constraint.weight);
    asked->InsertNextValue(constraint.valence);
    valence->InsertNextValue(there);
  };
  // Vertices come before lines in the order of cells.
  for (const PlacedConstraint& constraint : placed)
  {
    if (constraint.kind == ConstraintKind::Valence)
    {
      add(constraint, verts);
    }
  }
  for (const PlacedConstraint& constraint : placed)
  {
    if (constraint.kind != ConstraintKind::Valence && constraint.path.size() > 1)
    {
      add(constraint, lines);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(verts);
  data->SetLines(lines);
  data->GetPointData()->AddArray(direction);
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ kind, source, distance, weight, asked, valence })
  {
    data->GetCellData()->AddArray(array);
  }
  data->GetCellData()->SetActiveScalars("Constraint");
  return data;
}

} // namespace quadrille
