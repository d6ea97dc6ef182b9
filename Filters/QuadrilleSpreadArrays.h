// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the ranks of a spread surface agree on: the arrays of its pieces, and the points that several pieces have.
#pragma once

#include "QuadrilleSpread.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Gives all pieces the same arrays in the same order. Where a piece lacks one that others have, 0 stands for it (1 for
/// factors); arrays that differ in type or components, that have no name or cannot be sent are left behind. Both are
/// told. Returns the arrays without tuples. Collective.
vtkSmartPointer<vtkPolyData> agreeOnArrays(
  const Ranks& ranks, std::vector<SpreadPiece>& pieces, std::vector<std::string>& notices);

/// received: of each rank, lists of numbers, one for each of its pieces. Returns for each rank lists of the same sizes:
/// 1 where another list has the number, too.
std::vector<std::string> sharedOf(const std::vector<std::string>& received);

} // namespace quadrille
