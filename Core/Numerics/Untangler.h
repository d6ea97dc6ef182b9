// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Injective planar maps under linear constraints: the energy of [Garanzha et al. 2021] minimized by
/// Newton's method in reduced unknowns.
#pragma once

#include "Base/Progress.h"
#include "Base/Types.h"
#include "Base/WorkCount.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace quadrille
{

/// Point p of the map has coordinates x(2p), x(2p+1) with x = basis * y + offset; the unknowns y are
/// free, so every linear constraint holds by construction.
struct UntangleProblem
{
  Eigen::SparseMatrix<double> basis; ///< 2 #points by #unknowns
  Eigen::VectorXd offset;            ///< 2 #points
  std::vector<std::array<Index, 3>>
    triangles; ///< point ids, counterclockwise where the map is valid
  /// Per triangle the inverse of [r1 - r0, r2 - r0], r its wanted shape in the wanted orientation and size; the
  /// Jacobian is J = [x1 - x0, x2 - x0] * inverseReference, ideally a unit matrix.
  std::vector<Eigen::Matrix2d> inverseReference;
  std::vector<double> weight; ///< per triangle, usually its area; > 0
  /// Empty, or for the first triangles the derivative by J, column after column, of the component of a direction's
  /// image off its axis, times the square root of the direction's weight; zero: no direction.
  std::vector<Eigen::Vector4d> offAxis;
};

struct UntangleOptions
{
  int maximumSteps = 200;
  /// Steps that polish after every determinant has become positive; more follow until one lessens the energy by a
  /// smaller share than leastGain.
  int polishSteps = 8;
  double leastGain = kInfinity;
  /// Weight of the area term against the angle term.
  double areaWeight = 0.05;
  /// Weight of |J - 1|^2, which keeps the map rotated like the references; 0: rotations cost nothing.
  double alignmentWeight = 0;
  /// The ratio of the singular values of J up to which it costs nothing, >= 1; 0: no limit. Triangles beyond it pay a
  /// RatioEnergy once all determinants are positive.
  double anisotropyLimit = 0;
  /// Triangles from this one on have no limit.
  std::size_t limitedTriangles = std::numeric_limits<std::size_t>::max();
  /// Weight of the directions of the problem once all determinants are positive, see AxisEnergy; 0: they cost nothing.
  double axisWeight = 0;
  ProgressCallback progress;
};

struct UntangleResult
{
  Eigen::VectorXd y;
  std::vector<Index> inverted; ///< triangles with !(det > 0), worst first; empty on success
  int steps = 0;
  /// As counted by countWork(), of the triangles and of the factorizations: global unknowns, as surfaces of high genus
  /// have, fill the factor, and these then take far more than the triangles.
  std::size_t work = 0;
};

/// Thrown by untangle() in place of WorkSpent: how far it came.
class UntanglingSpent : public WorkSpent
{
public:
  explicit UntanglingSpent(Eigen::VectorXd last) : y(std::move(last)) {}
  Eigen::VectorXd y; ///< the unknowns
};

/// The unknowns that minimize sum weight |J - 1|^2, whatever the signs of the determinants (the Poisson
/// equation of a parametrization). Throws InvalidInput when sizes disagree.
Eigen::VectorXd fitReferences(const UntangleProblem& problem);

/// Throws InvalidInput when sizes disagree, y0 has a non-finite entry or the anisotropy limit is neither 0 nor a number
/// from 1 on.
/// Deterministic.
UntangleResult untangle(
  const UntangleProblem& problem, const Eigen::VectorXd& y0, const UntangleOptions& options);

} // namespace quadrille
