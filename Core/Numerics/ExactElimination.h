// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sparse elimination of homogeneous linear equations over the integers, without rounding.
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// A sum of coefficient * variable.
using IntegerRow = std::vector<std::pair<Index, std::int64_t>>;

/// All solutions of the equations: variable i = (sum numerators * free variable) / denominator.
struct ExactBasis
{
  struct Row
  {
    IntegerRow numerators; ///< by id of the free variable (0, 1, ... in `free`), ascending
    std::int64_t denominator = 1;
  };
  std::vector<Row> rows;   ///< one per variable
  std::vector<Index> free; ///< the variables that stayed free, ascending
  /// Per free variable: when all are multiples of theirs, every variable is an integer.
  std::vector<std::int64_t> step;
};

/// Solves `equations` (each = 0) for as many variables as their rank. The shortest equation goes first and
/// is solved for the variable that the fewest other equations use, which keeps the rows short. Terms of an
/// equation may repeat a variable. Empty when a coefficient would leave 63 bits.
/// rank: empty, or one number a variable: an equation is solved for a variable of the lowest rank that it has, so that
/// those of higher ranks depend on each other only. Rows of variables of rank 0 that were solved for stay empty then.
std::optional<ExactBasis> eliminateExactly(Index variables,
  const std::vector<IntegerRow>& equations, const std::vector<std::uint8_t>& rank = {});

} // namespace quadrille
