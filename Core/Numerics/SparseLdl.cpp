// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/SparseLdl.h"

#include "Base/Error.h"
#include "Base/Progress.h"

#include <Eigen/OrderingMethods>

#include <algorithm>

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
  if (!fits)
  {
    throw InvalidInput(
      "L D L^T: the matrix is not the lower triangle of a square one with all of its diagonal");
  }
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
  if (lower.cols() != n || static_cast<std::size_t>(lower.nonZeros()) != source_.size())
  {
    throw InvalidInput("L D L^T: the matrix has not the pattern that was analyzed");
  }
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

} // namespace quadrille
