// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A map is solved again near a few places, and held everywhere else.
#pragma once

#include "Numerics/Untangler.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct LocalProblem
{
  UntangleProblem problem;
  std::vector<Index> unknowns;  ///< of the whole problem, which its own are
  std::vector<Index> triangles; ///< likewise

  /// The unknowns of the whole with those of this problem in place of its own.
  Eigen::VectorXd put(const Eigen::VectorXd& local, Eigen::VectorXd y) const;
};

/// isNear: per point of the whole. The unknowns that move one of these are free, the others are held at y; the
/// triangles are all that the free ones move. Directions of the whole (offAxis) are left out. Throws InvalidInput when
/// sizes disagree.
LocalProblem localProblem(
  const UntangleProblem& whole, const Eigen::VectorXd& y, const std::vector<std::uint8_t>& isNear);

} // namespace quadrille
