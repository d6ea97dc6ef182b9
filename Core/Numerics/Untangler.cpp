// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/Untangler.h"

#include "Base/Refuse.h"
#include "Base/WorkCount.h"
#include "Numerics/IsotropicEnergy.h"
#include "Numerics/ReducedTriangles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

using Vector = Eigen::VectorXd;

/// Fractions by which one step lowers the energy: below the first one it is near the minimum for its
/// epsilon, below the second one no further step pays.
constexpr double kConverged = 1e-3;
constexpr double kStalled = 1e-5;
/// Units of work, see WorkCount.h: what a Newton step does for one triangle without the factorization, and what a
/// million operations of that are. Fitted to seven maps, which they meet within 30 %.
constexpr double kWorkOfTriangle = 0.35;
constexpr double kWorkOfMegaflop = 380;
/// det J below this fraction counts as inverted (the caller snaps to a grid afterwards).
constexpr double kLeastJacobian = 1e-4;
/// Of the RatioEnergy of triangles beyond the limit of anisotropy.
constexpr double kRatioWeight = 500;

/// The energy of one triangle, (|J|^2 + lambda (1 + det^2)) / chi(det) + mu |J - 1|^2, where
/// chi(D) = (D + sqrt(eps^2 + D^2)) / 2 tends to max(D, 0) with eps.
struct TriangleEnergy
{
  double lambda = 0;
  double mu = 0;
  double epsilon = 0;

  double chi(double d) const
  {
    const double root = std::sqrt(epsilon * epsilon + d * d);
    // The second form does not cancel for negative determinants.
    return d >= 0 ? (d + root) / 2 : epsilon * epsilon / (2 * (root - d));
  }

  double value(const Jacobian& j) const
  {
    const double d = determinantOf(j);
    const double c = chi(d);
    if (!(c > 0))
    {
      return kInfinity;
    }
    return (j.squaredNorm() + lambda * (1 + d * d)) / c +
      mu * (j - Jacobian(1, 0, 0, 1)).squaredNorm();
  }

  /// Gradient, and Hessian projected to positive semidefinite.
  void derivatives(const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const;
};

void TriangleEnergy::derivatives(
  const Jacobian& j, Jacobian& gradient, Eigen::Matrix4d& hessian) const
{
  const double d = determinantOf(j);
  const double c = chi(d);
  const double root = std::sqrt(epsilon * epsilon + d * d);
  const double c1 = c / root;                                     // chi'
  const double c2 = epsilon * epsilon / (2 * root * root * root); // chi''
  const double numerator = j.squaredNorm() + lambda * (1 + d * d);

  // E = E(F, D) with F = |J|^2, D = det J; E_FF = 0.
  const double eF = 1 / c;
  const double eD = (2 * lambda * d - numerator * c1 / c) / c;
  const double eFD = -c1 / (c * c);
  const double eDD =
    2 * lambda / c - 4 * lambda * d * c1 / (c * c) - numerator * (c2 - 2 * c1 * c1 / c) / (c * c);

  deriveByJacobian(j, { eF, eD, eFD, eDD }, gradient, hessian);
  gradient += 2 * mu * (j - Jacobian(1, 0, 0, 1));
  hessian.diagonal().array() += 2 * mu;
}

/// One run of Newton's method; the state is y, the Jacobians at y and epsilon.
class Minimizer
{
public:
  Minimizer(const UntangleProblem& problem, const Vector& y0, const UntangleOptions& options)
    : problem_(problem), options_(options), system_(problem), y_(y0)
  {
    energy_.lambda = options.areaWeight;
    energy_.mu = options.alignmentWeight;
    if (options.anisotropyLimit > 0)
    {
      ratio_.weight = kRatioWeight;
      ratio_.bound = (options.anisotropyLimit + 1 / options.anisotropyLimit) / 2;
    }
    axis_.weight = options.axisWeight;
  }

  UntangleResult run();

private:
  double minimumDeterminant(const std::vector<Jacobian>& jacobians) const;
  bool isBeyondLimit(std::size_t t, const Jacobian& j) const
  {
    // While some are inverted, the wall at det 0 would be one from both sides.
    return ratio_.weight > 0 && !(energy_.epsilon > 0) && t < options_.limitedTriangles &&
      ratio_.applies(j);
  }
  bool hasDirection(std::size_t t) const
  {
    return axis_.weight > 0 && !(energy_.epsilon > 0) && t < problem_.offAxis.size() &&
      !problem_.offAxis[t].isZero(0);
  }
  bool valid() const { return lowest_ > kLeastJacobian; }
  void lowerEpsilon(double gain);
  double total(const std::vector<Jacobian>& jacobians) const;
  void assemble();
  double step();
  void countStep(std::size_t units) const;
  void measure();

  const UntangleProblem& problem_;
  const UntangleOptions& options_;
  ReducedTriangles system_;
  TriangleEnergy energy_;
  RatioEnergy ratio_;
  AxisEnergy axis_;
  Vector y_;
  std::vector<Jacobian> jacobians_;
  double lowest_ = 0;
};

/// NaN counts as the lowest of all.
double Minimizer::minimumDeterminant(const std::vector<Jacobian>& jacobians) const
{
  double lowest = kInfinity;
  for (const Jacobian& j : jacobians)
  {
    const double d = determinantOf(j);
    if (!std::isfinite(d))
    {
      return -kInfinity;
    }
    lowest = std::min(lowest, d);
  }
  return lowest;
}

void Minimizer::measure()
{
  system_.jacobians(y_, jacobians_);
  lowest_ = minimumDeterminant(jacobians_);
}

/// The schedule of Garanzha et al. 2021: epsilon falls as fast as the energy does, and the slower the
/// deeper the worst determinant lies below it. It is 0 (a barrier) once all determinants are positive.
void Minimizer::lowerEpsilon(double gain)
{
  if (valid())
  {
    energy_.epsilon = 0;
    return;
  }
  const double depth = -std::min(0.0, lowest_);
  if (!(energy_.epsilon > 0))
  {
    energy_.epsilon = std::max(depth, 10 * kLeastJacobian);
    return;
  }
  const double root = std::hypot(depth, energy_.epsilon);
  const double rate = gain < kConverged ? 0.5 : std::max(0.1, gain);
  energy_.epsilon =
    std::max(energy_.epsilon * (1 - rate * root / (depth + root)), 0.1 * kLeastJacobian);
}

double Minimizer::total(const std::vector<Jacobian>& jacobians) const
{
  double sum = 0;
  for (std::size_t t = 0; t < jacobians.size(); ++t)
  {
    sum += problem_.weight[t] * energy_.value(jacobians[t]);
    if (isBeyondLimit(t, jacobians[t]))
    {
      sum += problem_.weight[t] * ratio_.value(jacobians[t]);
    }
    if (hasDirection(t))
    {
      sum += problem_.weight[t] * axis_.value(problem_.offAxis[t].dot(jacobians[t]));
    }
  }
  return std::isfinite(sum) ? sum : kInfinity;
}

void Minimizer::assemble()
{
  std::vector<Jacobian> gradients(jacobians_.size());
  std::vector<Eigen::Matrix4d> hessians(jacobians_.size());
  for (std::size_t t = 0; t < jacobians_.size(); ++t)
  {
    energy_.derivatives(jacobians_[t], gradients[t], hessians[t]);
    if (isBeyondLimit(t, jacobians_[t]))
    {
      Jacobian gradient;
      Eigen::Matrix4d hessian;
      ratio_.derivatives(jacobians_[t], gradient, hessian);
      gradients[t] += gradient;
      hessians[t] += hessian;
    }
    if (hasDirection(t))
    {
      axis_.addDerivatives(problem_.offAxis[t], jacobians_[t], gradients[t], hessians[t]);
    }
    gradients[t] *= problem_.weight[t];
    hessians[t] *= problem_.weight[t];
  }
  system_.assemble(gradients, hessians);
}

/// One Newton step with backtracking; returns by which fraction the energy fell, 0 when it could not.
double Minimizer::step()
{
  assemble();
  poll();
  Vector direction;
  if (!system_.newtonStep(1e-10, direction))
  {
    return 0;
  }
  const double slope = system_.gradient().dot(direction);
  const double before = total(jacobians_);
  std::vector<Jacobian> trial;
  for (double length = 1; length > 1e-9; length *= 0.5)
  {
    poll();
    const Vector candidate = y_ + length * direction;
    system_.jacobians(candidate, trial);
    const double after = total(trial);
    if (after <= before + 1e-4 * length * slope && after < before &&
      (!valid() || minimumDeterminant(trial) > kLeastJacobian))
    {
      y_ = candidate;
      jacobians_.swap(trial);
      lowest_ = minimumDeterminant(jacobians_);
      return (before - after) / std::abs(before);
    }
  }
  return 0;
}

void Minimizer::countStep(std::size_t units) const
{
  try
  {
    countWork(units);
  }
  catch (const WorkSpent&)
  {
    throw UntanglingSpent(y_);
  }
}

UntangleResult Minimizer::run()
{
  measure();
  UntangleResult result;
  int polished = 0;
  int stalled = 0;
  double gain = 0;
  while (result.steps < options_.maximumSteps && system_.unknowns() > 0)
  {
    if (valid() && polished++ >= options_.polishSteps && gain < options_.leastGain)
    {
      break;
    }
    lowerEpsilon(gain);
    report(options_.progress, static_cast<double>(result.steps) / options_.maximumSteps,
      "untangling the map");
    gain = step();
    ++result.steps;
    const auto done = static_cast<std::size_t>(kWorkOfTriangle * static_cast<double>(result.steps) *
        static_cast<double>(system_.triangles()) +
      kWorkOfMegaflop * 1e-6 * system_.factorFlops());
    countStep(done - result.work);
    result.work = done;
    // A smaller epsilon can set a stalled run going again; without one it has converged.
    const bool last = energy_.epsilon <= 0.1 * kLeastJacobian;
    stalled = last && gain < (valid() ? kStalled : kConverged) ? stalled + 1 : 0;
    if (stalled > (valid() ? 0 : 5))
    {
      break;
    }
  }
  result.y = y_;
  std::vector<std::pair<double, Index>> bad;
  for (std::size_t t = 0; t < jacobians_.size(); ++t)
  {
    const double d = determinantOf(jacobians_[t]);
    if (!(d > 0))
    {
      bad.emplace_back(std::isnan(d) ? -kInfinity : d, static_cast<Index>(t));
    }
  }
  std::sort(bad.begin(), bad.end());
  for (const auto& entry : bad)
  {
    result.inverted.push_back(entry.second);
  }
  return result;
}

} // namespace

Vector fitReferences(const UntangleProblem& problem)
{
  ReducedTriangles system(problem);
  assembleFit(problem, system);
  Vector result;
  return system.newtonStep(1e-12, result) ? result : Vector::Zero(system.unknowns());
}

UntangleResult untangle(
  const UntangleProblem& problem, const Vector& y0, const UntangleOptions& options)
{
  refuseIf(y0.size() != problem.basis.cols(),
    "untangling: the initial guess has not the size of the unknowns");
  refuseIf(!y0.allFinite(), "untangling: the initial guess has an entry that is not finite");
  refuseIf(options.anisotropyLimit != 0 &&
      !(options.anisotropyLimit >= 1 && std::isfinite(options.anisotropyLimit)),
    "untangling: the anisotropy limit must be 0 or a number from 1 on");
  return Minimizer(problem, y0, options).run();
}

} // namespace quadrille
