// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/SparseLdl.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <Eigen/OrderingMethods>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// A column of L takes a millisecond at most.
constexpr std::size_t kColumnsBetweenPolls = 16;

void checkLower(const SparseLdl::Matrix& lower)
{
  bool fits = lower.rows() == lower.cols() && lower.isCompressed();
  for (int j = 0; fits && j < lower.cols(); ++j)
  {
    const int begin = lower.outerIndexPtr()[j];
    fits = begin < lower.outerIndexPtr()[j + 1] && lower.innerIndexPtr()[begin] == j;
  }
  refuseIf(!fits,
    "L D L^T: the matrix is not the lower triangle of a square one with all of its diagonal");
}

/// From this part of all columns on a row is taken for a dense one.
constexpr int kDenseRow = 4;
/// Dense rows that are multiplied at a time.
constexpr int kRowsOfBlock = 64;

/// sum over rows of row^T row; entries of a row ascend.
Eigen::MatrixXd productOfRows(
  const std::vector<std::vector<std::pair<int, double>>>& rows, int columns)
{
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::MatrixXd block(columns, kRowsOfBlock);
  int filled = 0;
  const auto flush = [&]
  {
    if (filled > 0) // Eigen divides by it
    {
      product.selfadjointView<Eigen::Lower>().rankUpdate(block.leftCols(filled));
    }
    filled = 0;
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    pollNowAndThen(r, kColumnsBetweenPolls);
    const auto& row = rows[r];
    if (static_cast<int>(row.size()) * kDenseRow < columns)
    {
      for (std::size_t a = 0; a < row.size(); ++a)
      {
        double* const column = product.col(row[a].first).data();
        for (std::size_t b = a; b < row.size(); ++b)
        {
          column[row[b].first] += row[a].second * row[b].second;
        }
      }
      continue;
    }
    block.col(filled).setZero();
    for (const auto& [j, value] : row)
    {
      block(j, filled) = value;
    }
    if (++filled == kRowsOfBlock)
    {
      flush();
    }
  }
  flush();
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

} // namespace

void SparseLdl::analyze(const Matrix& lower)
{
  checkLower(lower);
  const int n = static_cast<int>(lower.cols());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> fromPlace;
  const Matrix full = lower.selfadjointView<Eigen::Lower>();
  poll();
  Eigen::AMDOrdering<int>()(full, fromPlace);
  poll();
  order_ = fromPlace.inverse();
  const auto forEachEntry = [&](const auto& visit)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int at = lower.outerIndexPtr()[j]; at < lower.outerIndexPtr()[j + 1]; ++at)
      {
        const int a = order_.indices()[lower.innerIndexPtr()[at]];
        const int b = order_.indices()[j];
        visit(std::min(a, b), std::max(a, b), at);
      }
    }
  };
  begin_.assign(static_cast<std::size_t>(n) + 1, 0);
  forEachEntry([&](int, int column, int) { ++begin_[column + 1]; });
  for (int k = 0; k < n; ++k)
  {
    begin_[k + 1] += begin_[k];
  }
  row_.resize(static_cast<std::size_t>(begin_[n]));
  source_.resize(row_.size());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  forEachEntry(
    [&](int row, int column, int at)
    {
      row_[next[column]] = row;
      source_[next[column]++] = at;
    });

  // Row k of L reaches from the entries of column k up the tree.
  parent_.assign(n, -1);
  firstOfL_.assign(static_cast<std::size_t>(n) + 1, 0);
  std::vector<int> seen(n, -1);
  for (int k = 0; k < n; ++k)
  {
    pollNowAndThen(static_cast<std::size_t>(k), kColumnsBetweenPolls);
    seen[k] = k;
    for (int at = begin_[k]; at < begin_[k + 1]; ++at)
    {
      for (int i = row_[at]; seen[i] != k; i = parent_[i])
      {
        parent_[i] = parent_[i] < 0 ? k : parent_[i];
        ++firstOfL_[i + 1];
        seen[i] = k;
      }
    }
  }
  for (int k = 0; k < n; ++k)
  {
    firstOfL_[k + 1] += firstOfL_[k];
  }
  rowOfL_.resize(static_cast<std::size_t>(firstOfL_[n]));
  valueOfL_.resize(rowOfL_.size());
  diagonal_.resize(n);
}

bool SparseLdl::factorize(const Matrix& lower, double shift)
{
  const int n = static_cast<int>(diagonal_.size());
  refuseIf(lower.cols() != n || static_cast<std::size_t>(lower.nonZeros()) != source_.size(),
    "L D L^T: the matrix has not the pattern that was analyzed");
  std::vector<double> y(n, 0.0); // row k of L D, while it is computed
  std::vector<int> seen(n, -1);
  std::vector<int> path(n), pattern(n);
  std::vector<std::ptrdiff_t> endOfL(firstOfL_.begin(), firstOfL_.end() - 1);
  for (int k = 0; k < n; ++k)
  {
    pollNowAndThen(static_cast<std::size_t>(k), kColumnsBetweenPolls);
    int top = n;
    seen[k] = k;
    for (int at = begin_[k]; at < begin_[k + 1]; ++at)
    {
      y[row_[at]] += lower.valuePtr()[source_[at]];
      int length = 0;
      for (int i = row_[at]; seen[i] != k; i = parent_[i])
      {
        path[length++] = i;
        seen[i] = k;
      }
      while (length > 0)
      {
        pattern[--top] = path[--length]; // descendants come before ancestors
      }
    }
    double d = y[k] + shift;
    y[k] = 0;
    for (; top < n; ++top)
    {
      const int i = pattern[top];
      const double yi = y[i];
      y[i] = 0;
      const double l = yi / diagonal_[i];
      for (std::ptrdiff_t at = firstOfL_[i]; at < endOfL[i]; ++at)
      {
        y[rowOfL_[at]] -= valueOfL_[at] * yi;
      }
      d -= l * yi;
      rowOfL_[endOfL[i]] = k;
      valueOfL_[endOfL[i]++] = l;
    }
    if (!(d > 0))
    {
      return false;
    }
    diagonal_[k] = d;
  }
  return true;
}

double SparseLdl::factorFlops() const
{
  double flops = 0;
  for (std::size_t k = 0; k + 1 < firstOfL_.size(); ++k)
  {
    const double column = static_cast<double>(firstOfL_[k + 1] - firstOfL_[k]);
    flops += column * (column + 1);
  }
  return flops;
}

Eigen::VectorXd SparseLdl::solve(const Eigen::VectorXd& rightSide) const
{
  Eigen::VectorXd x = order_ * rightSide;
  for (Eigen::Index j = 0; j < x.size(); ++j)
  {
    for (std::ptrdiff_t at = firstOfL_[j]; at < firstOfL_[j + 1]; ++at)
    {
      x[rowOfL_[at]] -= valueOfL_[at] * x[j];
    }
  }
  x.array() *= diagonal_.array().inverse();
  for (Eigen::Index j = x.size(); j-- > 0;)
  {
    for (std::ptrdiff_t at = firstOfL_[j]; at < firstOfL_[j + 1]; ++at)
    {
      x[j] -= valueOfL_[at] * x[rowOfL_[at]];
    }
  }
  return order_.inverse() * x;
}

Eigen::MatrixXd SparseLdl::schur(const Matrix& columns) const
{
  const int n = static_cast<int>(diagonal_.size());
  const int k = static_cast<int>(columns.cols());
  refuseIf(columns.rows() != n, "L D L^T: the columns have not the size of the matrix");
  if (k == 0)
  {
    return Eigen::MatrixXd(0, 0); // Eigen's products look at the first entry
  }
  // Rows of D^-1/2 L^-1 C: what they have to do with each other is the product of their columns.
  std::vector<std::vector<std::pair<int, double>>> rows(n);
  std::vector<double> x(n, 0.0);
  std::vector<int> seen(n, -1);
  std::vector<int> path(n), pattern(n);
  for (int j = 0; j < k; ++j)
  {
    pollNowAndThen(static_cast<std::size_t>(j), kColumnsBetweenPolls);
    int top = n;
    for (Matrix::InnerIterator entry(columns, j); entry; ++entry)
    {
      const int first = order_.indices()[entry.row()];
      x[first] += entry.value();
      int length = 0;
      for (int i = first; i >= 0 && seen[i] != j; i = parent_[i])
      {
        path[length++] = i;
        seen[i] = j;
      }
      while (length > 0)
      {
        pattern[--top] = path[--length]; // descendants come before ancestors
      }
    }
    for (; top < n; ++top)
    {
      const int i = pattern[top];
      const double xi = x[i];
      x[i] = 0;
      for (std::ptrdiff_t at = firstOfL_[i]; at < firstOfL_[i + 1]; ++at)
      {
        x[rowOfL_[at]] -= valueOfL_[at] * xi;
      }
      rows[i].emplace_back(j, xi / std::sqrt(diagonal_[i]));
    }
  }
  return productOfRows(rows, k);
}

} // namespace quadrille
