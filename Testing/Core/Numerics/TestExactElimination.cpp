// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Numerics/ExactElimination.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>
#include <thread>

using namespace quadrille;

namespace
{

std::vector<IntegerRow> randomEquations(int seed, Index variables, int count)
{
  std::mt19937 random(seed);
  std::vector<IntegerRow> equations;
  for (int e = 0; e < count; ++e)
  {
    IntegerRow row;
    const int length = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < length; ++i)
    {
      row.emplace_back(random() % variables, static_cast<std::int64_t>(random() % 5) - 2);
    }
    equations.push_back(row);
  }
  return equations;
}

Eigen::Index rankOf(Index variables, const std::vector<IntegerRow>& equations)
{
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(equations.size(), variables);
  for (std::size_t e = 0; e < equations.size(); ++e)
  {
    for (const auto& term : equations[e])
    {
      matrix(e, term.first) += static_cast<double>(term.second);
    }
  }
  return Eigen::FullPivLU<Eigen::MatrixXd>(matrix).rank();
}

} // namespace

TEST(ExactElimination, EveryStepOfTheBasisSolvesTheEquationsInIntegers)
{
  for (int seed = 0; seed < 50; ++seed)
  {
    const Index variables = 30;
    const std::vector<IntegerRow> equations = randomEquations(seed, variables, 22);
    const std::optional<ExactBasis> basis = eliminateExactly(variables, equations);
    ASSERT_TRUE(basis);
    EXPECT_EQ(static_cast<Eigen::Index>(basis->free.size()),
      Eigen::Index(variables) - rankOf(variables, equations));
    std::vector<std::int64_t> x(variables);
    for (Index i = 0; i < variables; ++i)
    {
      std::int64_t sum = 0;
      for (const auto& [id, numerator] : basis->rows[i].numerators)
      {
        sum += numerator * basis->step[id] * (static_cast<std::int64_t>(id) * 7 - 11);
      }
      EXPECT_EQ(sum % basis->rows[i].denominator, 0);
      x[i] = sum / basis->rows[i].denominator;
    }
    for (const IntegerRow& row : equations)
    {
      std::int64_t sum = 0;
      for (const auto& term : row)
      {
        sum += term.second * x[term.first];
      }
      EXPECT_EQ(sum, 0);
    }
  }
}

TEST(ExactElimination, ContradictionOfHomogeneousEquationsIsZero)
{
  const auto basis = eliminateExactly(2, { { { 0, 1 }, { 1, 1 } }, { { 0, 1 }, { 1, -1 } } });
  ASSERT_TRUE(basis);
  EXPECT_TRUE(basis->free.empty());
  EXPECT_TRUE(basis->rows[0].numerators.empty());
  EXPECT_TRUE(basis->rows[1].numerators.empty());
}

TEST(ExactElimination, OverflowIsToldNotWrapped)
{
  const std::int64_t large = std::int64_t{ 1 } << 62;
  EXPECT_FALSE(eliminateExactly(2, { { { 0, large }, { 0, large }, { 1, 1 } } }));
}

TEST(ExactElimination, StopsOnRequest)
{
  PollScope scope([](double, const std::string&) { return false; });
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(eliminateExactly(3, { { { 0, 1 }, { 1, -1 } }, { { 1, 2 }, { 2, 1 } } }), Cancelled);
}
