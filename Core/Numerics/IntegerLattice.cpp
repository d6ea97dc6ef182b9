// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/IntegerLattice.h"

#include "Base/FixedPoint.h"
#include "Base/Progress.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

namespace quadrille
{
namespace
{

/// Beyond this nothing is added or multiplied any more.
constexpr std::int64_t kLargestEntry = std::int64_t{ 1 } << 62;

/// Coefficients by coordinate.
using Terms = std::map<Index, std::int64_t>;

bool fits(Int128 x)
{
  return x < kLargestEntry && x > -Int128{ kLargestEntry };
}

std::int64_t smallestFactor(std::int64_t n)
{
  for (std::int64_t p = 2; p * p <= n; ++p)
  {
    if (n % p == 0)
    {
      return p;
    }
  }
  return n;
}

/// x modulo a prime, nearest to zero.
std::int64_t residue(Int128 x, std::int64_t p)
{
  const auto r = static_cast<std::int64_t>(((x % p) + p) % p);
  return 2 * r > p ? r - p : r;
}

/// The inverse of x modulo a prime p that does not divide it: x^(p - 2).
std::int64_t inverse(std::int64_t x, std::int64_t p)
{
  std::int64_t result = 1;
  std::int64_t power = residue(x, p);
  for (std::int64_t exponent = p - 2; exponent > 0; exponent /= 2)
  {
    result = exponent % 2 != 0 ? residue(Int128{ result } * power, p) : result;
    power = residue(Int128{ power } * power, p);
  }
  return p == 2 ? 1 : result;
}

/// Forms as fractions of coordinates, which change until there are no fractions.
class LatticeMaker
{
public:
  /// The last rows of the basis, from firstForm on, are the forms; they depend on each other only.
  LatticeMaker(const ExactBasis& basis, Index firstForm)
  {
    const auto firstFree = std::lower_bound(basis.free.begin(), basis.free.end(), firstForm);
    const Index skipped = static_cast<Index>(firstFree - basis.free.begin());
    users_.resize(basis.free.size() - skipped);
    for (std::size_t row = firstForm; row < basis.rows.size(); ++row)
    {
      const Index f = static_cast<Index>(forms_.size());
      forms_.emplace_back();
      for (const auto& [id, numerator] : basis.rows[row].numerators)
      {
        forms_[f].insert({ id - skipped, numerator });
        users_[id - skipped].insert(f);
      }
      denominator_.push_back(basis.rows[row].denominator);
    }
    for (auto free = firstFree; free != basis.free.end(); ++free)
    {
      result_.coordinates.push_back({ { *free - firstForm, 1.0 } });
    }
    result_.composite.assign(users_.size(), 0);
  }

  /// False when a number grows too large.
  bool run()
  {
    std::vector<Index> order(forms_.size());
    std::iota(order.begin(), order.end(), Index{ 0 });
    std::stable_sort(order.begin(), order.end(),
      [&](Index a, Index b) { return forms_[a].size() < forms_[b].size(); });
    for (const Index f : order)
    {
      while (denominator_[f] > 1)
      {
        poll();
        if (!removeFactor(f, smallestFactor(denominator_[f])))
        {
          return false;
        }
      }
    }
    return true;
  }

  IntegerLattice take()
  {
    for (const Terms& terms : forms_)
    {
      result_.forms.emplace_back(terms.begin(), terms.end());
    }
    return std::move(result_);
  }

private:
  /// The coordinate that the fewest forms use, of those whose coefficient p does not divide.
  Index choosePivot(const Terms& terms, std::int64_t p) const
  {
    Index best = kInvalidIndex;
    for (const auto& [id, coefficient] : terms)
    {
      if (coefficient % p != 0 &&
        (best == kInvalidIndex || users_[id].size() < users_[best].size()))
      {
        best = id;
      }
    }
    return best;
  }

  /// Coordinate x_j becomes t with x_j = p t - sum c_i x_i, where the c_i make the numerator of f a multiple of p. As a
  /// fraction is in lowest terms, p does not divide all of its coefficients.
  bool removeFactor(Index f, std::int64_t p)
  {
    const Index pivot = choosePivot(forms_[f], p);
    const std::int64_t factor = inverse(forms_[f].at(pivot), p);
    Terms others;
    for (const auto& [id, coefficient] : forms_[f])
    {
      const std::int64_t c = residue(Int128{ residue(coefficient, p) } * factor, p);
      if (id != pivot && c != 0)
      {
        others.insert({ id, c });
      }
    }
    const std::set<Index> users = users_[pivot];
    for (const Index user : users)
    {
      if (!substitute(user, pivot, p, others))
      {
        return false;
      }
    }
    changeCoordinate(pivot, p, others);
    return true;
  }

  bool substitute(Index f, Index pivot, std::int64_t p, const Terms& others)
  {
    Terms& terms = forms_[f];
    const std::int64_t factor = terms.at(pivot);
    for (const auto& [id, c] : others)
    {
      const Int128 value = Int128{ terms[id] } - Int128{ factor } * c;
      if (!fits(value))
      {
        return false;
      }
      terms[id] = static_cast<std::int64_t>(value);
      users_[id].insert(f);
      if (value == 0)
      {
        terms.erase(id);
        users_[id].erase(f);
      }
    }
    if (!fits(Int128{ factor } * p))
    {
      return false;
    }
    terms[pivot] = factor * p;
    std::int64_t common = denominator_[f];
    for (const auto& term : terms)
    {
      common = std::gcd(common, term.second);
    }
    for (auto& term : terms)
    {
      term.second /= common;
    }
    denominator_[f] /= common;
    return true;
  }

  void changeCoordinate(Index pivot, std::int64_t p, const Terms& others)
  {
    std::map<Index, double> sum;
    const auto add = [&](Index coordinate, double factor)
    {
      for (const auto& [form, value] : result_.coordinates[coordinate])
      {
        sum[form] += factor * value;
      }
    };
    const double part = 1.0 / static_cast<double>(p);
    add(pivot, part);
    for (const auto& [id, c] : others)
    {
      add(id, part * static_cast<double>(c));
    }
    result_.coordinates[pivot].assign(sum.begin(), sum.end());
    result_.composite[pivot] = 1;
  }

  std::vector<Terms> forms_;
  std::vector<std::int64_t> denominator_;
  std::vector<std::set<Index>> users_; ///< forms that use a coordinate
  IntegerLattice result_;
};

} // namespace

std::optional<IntegerLattice> integerLattice(Index variables,
  const std::vector<ExactBasis::Row>& forms, const std::vector<std::uint8_t>& derived)
{
  // denominator * form - numerators = 0, solved for the variables first: what is left are relations of the forms.
  std::vector<IntegerRow> equations;
  for (const ExactBasis::Row& form : forms)
  {
    IntegerRow equation{ { variables + static_cast<Index>(equations.size()), form.denominator } };
    for (const auto& [id, numerator] : form.numerators)
    {
      equation.emplace_back(id, -numerator);
    }
    equations.push_back(std::move(equation));
  }
  const Index count = static_cast<Index>(forms.size());
  if (count == 0)
  {
    return IntegerLattice{};
  }
  std::vector<std::uint8_t> rank(variables, 0);
  for (const std::uint8_t flag : derived)
  {
    rank.push_back(flag != 0 ? 1 : 2);
  }
  const std::optional<ExactBasis> relations = eliminateExactly(variables + count, equations, rank);
  if (!relations)
  {
    return std::nullopt;
  }
  LatticeMaker maker(*relations, variables);
  return maker.run() ? std::optional<IntegerLattice>(maker.take()) : std::nullopt;
}

} // namespace quadrille
