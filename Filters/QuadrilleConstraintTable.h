// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A word on each constraint: whether the quads do what was asked for, by how much not, and why not.
#pragma once

#include "QuadrilleArrayConstraints.h"
#include "QuadrilleConstraints.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataArray;
class vtkTable;

namespace quadrille
{

/// All that was asked of one surface.
struct AskedConstraints
{
  ArrayConstraints arrays;
  std::vector<PlacedConstraint> placed;
  std::vector<CurveOutcome> curves; ///< of the run, see PlacedConstraint::curve; empty before
};

/// A row of the table. What could not be measured is not a number.
struct ConstraintWord
{
  const char* kind = "";
  vtkIdType source = -1;
  Vector3 place = Vector3::Zero(); ///< where it deviates most
  bool isMet = false;
  double deviation = 0;
  double deviation95 = 0; ///< the 95th percentile of what deviation is the mean of
  const char* unit = "";
  std::string reason; ///< empty where it is met
};

/// mesh: what was made, without quads where there are none. sizes: the array Sizing at its points, or null. In the
/// order of the input: arrays of the surface (guides, curves, valences, sizes), then what was drawn.
std::vector<ConstraintWord> judgeConstraints(
  const AskedConstraints& asked, const QuadMesh& mesh, vtkDataArray* sizes);

/// Of the words, those on what was drawn, in their order: whether it is met.
std::vector<bool> metOfDrawn(
  const std::vector<ConstraintWord>& words, const AskedConstraints& asked);

/// Columns Id (0, 1, ...), Kind, SourceId, X, Y, Z, Met (0 or 1), Deviation, Deviation95, Unit, Reason. See
/// vtkQuadRemesh.
vtkSmartPointer<vtkTable> writeConstraintTable(const std::vector<ConstraintWord>& words);

} // namespace quadrille
