// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Evaluation/Distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace quadrille;

namespace
{

constexpr double kSumRounding = 1e-12;

WeightedDistribution randomDistribution(std::mt19937& random, std::size_t count)
{
  std::uniform_real_distribution<double> number(0, 1);
  std::vector<double> values, weights;
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(number(random));
    weights.push_back(number(random));
  }
  return { values, weights };
}

} // namespace

TEST(Distribution, CountsByWeight)
{
  const WeightedDistribution d({ 3, 1, 2, 9 }, { 1, 2, 1, 0 });
  EXPECT_EQ(d.size(), 3U);
  EXPECT_NEAR(d.total(), 4, kSumRounding);
  EXPECT_NEAR(d.mean(), 7.0 / 4, kSumRounding);
  EXPECT_EQ(d.minimum(), 1);
  EXPECT_EQ(d.maximum(), 3);
  EXPECT_EQ(d.quantile(0), 1);
  EXPECT_EQ(d.quantile(0.5), 1);
  EXPECT_EQ(d.quantile(0.6), 2);
  EXPECT_EQ(d.quantile(1), 3);
}

TEST(Distribution, HistogramHoldsAllOfTheWeight)
{
  const WeightedDistribution d({ -5, 0, 1, 1.5, 2, 7 }, { 1, 1, 1, 1, 1, 3 });
  const std::vector<double> shares = d.histogram({ 0, 1, 2 });
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], 2.0 / 8, kSumRounding); // -5 and 0
  EXPECT_NEAR(shares[1], 6.0 / 8, kSumRounding); // 1, 1.5, 2 and 7
  EXPECT_THROW(d.histogram({ 1 }), InvalidInput);
  EXPECT_THROW(d.histogram({ 2, 1 }), InvalidInput);
  EXPECT_EQ(WeightedDistribution().histogram({ 0, 1 }), std::vector<double>{ 0 });
}

TEST(Distribution, RefusesWhatIsNoNumber)
{
  EXPECT_THROW(WeightedDistribution({ 1 }, {}), InvalidInput);
  EXPECT_THROW(WeightedDistribution({ std::nan("") }, { 1 }), InvalidInput);
  EXPECT_THROW(
    WeightedDistribution({ 1 }, { std::numeric_limits<double>::infinity() }), InvalidInput);
}

TEST(WassersteinDistance, OfAShiftIsItsLength)
{
  std::mt19937 random(1);
  const WeightedDistribution a = randomDistribution(random, 40);
  for (const double shift : { -2.5, 0.0, 0.125, 3.0 })
  {
    std::vector<double> values, weights;
    for (const auto& [value, weight] : a.entries())
    {
      values.push_back(value + shift);
      weights.push_back(3 * weight); // totals do not matter
    }
    EXPECT_NEAR(wassersteinDistance(a, { values, weights }), std::abs(shift), 1e-9);
  }
}

TEST(WassersteinDistance, OfEqualWeightsIsThatOfSortedPairs)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<double> a(25), b(25);
  std::generate(a.begin(), a.end(), [&] { return number(random); });
  std::generate(b.begin(), b.end(), [&] { return number(random); });
  const std::vector<double> ones(25, 1.0);
  const double distance = wassersteinDistance({ a, ones }, { b, ones });
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += std::abs(a[i] - b[i]) / 25;
  }
  EXPECT_NEAR(distance, sum, kSumRounding);
}

TEST(WassersteinDistance, IsAMetric)
{
  std::mt19937 random(3);
  const WeightedDistribution a = randomDistribution(random, 30);
  const WeightedDistribution b = randomDistribution(random, 17);
  const WeightedDistribution c = randomDistribution(random, 5);
  EXPECT_EQ(wassersteinDistance(a, a), 0);
  EXPECT_NEAR(wassersteinDistance(a, b), wassersteinDistance(b, a), kSumRounding);
  EXPECT_GT(wassersteinDistance(a, b), 0);
  EXPECT_LE(wassersteinDistance(a, c),
    wassersteinDistance(a, b) + wassersteinDistance(b, c) + kSumRounding);
  EXPECT_EQ(wassersteinDistance({}, {}), 0);
  EXPECT_THROW(wassersteinDistance(a, {}), InvalidInput);
}
