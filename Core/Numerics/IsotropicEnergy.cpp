// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/IsotropicEnergy.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// The nearest positive semidefinite [a b; b c].
void clampToPositive(double& a, double& b, double& c)
{
  const double mean = (a + c) / 2;
  const double radius = std::hypot((a - c) / 2, b);
  const double low = mean - radius;
  const double high = mean + radius;
  if (low >= 0)
  {
    return;
  }
  if (high <= 0)
  {
    a = b = c = 0;
    return;
  }
  // high * q q^T with the unit eigenvector q of `high`: q q^T = (M - low) / (high - low).
  const double factor = high / (high - low);
  a = (a - low) * factor;
  b *= factor;
  c = (c - low) * factor;
}

} // namespace

void deriveByJacobian(const Jacobian& j, const IsotropicDerivatives& energy, Jacobian& gradient,
  Eigen::Matrix4d& hessian)
{
  // J = similarity + antisimilarity: orthonormal coordinates p and q with F = |p|^2 + |q|^2,
  // D = (|p|^2 - |q|^2) / 2. The Hessian is diagonal across p and across q and couples only the
  // two directions along them, so that its projection is a closed form.
  const double s = std::sqrt(0.5);
  const Jacobian cofactor(j[3], -j[2], -j[1], j[0]);
  const double p0 = s * (j[0] + j[3]), p1 = s * (j[1] - j[2]);
  const double q0 = s * (j[0] - j[3]), q1 = s * (j[1] + j[2]);
  const double p = std::hypot(p0, p1), q = std::hypot(q0, q1);
  const double pc = p > 0 ? p0 / p : 1, ps = p > 0 ? p1 / p : 0;
  const double qc = q > 0 ? q0 / q : 1, qs = q > 0 ? q1 / q : 0;
  const Jacobian alongP(s * pc, s * ps, -s * ps, s * pc),
    acrossP(-s * ps, s * pc, -s * pc, -s * ps);
  const Jacobian alongQ(s * qc, s * qs, s * qs, -s * qc), acrossQ(-s * qs, s * qc, s * qc, s * qs);

  double app = 2 * energy.f + energy.d + 4 * energy.fd * p * p + energy.dd * p * p;
  double apq = -energy.dd * p * q;
  double aqq = 2 * energy.f - energy.d - 4 * energy.fd * q * q + energy.dd * q * q;
  if (energy.ff != 0)
  {
    app += 4 * energy.ff * p * p;
    apq += 4 * energy.ff * p * q;
    aqq += 4 * energy.ff * q * q;
  }
  clampToPositive(app, apq, aqq);

  gradient = 2 * energy.f * j + energy.d * cofactor;
  hessian.noalias() = std::max(0.0, 2 * energy.f + energy.d) * acrossP * acrossP.transpose();
  hessian.noalias() += std::max(0.0, 2 * energy.f - energy.d) * acrossQ * acrossQ.transpose();
  hessian.noalias() += app * alongP * alongP.transpose() + aqq * alongQ * alongQ.transpose();
  hessian.noalias() += apq * (alongP * alongQ.transpose() + alongQ * alongP.transpose());
}

double RatioEnergy::value(const Jacobian& j) const
{
  const double excess = j.squaredNorm() / (2 * determinantOf(j)) - bound;
  // k^2 (sqrt(1 + (e/k)^2) - 1) without the difference of two near numbers.
  return 2 * weight * excess * excess / (1 + std::hypot(1, excess / knee));
}

void RatioEnergy::derivatives(const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const
{
  const double d = determinantOf(j);
  const double a = j.squaredNorm() / (2 * d);
  const double excess = a - bound;
  const double root = std::hypot(1, excess / knee);
  const double first = 2 * weight * excess / root;
  const double second = 2 * weight / (root * root * root);
  const double aF = 1 / (2 * d), aD = -a / d;
  deriveByJacobian(j,
    { first * aF, first * aD, second * aF * aD - first * aF / d,
      second * aD * aD + 2 * first * a / (d * d), second * aF * aF },
    gradient, hessian);
}

double AxisEnergy::value(double off) const
{
  return 2 * weight * off * off / (1 + std::hypot(1, off / knee));
}

void AxisEnergy::addDerivatives(
  const Jacobian& off, const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const
{
  const double c = off.dot(j);
  const double root = std::hypot(1, c / knee);
  gradient += 2 * weight * c / root * off;
  hessian.noalias() += 2 * weight / (root * root * root) * off * off.transpose();
}

} // namespace quadrille
