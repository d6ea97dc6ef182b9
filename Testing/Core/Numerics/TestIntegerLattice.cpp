// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/IntegerLattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>

using namespace quadrille;

namespace
{

ExactBasis::Row form(IntegerRow numerators, std::int64_t denominator)
{
  ExactBasis::Row row;
  row.numerators = std::move(numerators);
  row.denominator = denominator;
  return row;
}

double valueOf(const ExactBasis::Row& row, const std::vector<double>& y)
{
  double sum = 0;
  for (const auto& [id, numerator] : row.numerators)
  {
    sum += static_cast<double>(numerator) * y[id];
  }
  return sum / static_cast<double>(row.denominator);
}

std::vector<std::int64_t> valuesAt(
  const IntegerLattice& lattice, const std::vector<std::int64_t>& coordinates)
{
  std::vector<std::int64_t> values;
  for (const IntegerRow& row : lattice.forms)
  {
    values.push_back(0);
    for (const auto& [id, factor] : row)
    {
      values.back() += factor * coordinates[id];
    }
  }
  return values;
}

/// Calls visit with every vector of `count` numbers from -reach to reach.
void enumerate(
  int count, int reach, const std::function<void(const std::vector<std::int64_t>&)>& visit)
{
  std::vector<std::int64_t> x(count, -reach);
  for (;;)
  {
    visit(x);
    int i = 0;
    while (i < count && ++x[i] > reach)
    {
      x[i++] = -reach;
    }
    if (i == count)
    {
      return;
    }
  }
}

} // namespace

TEST(IntegerLattice, HalfASumNeedsAnEvenOne)
{
  // a, b and (a + b) / 2, as round a vertex of valence 3: whole only for a and b of the same parity.
  const auto lattice = integerLattice(2,
    { form({ { 0, 1 } }, 1), form({ { 1, 1 } }, 1), form({ { 0, 1 }, { 1, 1 } }, 2) }, { 0, 0, 0 });
  ASSERT_TRUE(lattice);
  ASSERT_EQ(lattice->coordinates.size(), 2u);
  std::set<std::vector<std::int64_t>> reached;
  enumerate(2, 6, [&](const auto& x) { reached.insert(valuesAt(*lattice, x)); });
  enumerate(2, 2,
    [&](const auto& ab)
    {
      const bool even = (ab[0] + ab[1]) % 2 == 0;
      EXPECT_EQ(reached.count({ ab[0], ab[1], (ab[0] + ab[1]) / 2 }) > 0, even)
        << ab[0] << ", " << ab[1];
    });
}

TEST(IntegerLattice, DerivedFormsFollowFromTheOthersWherePossible)
{
  // With p free, t = 2 p is always whole; with t free, p = t / 2 would need an even t.
  const auto lattice =
    integerLattice(1, { form({ { 0, 2 } }, 1), form({ { 0, 1 } }, 1) }, { 1, 0 });
  ASSERT_TRUE(lattice);
  ASSERT_EQ(lattice->coordinates.size(), 1u);
  EXPECT_EQ(lattice->composite[0], 0);
  EXPECT_EQ(lattice->coordinates[0], (std::vector<std::pair<Index, double>>{ { 1, 1.0 } }));
}

TEST(IntegerLattice, HoldsExactlyTheWholeValuesThatFormsTakeTogether)
{
  std::size_t composites = 0;
  std::size_t members = 0;
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    std::mt19937 random(seed);
    std::vector<ExactBasis::Row> forms;
    constexpr std::int64_t kDenominators[] = { 1, 2, 3, 4, 6 };
    for (int f = 0; f < 5; ++f)
    {
      IntegerRow row;
      for (Index i = 0; i < 3; ++i)
      {
        const std::int64_t factor = static_cast<std::int64_t>(random() % 7) - 3;
        if (factor != 0)
        {
          row.emplace_back(i, factor);
        }
      }
      forms.push_back(form(row, kDenominators[random() % 5]));
    }
    const auto lattice = integerLattice(3, forms, std::vector<std::uint8_t>(5, 0));
    ASSERT_TRUE(lattice);
    for (const std::uint8_t flag : lattice->composite)
    {
      composites += flag;
    }
    // Unknowns on a grid that is fine enough to meet the lattice off the whole numbers.
    enumerate(3, 6,
      [&](const std::vector<std::int64_t>& x)
      {
        const std::vector<double> y{ x[0] / 2.0, x[1] / 3.0, x[2] / 2.0 };
        std::vector<double> values;
        for (const ExactBasis::Row& row : forms)
        {
          values.push_back(valueOf(row, y));
          if (std::abs(values.back() - std::round(values.back())) > 1e-6)
          {
            return;
          }
        }
        ++members;
        std::vector<std::int64_t> coordinates;
        for (const auto& coordinate : lattice->coordinates)
        {
          double sum = 0;
          for (const auto& [id, factor] : coordinate)
          {
            sum += factor * values[id];
          }
          EXPECT_NEAR(sum, std::round(sum), 1e-6) << seed;
          coordinates.push_back(std::lround(sum));
        }
        const std::vector<std::int64_t> back = valuesAt(*lattice, coordinates);
        for (std::size_t f = 0; f < forms.size(); ++f)
        {
          EXPECT_EQ(back[f], std::lround(values[f])) << seed;
        }
      });
  }
  EXPECT_GT(composites, 20u);
  EXPECT_GT(members, 400u);
}

TEST(IntegerLattice, OfNoFormsIsEmpty)
{
  const auto lattice = integerLattice(4, {}, {});
  ASSERT_TRUE(lattice);
  EXPECT_TRUE(lattice->forms.empty());
  EXPECT_TRUE(lattice->coordinates.empty());
}
