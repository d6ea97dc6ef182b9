// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/ExactElimination.h"

#include "Base/FixedPoint.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <queue>

namespace quadrille
{
namespace
{

class Overflow
{
};

std::int64_t narrow(Int128 value)
{
  if (value > std::numeric_limits<std::int64_t>::max() ||
    value < -Int128{ std::numeric_limits<std::int64_t>::max() })
  {
    throw Overflow();
  }
  return static_cast<std::int64_t>(value);
}

/// Sorts by variable, adds up repeated ones and drops zeros.
void mergeTerms(IntegerRow& row)
{
  std::sort(row.begin(), row.end());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < row.size();)
  {
    Int128 sum = 0;
    const Index variable = row[i].first;
    for (; i < row.size() && row[i].first == variable; ++i)
    {
      sum += row[i].second;
    }
    if (sum != 0)
    {
      row[kept++] = { variable, narrow(sum) };
    }
  }
  row.resize(kept);
}

/// The same, and divides by the common factor.
void normalize(IntegerRow& row)
{
  mergeTerms(row);
  std::int64_t common = 0;
  for (const auto& term : row)
  {
    common = std::gcd(common, term.second);
  }
  for (auto& term : row)
  {
    term.second /= common;
  }
}

/// a * x + b * y for sorted rows; entries that cancel are left out.
IntegerRow combine(std::int64_t a, const IntegerRow& x, std::int64_t b, const IntegerRow& y)
{
  IntegerRow result;
  result.reserve(x.size() + y.size());
  auto i = x.begin();
  auto j = y.begin();
  while (i != x.end() || j != y.end())
  {
    const bool takeX = j == y.end() || (i != x.end() && i->first <= j->first);
    const bool takeY = i == x.end() || (j != y.end() && j->first <= i->first);
    const Index variable = takeX ? i->first : j->first;
    Int128 sum = 0;
    sum += takeX ? Int128{ a } * (i++)->second : Int128{ 0 };
    sum += takeY ? Int128{ b } * (j++)->second : Int128{ 0 };
    if (sum != 0)
    {
      result.emplace_back(variable, narrow(sum));
    }
  }
  return result;
}

class Elimination
{
public:
  Elimination(Index variables, const std::vector<IntegerRow>& equations,
    const std::vector<std::uint8_t>& rank)
    : rows_(equations), users_(variables), useCount_(variables, 0),
      pivotRow_(variables, kInvalidIndex), rank_(rank)
  {
    for (Index r = 0; r < rows_.size(); ++r)
    {
      pollNowAndThen(r, kHeavyChunk);
      normalize(rows_[r]);
      for (const auto& term : rows_[r])
      {
        users_[term.first].push_back(r);
        ++useCount_[term.first];
      }
      queue_.push({ rows_[r].size(), r });
    }
  }

  ExactBasis run()
  {
    solved_.assign(rows_.size(), false);
    while (!queue_.empty())
    {
      poll();
      const auto [length, r] = queue_.top();
      queue_.pop();
      if (!solved_[r] && length == rows_[r].size() && length > 0)
      {
        solveRow(r);
      }
    }
    return expand();
  }

private:
  using Entry = std::pair<std::size_t, Index>;

  /// The variable that the fewest other equations use; then one with a small coefficient.
  std::size_t choosePivot(const IntegerRow& row) const
  {
    std::size_t best = 0;
    for (std::size_t i = 1; i < row.size(); ++i)
    {
      if (!rank_.empty() && rank_[row[i].first] != rank_[row[best].first])
      {
        best = rank_[row[i].first] < rank_[row[best].first] ? i : best;
        continue;
      }
      const Index a = useCount_[row[i].first];
      const Index b = useCount_[row[best].first];
      if (a < b || (a == b && std::abs(row[i].second) < std::abs(row[best].second)))
      {
        best = i;
      }
    }
    return best;
  }

  void solveRow(Index r)
  {
    solved_[r] = true;
    const auto [variable, coefficient] = rows_[r][choosePivot(rows_[r])];
    pivotRow_[variable] = r;
    order_.push_back(variable);
    for (const auto& term : rows_[r])
    {
      --useCount_[term.first];
    }
    const std::vector<Index> users = std::move(users_[variable]);
    for (const Index other : users)
    {
      if (!solved_[other])
      {
        substitute(other, r, variable, coefficient);
      }
    }
  }

  /// Removes `variable` from row `other` by adding a multiple of row r.
  void substitute(Index other, Index r, Index variable, std::int64_t coefficient)
  {
    IntegerRow& row = rows_[other];
    const auto found = std::lower_bound(
      row.begin(), row.end(), variable, [](const auto& term, Index id) { return term.first < id; });
    if (found == row.end() || found->first != variable)
    {
      return; // it cancelled in an earlier step
    }
    const std::int64_t common = std::gcd(coefficient, found->second);
    IntegerRow changed = combine(coefficient / common, row, -(found->second / common), rows_[r]);
    for (const auto& term : row)
    {
      --useCount_[term.first];
    }
    for (const auto& term : changed)
    {
      ++useCount_[term.first];
      if (!std::binary_search(row.begin(), row.end(), term,
            [](const auto& a, const auto& b) { return a.first < b.first; }))
      {
        users_[term.first].push_back(other);
      }
    }
    row = std::move(changed);
    normalize(row);
    queue_.push({ row.size(), other });
  }

  /// Back substitution: later pivots hold only free variables when an earlier one asks for them.
  ExactBasis expand()
  {
    ExactBasis basis;
    basis.rows.resize(pivotRow_.size());
    for (Index v = 0; v < pivotRow_.size(); ++v)
    {
      if (pivotRow_[v] == kInvalidIndex)
      {
        basis.rows[v].numerators = { { static_cast<Index>(basis.free.size()), 1 } };
        basis.free.push_back(v);
      }
    }
    for (auto pivot = order_.rbegin(); pivot != order_.rend(); ++pivot)
    {
      poll();
      if (rank_.empty() || rank_[*pivot] > 0)
      {
        expandPivot(*pivot, basis.rows);
      }
    }
    basis.step.assign(basis.free.size(), 1);
    for (std::size_t v = 0; v < basis.rows.size(); ++v)
    {
      pollNowAndThen(v, kHeavyChunk);
      const ExactBasis::Row& row = basis.rows[v];
      for (const auto& [id, numerator] : row.numerators)
      {
        const std::int64_t needed = row.denominator / std::gcd(row.denominator, numerator);
        basis.step[id] = lcm(basis.step[id], needed);
      }
    }
    return basis;
  }

  static std::int64_t lcm(std::int64_t a, std::int64_t b)
  {
    return narrow(Int128{ a / std::gcd(a, b) } * b);
  }

  void expandPivot(Index variable, std::vector<ExactBasis::Row>& rows) const
  {
    ExactBasis::Row& result = rows[variable];
    std::int64_t denominator = 1;
    std::int64_t coefficient = 0;
    for (const auto& term : rows_[pivotRow_[variable]])
    {
      if (term.first == variable)
      {
        coefficient = term.second;
      }
      else
      {
        denominator = lcm(denominator, rows[term.first].denominator);
      }
    }
    IntegerRow sum;
    for (const auto& term : rows_[pivotRow_[variable]])
    {
      if (term.first == variable)
      {
        continue;
      }
      const ExactBasis::Row& part = rows[term.first];
      const std::int64_t factor = narrow(-Int128{ term.second } * (denominator / part.denominator));
      for (const auto& [id, numerator] : part.numerators)
      {
        sum.emplace_back(id, narrow(Int128{ factor } * numerator));
      }
    }
    finish(sum, narrow(Int128{ denominator } * coefficient), result);
  }

  /// result = sum / denominator in lowest terms with a positive denominator.
  static void finish(IntegerRow& sum, std::int64_t denominator, ExactBasis::Row& result)
  {
    mergeTerms(sum);
    std::int64_t common = std::abs(denominator);
    for (const auto& term : sum)
    {
      common = std::gcd(common, term.second);
    }
    const std::int64_t signedCommon = denominator < 0 ? -common : common;
    for (auto& term : sum)
    {
      term.second /= signedCommon;
    }
    result.numerators = std::move(sum);
    result.denominator = denominator / signedCommon;
  }

  std::vector<IntegerRow> rows_;
  std::vector<std::vector<Index>> users_; ///< rows that use, or used, a variable
  std::vector<Index> useCount_;           ///< unsolved rows that use it now
  std::vector<Index> pivotRow_;
  std::vector<Index> order_; ///< solved variables
  const std::vector<std::uint8_t>& rank_;
  std::vector<bool> solved_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

} // namespace

std::optional<ExactBasis> eliminateExactly(
  Index variables, const std::vector<IntegerRow>& equations, const std::vector<std::uint8_t>& rank)
{
  try
  {
    return Elimination(variables, equations, rank).run();
  }
  catch (const Overflow&)
  {
    return std::nullopt;
  }
}

} // namespace quadrille
