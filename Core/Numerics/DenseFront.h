// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Elimination in the dense matrices that a sparse one is taken apart into.
#pragma once

#include <cstddef>
#include <vector>

namespace quadrille
{

/// The first `own` columns of a symmetric matrix with a right side as its last row are eliminated. left: rows by own;
/// right: the remaining lower triangle, (rows - own) by (rows - own - 1).
bool eliminate(
  std::vector<double>& left, std::vector<double>& right, std::size_t rows, std::size_t own);

} // namespace quadrille
