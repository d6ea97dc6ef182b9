// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Energies that are sums over triangles of a function of the Jacobian, minimized in reduced unknowns:
/// H = sum A_t^T H_t A_t with one symbolic analysis for all factorizations.
#pragma once

#include "Numerics/SparseCholesky.h"
#include "Numerics/Untangler.h"

#include <vector>

namespace quadrille
{

/// A Jacobian or a derivative by it, column by column: J00, J10, J01, J11.
using Jacobian = Eigen::Vector4d;

/// The linear part of a problem: per triangle J = A_t y + b_t with the few unknowns it depends on.
class ReducedTriangles
{
public:
  /// Throws InvalidInput when the sizes in `problem` disagree.
  explicit ReducedTriangles(const UntangleProblem& problem);

  Eigen::Index unknowns() const { return hessian_.cols(); }
  std::size_t triangles() const { return constant_.size(); }

  void jacobians(const Eigen::VectorXd& y, std::vector<Jacobian>& result) const;

  /// Sets the derivatives of the energy from those of the triangles by their Jacobians.
  void assemble(
    const std::vector<Jacobian>& gradients, const std::vector<Eigen::Matrix4d>& hessians);
  const Eigen::VectorXd& gradient() const { return gradient_; }
  /// Lower triangle, compressed, with all of the diagonal.
  const Eigen::SparseMatrix<double>& hessian() const { return hessian_; }

  /// What a factorization takes can be asked then, and is by newtonStep() before the first one.
  void analyze();
  const SparseCholesky& solver() const { return solver_; }

  /// The Newton step -(H + regularization * mean(diag H))^-1 g. The regularization is raised until the
  /// matrix is positive definite; false when no finite step exists.
  bool newtonStep(double regularization, Eigen::VectorXd& step);
  /// Of all factorizations so far, also those of matrices that were not positive definite.
  double factorFlops() const { return factorFlops_; }

private:
  using Matrix = Eigen::SparseMatrix<double>;

  void collectUnknowns(const UntangleProblem& problem);
  void buildPattern();

  std::vector<std::size_t> begin_;     ///< #T + 1: range of a triangle in unknown_ and matrix_
  std::vector<int> unknown_;           ///< ascending inside a triangle
  std::vector<Jacobian> matrix_;       ///< the columns of A_t
  std::vector<Jacobian> constant_;     ///< b_t
  std::vector<std::size_t> slotBegin_; ///< #T + 1: range in slot_
  std::vector<int> slot_;     ///< place of each entry of A_t^T H_t A_t in the values of hessian_
  std::vector<int> diagonal_; ///< place of each diagonal entry
  Matrix hessian_;            ///< lower triangle
  Eigen::VectorXd gradient_;
  SparseCholesky solver_;
  bool analyzed_ = false;
  double factorFlops_ = 0;
};

/// The derivatives at y = 0 of sum weight |J - 1|^2 / 2, the energy that fitReferences minimizes.
void assembleFit(const UntangleProblem& problem, ReducedTriangles& system);

} // namespace quadrille
