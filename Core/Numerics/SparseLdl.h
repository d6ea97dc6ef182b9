// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// L D L^T of a sparse symmetric matrix, row by row [Davis 2005], that can be stopped: on the largest coarse levels one
/// factorization takes seconds, and those of libraries cannot be interrupted.
/// Documentation/Design/Libraries.md compares it with CHOLMOD.
#pragma once

#include <Eigen/SparseCore>

#include <vector>

namespace quadrille
{

class SparseLdl
{
public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Ordering and pattern of L. lower: n x n, compressed, the lower triangle with all of the diagonal. Throws
  /// InvalidInput when it is not.
  void analyze(const Matrix& lower);
  /// Of lower + shift * identity, where lower has the pattern that was analyzed. False when it is not positive
  /// definite. Looks out for a stop.
  bool factorize(const Matrix& lower, double shift);
  /// Multiplications and additions of one factorization, by the pattern that was analyzed.
  double factorFlops() const;
  /// After a factorization that succeeded.
  Eigen::VectorXd solve(const Eigen::VectorXd& rightSide) const;

  /// C^T A^-1 C for a matrix C of n rows whose columns are sparse; k x k, symmetric. After a factorization that
  /// succeeded. Costs half a sparse solve a column and the product of what these leave; looks out for a stop.
  Eigen::MatrixXd schur(const Matrix& columns) const;

private:
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>
    order_; ///< to the place in the elimination
  // The reordered upper triangle by columns.
  std::vector<int> begin_; ///< n + 1
  std::vector<int> row_;
  std::vector<int> source_; ///< place of the value in `lower`
  // L without its diagonal of ones, by columns, and D.
  std::vector<int> parent_;              ///< elimination tree; -1 at roots
  std::vector<std::ptrdiff_t> firstOfL_; ///< n + 1
  std::vector<int> rowOfL_;
  std::vector<double> valueOfL_;
  Eigen::VectorXd diagonal_;
};

} // namespace quadrille
