// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A word on each constraint: whether the quads do what was asked for, by how much not, and why not.
#pragma once

#include "Evaluation/ConstraintWords.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkDataArray;
class vtkTable;

namespace quadrille
{

/// The first component of each tuple; empty for null.
std::vector<double> valuesOf(vtkDataArray* array);

/// Columns Id (0, 1, ...), Kind, SourceId, X, Y, Z, Met (0 or 1), Deviation, Deviation95, Unit, Reason, Remark. See
/// vtkQuadRemesh.
vtkSmartPointer<vtkTable> writeConstraintTable(const std::vector<ConstraintWord>& words);

} // namespace quadrille
