// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Rounding of some linear forms of the unknowns of a quadratic energy to whole numbers.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace quadrille
{

enum class RoundingOrder
{
  OneAtATime, ///< the form nearest to a whole number first, all others then as the energy wants [Bommes et al. 2009]
  AllAtOnce   ///< from the values of the minimum [Kalberer et al. 2007]
};

struct RoundedForms
{
  std::vector<std::int64_t> value;
  /// The minimum with these values is y + A^-1 C multiplier, where y is the minimum without.
  Eigen::VectorXd multiplier;
};

/// schur: k x k, C^T A^-1 C for the Hessian A of the energy and k independent forms, the columns of C; x: k, their
/// values at the minimum. Those with a flag in `last` (#k) wait until the others are whole. No system is solved
/// again: each rounding is one column of a Cholesky factorization of schur. k^3 / 3 operations; looks out for a stop.
/// Throws InvalidInput for sizes that disagree or a matrix that is not positive definite.
RoundedForms roundForms(const Eigen::MatrixXd& schur, const Eigen::VectorXd& x,
  const std::vector<std::uint8_t>& last, RoundingOrder order);

} // namespace quadrille
