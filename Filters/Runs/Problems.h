// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What has no quads, and where quads are inverted, as VTK data.
#pragma once

#include "Base/Types.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

struct Problems
{
  std::vector<Vector3> failed;    ///< places where the map or the quads have failed
  std::vector<Vector3> inverted;  ///< middles of inverted quads
  vtkPolyData* surface = nullptr; ///< without quads; null: there is none
  bool isWhole = true;            ///< all of it, else these cells
  std::vector<vtkIdType> cells;   ///< ascending
  std::vector<std::string> words; ///< what is told of them
};

/// The mean of the points of a cell.
Vector3 middleOf(vtkPolyData* surface, vtkIdType cell);

/// A vertex for each place and the polygons of the surface, or where it has none its lines and vertices, with the cell
/// array Problem (0 without quads, 1 fails here, 2 inverted) and the field data Words. Empty where there is no problem.
vtkSmartPointer<vtkPolyData> writeProblems(const Problems& problems);

} // namespace quadrille
