// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// L L^T of a sparse symmetric matrix, supernode by supernode [Ng and Peyton 1993], that can be stopped: on the largest
/// coarse levels one factorization takes most of a second, and those of libraries cannot be interrupted.
/// Documentation/Design/Libraries.md compares it with CHOLMOD.
#pragma once

#include "Base/Lists.h"

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace quadrille
{

class SparseCholesky
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
  double factorFlops() const { return flops_; }
  /// Memory of a factorization, by the same.
  double factorBytes() const;
  /// After a factorization that succeeded.
  Eigen::VectorXd solve(const Eigen::VectorXd& rightSide) const;

  /// C^T A^-1 C for a matrix C of n rows whose columns are sparse; k x k, symmetric. After a factorization that
  /// succeeded. Costs half a sparse solve a column and the product of what these leave; looks out for a stop.
  Eigen::MatrixXd schur(const Matrix& columns) const;

private:
  /// Columns of L that are next to each other and have the same rows, but for those above the diagonal and a few zeros.
  /// They are stored as one dense matrix, column by column, whose first rows are the columns themselves.
  struct Supernode
  {
    int begin = 0, end = 0;        ///< columns
    std::ptrdiff_t firstRow = 0;   ///< in rows_
    std::ptrdiff_t firstValue = 0; ///< in values_
    int height = 0;                ///< number of rows

    int width() const { return end - begin; }
  };
  struct Entry
  {
    int row = 0;
    int source = 0; ///< place of the value in `lower`
  };
  using Panel = Eigen::Map<Eigen::MatrixXd>;
  using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

  int size() const { return static_cast<int>(parent_.size()); }
  void findTree(const Matrix& lower);
  void sortTree();
  void findSupernodes();
  void findRows();
  const int* rowsOf(const Supernode& node) const { return rows_.data() + node.firstRow; }
  Panel panel(const Supernode& node)
  {
    return { values_.data() + node.firstValue, node.height, node.width() };
  }
  ConstPanel panel(const Supernode& node) const
  {
    return { values_.data() + node.firstValue, node.height, node.width() };
  }

  Eigen::VectorXi place_;   ///< in the elimination, of each unknown
  std::vector<int> parent_; ///< elimination tree, children before their parents; -1 at roots
  std::vector<int> count_;  ///< rows of each column of L, with the diagonal
  Grouped<Entry> entries_;  ///< of the reordered lower triangle, by columns
  Eigen::Index entryCount_ = 0;
  std::vector<Supernode> nodes_;
  std::vector<int> nodeOf_; ///< of each column
  std::vector<int> rows_;   ///< of all supernodes; ascending in each
  std::ptrdiff_t valueCount_ = 0;
  std::vector<double> values_;
  double flops_ = 0;
};

} // namespace quadrille
