// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/SparseCholesky.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <Eigen/Dense>
#include <Eigen/OrderingMethods>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Supernodes are no wider, and so many dense rows are multiplied at a time, so that sums of products have one order
/// whatever the caches of the machine are.
constexpr int kWidestSupernode = 64;
/// Supernodes are joined up to this width, or where no more of what is stored than this part are zeros.
constexpr int kNarrowSupernode = 8;
constexpr double kMostZeros = 0.1;

void checkLower(const SparseCholesky::Matrix& lower)
{
  bool fits = lower.rows() == lower.cols() && lower.isCompressed();
  for (int j = 0; fits && j < lower.cols(); ++j)
  {
    const int begin = lower.outerIndexPtr()[j];
    fits = begin < lower.outerIndexPtr()[j + 1] && lower.innerIndexPtr()[begin] == j;
  }
  refuseIf(
    !fits, "L L^T: the matrix is not the lower triangle of a square one with all of its diagonal");
}

/// Calls visit(smaller place, larger place, place of the value) for each entry of the reordered matrix.
template <typename Visitor>
void forEachEntry(
  const SparseCholesky::Matrix& lower, const Eigen::VectorXi& place, const Visitor& visit)
{
  for (int j = 0; j < lower.cols(); ++j)
  {
    for (int at = lower.outerIndexPtr()[j]; at < lower.outerIndexPtr()[j + 1]; ++at)
    {
      const int a = place[lower.innerIndexPtr()[at]];
      const int b = place[j];
      visit(std::min(a, b), std::max(a, b), at);
    }
  }
}

/// L of a dense matrix whose lower triangle is in the first rows, and the rows below times its inverse transposed.
/// False when it is not positive definite.
template <typename Panel>
bool factorizeDense(Panel& panel)
{
  const Eigen::Index height = panel.rows();
  for (Eigen::Index k = 0; k < panel.cols(); ++k)
  {
    auto column = panel.col(k).tail(height - k);
    if (k > 0)
    {
      column.noalias() -= panel.block(k, 0, height - k, k) * panel.row(k).head(k).transpose();
    }
    const double pivot = column[0];
    if (!(pivot > 0))
    {
      return false;
    }
    column *= 1 / std::sqrt(pivot);
  }
  return true;
}

/// From this part of all columns on a row is taken for a dense one.
constexpr int kDenseRow = 4;

/// sum over rows of row^T row; entries of a row ascend.
Eigen::MatrixXd productOfRows(
  const std::vector<std::vector<std::pair<int, double>>>& rows, int columns)
{
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::MatrixXd block(columns, kWidestSupernode);
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
    poll();
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
    if (++filled == kWidestSupernode)
    {
      flush();
    }
  }
  flush();
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

} // namespace

void SparseCholesky::analyze(const Matrix& lower)
{
  checkLower(lower);
  using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  Permutation fromPlace;
  const Matrix full = lower.selfadjointView<Eigen::Lower>();
  poll();
  Eigen::AMDOrdering<int>()(full, fromPlace);
  poll();
  place_ = Permutation(fromPlace.inverse()).indices();
  findTree(lower);
  sortTree();
  entries_ = Grouped<Entry>(parent_.size(),
    [&](const auto& visit)
    {
      forEachEntry(lower, place_,
        [&](int column, int row, int at) {
          visit(static_cast<std::size_t>(column), Entry{ row, at });
        });
    });
  entryCount_ = lower.nonZeros();
  findSupernodes();
  findRows();
  flops_ = 0;
  for (const int rows : count_)
  {
    flops_ += static_cast<double>(rows - 1) * rows;
  }
}

/// The tree [Liu 1990], and the rows of each column: row k of L reaches from the entries of row k up the tree.
void SparseCholesky::findTree(const Matrix& lower)
{
  const auto n = static_cast<std::size_t>(lower.cols());
  const Grouped<int> left(n,
    [&](const auto& visit)
    {
      forEachEntry(lower, place_,
        [&](int column, int row, int) { visit(static_cast<std::size_t>(row), column); });
    });
  parent_.assign(n, -1);
  count_.assign(n, 1);
  std::vector<int> seen(n, -1);
  for (int k = 0; k < size(); ++k)
  {
    poll();
    seen[k] = k;
    for (const int* from = left.begin(k); from != left.end(k); ++from)
    {
      for (int i = *from; seen[i] != k; i = parent_[i])
      {
        parent_[i] = parent_[i] < 0 ? k : parent_[i];
        ++count_[i];
        seen[i] = k;
      }
    }
  }
}

/// Each subtree becomes a range that ends at its root.
void SparseCholesky::sortTree()
{
  const int n = size();
  std::vector<int> child(n, -1), sibling(n, -1), sorted(n), stack;
  for (int k = n; k-- > 0;)
  {
    if (parent_[k] >= 0)
    {
      sibling[k] = child[parent_[k]];
      child[parent_[k]] = k;
    }
  }
  int done = 0;
  for (int root = 0; root < n; ++root)
  {
    if (parent_[root] < 0)
    {
      stack.push_back(root);
    }
    while (!stack.empty())
    {
      const int k = stack.back();
      if (child[k] >= 0)
      {
        stack.push_back(child[k]);
        child[k] = sibling[child[k]];
        continue;
      }
      sorted[k] = done++;
      stack.pop_back();
    }
  }
  std::vector<int> parent(n), count(n);
  for (int k = 0; k < n; ++k)
  {
    parent[sorted[k]] = parent_[k] < 0 ? -1 : sorted[parent_[k]];
    count[sorted[k]] = count_[k];
    place_[k] = sorted[place_[k]];
  }
  parent_ = std::move(parent);
  count_ = std::move(count);
}

/// Columns with the same rows, joined with the child before them where that stores few zeros.
void SparseCholesky::findSupernodes()
{
  struct Joined
  {
    int begin, end;
    double zeros;
  };
  const auto rowsBelow = [&](const Joined& node) { return count_[node.end - 1] - 1; };
  std::vector<Joined> found;
  for (int k = 0; k < size(); ++k)
  {
    if (k > 0 && parent_[k - 1] == k && count_[k - 1] == count_[k] + 1)
    {
      found.back().end = k + 1;
    }
    else
    {
      found.push_back({ k, k + 1, 0 });
    }
    const bool goesOn = k + 1 < size() && parent_[k] == k + 1 && count_[k] == count_[k + 1] + 1;
    while (!goesOn && found.size() > 1)
    {
      const Joined& last = found.back();
      const Joined& child = found[found.size() - 2];
      if (parent_[child.end - 1] != last.begin)
      {
        break;
      }
      const double rows = last.end - last.begin + rowsBelow(last);
      const double width = last.end - child.begin;
      const double childWidth = child.end - child.begin;
      const double zeros = child.zeros + last.zeros + childWidth * (rows - rowsBelow(child));
      const double stored = width * (childWidth + rows) - width * (width - 1) / 2;
      if (width > kNarrowSupernode && zeros > kMostZeros * stored)
      {
        break;
      }
      const Joined both{ child.begin, last.end, zeros };
      found.pop_back();
      found.back() = both;
    }
  }
  nodes_.clear();
  nodeOf_.resize(parent_.size());
  for (const Joined& node : found)
  {
    const int parts = (node.end - node.begin + kWidestSupernode - 1) / kWidestSupernode;
    for (int i = 0; i < parts; ++i)
    {
      Supernode part;
      part.begin = node.begin + i * kWidestSupernode;
      part.end = std::min(node.end, part.begin + kWidestSupernode);
      std::fill(
        nodeOf_.begin() + part.begin, nodeOf_.begin() + part.end, static_cast<int>(nodes_.size()));
      nodes_.push_back(part);
    }
  }
}

/// Rows of a supernode are those of its columns and of the supernodes whose first row below is in it.
void SparseCholesky::findRows()
{
  std::vector<int> seen(parent_.size(), -1), child(nodes_.size(), -1), sibling(nodes_.size(), -1);
  rows_.clear();
  std::ptrdiff_t values = 0;
  for (int s = 0; s < static_cast<int>(nodes_.size()); ++s)
  {
    poll();
    Supernode& node = nodes_[s];
    node.firstRow = static_cast<std::ptrdiff_t>(rows_.size());
    for (int k = node.begin; k < node.end; ++k)
    {
      rows_.push_back(k);
    }
    const auto add = [&](int row)
    {
      if (row >= node.end && seen[row] != s)
      {
        seen[row] = s;
        rows_.push_back(row);
      }
    };
    std::for_each(entries_.begin(node.begin), entries_.end(node.end - 1),
      [&](const Entry& entry) { add(entry.row); });
    for (int c = child[s]; c >= 0; c = sibling[c])
    {
      for (int i = nodes_[c].width(); i < nodes_[c].height; ++i)
      {
        add(rows_[nodes_[c].firstRow + i]);
      }
    }
    std::sort(rows_.begin() + node.firstRow + node.width(), rows_.end());
    node.height = static_cast<int>(static_cast<std::ptrdiff_t>(rows_.size()) - node.firstRow);
    node.firstValue = values;
    values += static_cast<std::ptrdiff_t>(node.height) * node.width();
    if (node.height > node.width())
    {
      const int above = nodeOf_[rows_[node.firstRow + node.width()]];
      sibling[s] = child[above];
      child[above] = s;
    }
  }
  valueCount_ = values;
}

double SparseCholesky::factorBytes() const
{
  return static_cast<double>(valueCount_) * sizeof(double) +
    static_cast<double>(rows_.size()) * sizeof(int);
}

bool SparseCholesky::factorize(const Matrix& lower, double shift)
{
  refuseIf(lower.cols() != size() || lower.nonZeros() != entryCount_,
    "L L^T: the matrix has not the pattern that was analyzed");
  values_.assign(static_cast<std::size_t>(valueCount_), 0.0);
  std::vector<int> localRow(parent_.size());
  // Supernodes that are done, by the supernode that they add to next, and their first row in it.
  std::vector<int> first(nodes_.size(), -1), next(nodes_.size(), -1), reached(nodes_.size(), 0);
  std::vector<double> product;
  for (int s = 0; s < static_cast<int>(nodes_.size()); ++s)
  {
    const Supernode& node = nodes_[s];
    Panel own = panel(node);
    for (int i = 0; i < node.height; ++i)
    {
      localRow[rowsOf(node)[i]] = i;
    }
    for (int k = node.begin; k < node.end; ++k)
    {
      double* const column = own.col(k - node.begin).data();
      column[k - node.begin] += shift;
      for (const Entry* entry = entries_.begin(k); entry != entries_.end(k); ++entry)
      {
        column[localRow[entry->row]] += lower.valuePtr()[entry->source];
      }
    }
    const auto passOn = [&](int from)
    {
      if (reached[from] < nodes_[from].height)
      {
        const int to = nodeOf_[rowsOf(nodes_[from])[reached[from]]];
        next[from] = first[to];
        first[to] = from;
      }
    };
    for (int from = first[s]; from >= 0;)
    {
      poll();
      const Supernode& done = nodes_[from];
      const int following = next[from];
      const int* const rows = rowsOf(done) + reached[from];
      const int height = done.height - reached[from];
      int width = 0;
      while (width < height && rows[width] < node.end)
      {
        ++width;
      }
      const auto below = std::as_const(*this).panel(done).bottomRows(height);
      product.resize(std::max(product.size(), static_cast<std::size_t>(height) * width));
      Panel sum(product.data(), height, width);
      sum.noalias() = below * below.topRows(width).transpose();
      for (int j = 0; j < width; ++j)
      {
        double* const column = own.col(rows[j] - node.begin).data();
        const double* const added = sum.col(j).data();
        for (int i = j; i < height; ++i)
        {
          column[localRow[rows[i]]] -= added[i];
        }
      }
      reached[from] += width;
      passOn(from);
      from = following;
    }
    poll();
    if (!factorizeDense(own))
    {
      return false;
    }
    reached[s] = node.width();
    passOn(s);
  }
  return true;
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& rightSide) const
{
  Eigen::VectorXd x(size());
  for (int i = 0; i < size(); ++i)
  {
    x[place_[i]] = rightSide[i];
  }
  for (const Supernode& node : nodes_)
  {
    const ConstPanel own = panel(node);
    for (int k = 0; k < node.width(); ++k)
    {
      const double value = x[node.begin + k] / own(k, k);
      x[node.begin + k] = value;
      for (int i = k + 1; i < node.height; ++i)
      {
        x[rowsOf(node)[i]] -= own(i, k) * value;
      }
    }
  }
  for (std::size_t s = nodes_.size(); s-- > 0;)
  {
    const Supernode& node = nodes_[s];
    const ConstPanel own = panel(node);
    for (int k = node.width(); k-- > 0;)
    {
      double value = x[node.begin + k];
      for (int i = k + 1; i < node.height; ++i)
      {
        value -= own(i, k) * x[rowsOf(node)[i]];
      }
      x[node.begin + k] = value / own(k, k);
    }
  }
  Eigen::VectorXd result(size());
  for (int i = 0; i < size(); ++i)
  {
    result[i] = x[place_[i]];
  }
  return result;
}

Eigen::MatrixXd SparseCholesky::schur(const Matrix& columns) const
{
  const int n = size();
  const int k = static_cast<int>(columns.cols());
  refuseIf(columns.rows() != n, "L L^T: the columns have not the size of the matrix");
  if (k == 0)
  {
    return Eigen::MatrixXd(0, 0); // Eigen's products look at the first entry
  }
  // Rows of L^-1 C: what they have to do with each other is the product of their columns.
  std::vector<std::vector<std::pair<int, double>>> rows(n);
  std::vector<double> x(n, 0.0);
  std::vector<int> seen(n, -1);
  std::vector<int> path(n), pattern(n);
  for (int j = 0; j < k; ++j)
  {
    poll();
    int top = n;
    for (Matrix::InnerIterator entry(columns, j); entry; ++entry)
    {
      const int first = place_[entry.row()];
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
      const Supernode& node = nodes_[nodeOf_[i]];
      const int own = i - node.begin;
      const auto column = panel(node).col(own);
      const double xi = x[i] / column[own];
      x[i] = 0;
      for (int r = own + 1; r < node.height; ++r)
      {
        x[rowsOf(node)[r]] -= column[r] * xi;
      }
      rows[i].emplace_back(j, xi);
    }
  }
  return productOfRows(rows, k);
}

} // namespace quadrille
