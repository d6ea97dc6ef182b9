// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Symmetric quads as VTK data.
#pragma once

#include "Constraints/ConstraintTable.h"
#include "Symmetry/Symmetry.h"

class vtkPolyData;

namespace quadrille
{

/// MirrorPoint or RotatedPoint on points; field data: SymmetryOrigin, SymmetryNormal or SymmetryDirection and
/// SymmetryOrder, SymmetryDeviation, SymmetryMovedPoints, SymmetryFarthestMoved, see vtkQuadRemesh.
void addSymmetry(vtkPolyData* quads, const MadeSymmetry& made);

/// The edges of the quads in the mirror plane, or the mid-lines of those across it, as lines of the output Constraints
/// (see writeConstraints): Constraint 10, SourceId -1, all else 0. Of a rotation none.
void addMirrorLines(
  vtkPolyData* constraints, const QuadMesh& quads, const MadeSymmetry& made, bool isMet);

} // namespace quadrille
