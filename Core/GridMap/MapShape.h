// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The shape that the map should give a triangle: itself, seen in the frame of the field.
#pragma once

#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"
#include "Numerics/Untangler.h"

namespace quadrille
{

/// Appends face f to the problem: its points, its reference (in units of edgeLength, in the chart of the face turned
/// by `quarterTurns`) and its weight, which is its area in quads.
void addTriangle(UntangleProblem& problem, const std::array<Index, 3>& points, const Mesh& mesh,
  const CrossField& field, Index f, int quarterTurns, double edgeLength);

} // namespace quadrille
