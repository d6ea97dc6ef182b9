// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Newton's method on energies of a triangle that depend on its Jacobian J by F = |J|^2 and D = det J only.
#pragma once

#include "Numerics/ReducedTriangles.h"

namespace quadrille
{

/// Derivatives of E(F, D).
struct IsotropicDerivatives
{
  double f = 0, d = 0, fd = 0, dd = 0, ff = 0;
};

/// Gradient by J, and the Hessian projected to positive semidefinite.
void deriveByJacobian(const Jacobian& j, const IsotropicDerivatives& energy, Jacobian& gradient,
  Eigen::Matrix4d& hessian);

inline double determinantOf(const Jacobian& j)
{
  return j[0] * j[3] - j[1] * j[2];
}

/// What a triangle pays whose singular values have a ratio r beyond a limit. With the excess e = (r + 1/r) / 2 - bound,
/// where (r + 1/r) / 2 = |J|^2 / (2 det), it is 2 weight k^2 (sqrt(1 + (e/k)^2) - 1): weight e^2 at first, so that its
/// first derivative is continuous, and linear further on, so that a triangle that cannot meet the limit does not drag
/// its neighbours beyond it.
struct RatioEnergy
{
  double weight = 0;
  double bound = 0;   ///< (limit + 1/limit) / 2
  double knee = 0.02; ///< k

  /// The others pay nothing; those without a positive determinant have no ratio.
  bool applies(const Jacobian& j) const
  {
    const double d = determinantOf(j);
    return d > 0 && j.squaredNorm() > 2 * bound * d;
  }
  /// Where it applies.
  double value(const Jacobian& j) const;
  /// Gradient, and Hessian projected to positive semidefinite; where it applies.
  void derivatives(const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const;
};

/// What a triangle pays where a direction of its reference is not on an axis of the map: 2 weight k^2
/// (sqrt(1 + (c/k)^2) - 1) of the component c off the axis, about weight c^2 up to the knee k and linear further on, so
/// that directions that no map has do not tear the rest along.
struct AxisEnergy
{
  double weight = 0;
  double knee = 0.2; ///< k

  double value(double off) const;
  /// Of a triangle with the component off.dot(j): adds to the gradient and to the Hessian by J, which is never
  /// negative.
  void addDerivatives(
    const Jacobian& off, const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const;
};

} // namespace quadrille
