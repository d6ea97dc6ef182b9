// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Numerics/IntegerRounding.h"
#include "Numerics/SparseCholesky.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <random>

using namespace quadrille;

namespace
{

/// By the one dense solver of these tests: each further one, and each further form of product, is
/// seconds of the compiler.
Eigen::MatrixXd solveDense(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right)
{
  return Eigen::FullPivLU<Eigen::MatrixXd>(matrix).solve(right);
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  return a * b;
}

/// y^T A y / 2 - b^T y and k forms, the columns of C.
struct Problem
{
  Eigen::MatrixXd A, C, transposed; ///< the last that of C
  Eigen::VectorXd b;

  Problem(int n, int k, unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto draw = [&](double) { return number(random); };
    const Eigen::MatrixXd half = Eigen::MatrixXd::Zero(n, n).unaryExpr(draw);
    A = product(half, half.transpose()) + Eigen::MatrixXd::Identity(n, n);
    C = Eigen::MatrixXd::Zero(n, k).unaryExpr(draw);
    transposed = C.transpose();
    b = 20 * Eigen::VectorXd::Zero(n).unaryExpr(draw);
  }

  /// The minimum with the given forms at the given values.
  Eigen::VectorXd solve(const std::vector<int>& fixed, const std::vector<double>& values) const
  {
    const Eigen::Index n = A.rows(), m = static_cast<Eigen::Index>(fixed.size());
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::MatrixXd right(n + m, 1);
    kkt.topLeftCorner(n, n) = A;
    right.topRows(n) = b;
    for (Eigen::Index i = 0; i < m; ++i)
    {
      kkt.block(0, n + i, n, 1) = C.col(fixed[i]);
      kkt.block(n + i, 0, 1, n) = C.col(fixed[i]).transpose();
      right(n + i, 0) = values[i];
    }
    return solveDense(kkt, right).topRows(n);
  }
};

/// Rounds by solving everything again each time.
Eigen::VectorXd roundByResolving(const Problem& problem, const std::vector<std::uint8_t>& last,
  RoundingOrder order, std::vector<std::int64_t>& value)
{
  const int k = static_cast<int>(problem.C.cols());
  std::vector<int> fixed;
  std::vector<double> values;
  value.assign(k, 0);
  std::vector<bool> done(k, false);
  Eigen::VectorXd y = problem.solve(fixed, values);
  for (const std::uint8_t batch : { 0, 1 })
  {
    const Eigen::VectorXd atBegin = product(problem.transposed, y);
    for (;;)
    {
      const Eigen::VectorXd x = order == RoundingOrder::OneAtATime
        ? Eigen::VectorXd(product(problem.transposed, y))
        : atBegin;
      int best = -1;
      double distance = std::numeric_limits<double>::infinity();
      for (int j = 0; j < k; ++j)
      {
        if (!done[j] && last[j] == batch && std::abs(x[j] - std::round(x[j])) < distance)
        {
          best = j;
          distance = std::abs(x[j] - std::round(x[j]));
        }
      }
      if (best < 0)
      {
        break;
      }
      done[best] = true;
      value[best] = std::lround(x[best]);
      fixed.push_back(best);
      values.push_back(std::round(x[best]));
      y = problem.solve(fixed, values);
    }
  }
  return y;
}

} // namespace

TEST(IntegerRounding, IsTheSameAsSolvingAgainAfterEachInteger)
{
  int differences = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    const Problem problem(14, 6, seed);
    std::vector<std::uint8_t> last(6, 0);
    last[seed % 6] = seed % 2;
    const Eigen::VectorXd y = solveDense(problem.A, problem.b);
    const Eigen::MatrixXd solved = solveDense(problem.A, problem.C);
    std::vector<std::int64_t> oneByOne;
    for (const RoundingOrder order : { RoundingOrder::OneAtATime, RoundingOrder::AllAtOnce })
    {
      const RoundedForms rounded = roundForms(
        product(problem.transposed, solved), product(problem.transposed, y), last, order);
      std::vector<std::int64_t> expected;
      const Eigen::VectorXd end = roundByResolving(problem, last, order, expected);
      EXPECT_EQ(rounded.value, expected) << seed;
      const Eigen::VectorXd moved = product(solved, rounded.multiplier);
      EXPECT_LT((y + moved - end).norm(), 1e-7 * (1 + end.norm())) << seed;
      differences += order == RoundingOrder::AllAtOnce && rounded.value != oneByOne ? 1 : 0;
      oneByOne = rounded.value;
    }
  }
  EXPECT_GT(differences, 10); // the orders are not the same thing
}

TEST(IntegerRounding, RefusesFormsThatDependOnEachOther)
{
  const Eigen::MatrixXd schur = Eigen::MatrixXd::Constant(2, 2, 1.0);
  EXPECT_THROW(roundForms(schur, Eigen::Vector2d(0.2, 0.3), { 0, 0 }, RoundingOrder::OneAtATime),
    InvalidInput);
  EXPECT_THROW(
    roundForms(schur, Eigen::Vector2d(0.2, 0.3), { 0 }, RoundingOrder::OneAtATime), InvalidInput);
}

TEST(SparseCholesky, GivesTheSchurComplementOfSparseColumns)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  constexpr int kSize = 60;
  for (const int columns : { 0, 1, 9, 80 }) // also with more rows of the product than a block has
  {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
    for (int i = 0; i < kSize; ++i)
    {
      dense(i, i) = 4;
      dense(i, random() % kSize) += number(random);
    }
    dense = product(dense, dense.transpose());
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(kSize, columns);
    for (int j = 0; j < columns; ++j)
    {
      for (int i = 0; i < (j % 3 == 0 ? 1 : 20); ++i)
      {
        c(random() % kSize, j) += number(random);
      }
    }
    SparseCholesky::Matrix lower =
      Eigen::MatrixXd(dense.triangularView<Eigen::Lower>()).sparseView();
    lower.makeCompressed();
    SparseCholesky solver;
    solver.analyze(lower);
    ASSERT_TRUE(solver.factorize(lower, 0));
    const Eigen::MatrixXd schur = solver.schur(c.sparseView());
    const Eigen::MatrixXd expected = product(c.transpose(), solveDense(dense, c));
    ASSERT_EQ(schur.rows(), columns);
    EXPECT_LT((schur - expected).norm(), 1e-12 * (1 + expected.norm())) << columns;
  }
}
