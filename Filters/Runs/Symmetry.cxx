// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/Symmetry.h"

#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/PolyData.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <set>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

constexpr int kMirrorPlane = 10; ///< of the array Constraint

void addTuple(vtkPolyData* data, const char* name, std::initializer_list<double> values)
{
  auto array = newArray<vtkDoubleArray>(name, static_cast<int>(values.size()), 1);
  int component = 0;
  for (const double value : values)
  {
    array->SetComponent(0, component++, value);
  }
  data->GetFieldData()->AddArray(array);
}

/// Edges of which each point is its own image; of quads that are their own image the line between the middles of their
/// two edges across the plane.
std::vector<std::array<Vector3, 2>> linesInPlane(const QuadMesh& quads, const MadeSymmetry& made)
{
  const auto image = [&made](Index p) { return made.mirrorPoint[p]; };
  std::set<std::pair<Index, Index>> edges;
  std::vector<std::array<Vector3, 2>> lines;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    for (std::size_t i = 0; i < quad.size(); ++i)
    {
      const Index a = quad[i], b = quad[(i + 1) % quad.size()];
      const Index c = quad[(i + 2) % quad.size()], d = quad[(i + 3) % quad.size()];
      if (image(a) == a && image(b) == b && edges.insert(std::minmax(a, b)).second)
      {
        lines.push_back({ quads.points[a], quads.points[b] });
      }
      if (image(a) == d && image(b) == c && a < d)
      {
        lines.push_back(
          { (quads.points[a] + quads.points[d]) / 2, (quads.points[b] + quads.points[c]) / 2 });
      }
    }
  }
  return lines;
}

} // namespace

void addSymmetry(vtkPolyData* quads, const MadeSymmetry& made)
{
  const std::vector<Index>& imageOf = made.rotation ? made.rotatedPoint : made.mirrorPoint;
  auto image = newArray<vtkIdTypeArray>(
    made.rotation ? arrays::kRotatedPoint : arrays::kMirrorPoint, 1, imageOf.size());
  for (std::size_t p = 0; p < imageOf.size(); ++p)
  {
    image->SetValue(static_cast<vtkIdType>(p), imageOf[p]);
  }
  quads->GetPointData()->AddArray(image);
  const auto addVector = [&](const char* name, const Vector3& vector) {
    addTuple(quads, name, { vector.x(), vector.y(), vector.z() });
  };
  if (made.rotation)
  {
    addVector("SymmetryOrigin", made.rotation->axis.origin);
    addVector("SymmetryDirection", made.rotation->axis.direction);
    addCount(quads, "SymmetryOrder", static_cast<std::size_t>(made.rotation->order));
  }
  else
  {
    addVector("SymmetryOrigin", made.plane.origin);
    addVector("SymmetryNormal", made.plane.normal);
  }
  addTuple(quads, "SymmetryDeviation",
    { made.deviation.rms / made.diagonal, made.deviation.maximum / made.diagonal });
  addCount(quads, "SymmetryMovedPoints", made.movedPoints);
  addNumber(quads, "SymmetryFarthestMoved", made.farthestMoved / made.diagonal);
}

void addMirrorLines(
  vtkPolyData* constraints, const QuadMesh& quads, const MadeSymmetry& made, bool isMet)
{
  if (made.rotation)
  {
    return;
  }
  const std::vector<std::array<Vector3, 2>> lines = linesInPlane(quads, made);
  const auto appendZero = [](vtkDataSetAttributes* attributes)
  {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = attributes->GetArray(i);
      const std::vector<double> zero(static_cast<std::size_t>(array->GetNumberOfComponents()), 0);
      array->InsertNextTuple(zero.data());
    }
  };
  for (const std::array<Vector3, 2>& line : lines)
  {
    constraints->GetLines()->InsertNextCell(2);
    for (const Vector3& p : line)
    {
      constraints->GetLines()->InsertCellPoint(constraints->GetPoints()->InsertNextPoint(p.data()));
      appendZero(constraints->GetPointData());
    }
    vtkCellData* cells = constraints->GetCellData();
    appendZero(cells);
    const vtkIdType cell = cells->GetArray("Met")->GetNumberOfTuples() - 1;
    cells->GetArray("Met")->SetComponent(cell, 0, isMet ? 1 : 0);
    cells->GetArray("Constraint")->SetComponent(cell, 0, kMirrorPlane);
    cells->GetArray("SourceId")->SetComponent(cell, 0, -1);
  }
}

} // namespace quadrille
