// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The whole values that linear forms can take together, exactly.
#pragma once

#include "Numerics/ExactElimination.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// A lattice and coordinates in it: any whole coordinates give whole values of all forms, and every set of whole
/// values that the forms can take comes from whole coordinates.
struct IntegerLattice
{
  std::vector<IntegerRow> forms; ///< per form: sum of coefficient * coordinate, whole
  /// Per coordinate: the sum of factor * form that it is, over the forms that were given. Mostly one form.
  std::vector<std::vector<std::pair<Index, double>>> coordinates;
  /// Per coordinate: not a form itself, but what tells the allowed values of one once others are known.
  std::vector<std::uint8_t> composite;
};

/// forms: linear forms of `variables` real variables. Independent forms become coordinates, as far as possible those
/// without a flag in `derived` (#forms); where another form is a fraction of them, not all of their whole values are
/// allowed, and a coordinate is changed so that the rest is, one prime factor of a denominator at a time.
/// Empty when a coefficient would leave 63 bits.
std::optional<IntegerLattice> integerLattice(Index variables,
  const std::vector<ExactBasis::Row>& forms, const std::vector<std::uint8_t>& derived);

} // namespace quadrille
