// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Newton's method on energies of a triangle that depend on its Jacobian J by F = |J|^2 and D = det J only.
#pragma once

#include "Numerics/ReducedTriangles.h"

namespace quadrille
{

/// Derivatives of E(F, D) with E_FF = 0.
struct IsotropicDerivatives
{
  double f = 0, d = 0, fd = 0, dd = 0;
};

/// Gradient by J, and the Hessian projected to positive semidefinite.
void deriveByJacobian(const Jacobian& j, const IsotropicDerivatives& energy, Jacobian& gradient,
  Eigen::Matrix4d& hessian);

} // namespace quadrille
