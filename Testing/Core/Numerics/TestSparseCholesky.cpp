// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Progress.h"
#include "Numerics/SparseCholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <random>
#include <thread>
#include <vector>

using namespace quadrille;

namespace
{

/// Lower triangle of a random matrix with some entries a row, made positive definite by its diagonal.
SparseCholesky::Matrix randomMatrix(
  int n, int perRow, std::mt19937& random, double dominance = 1.01)
{
  std::uniform_real_distribution<double> value(-1, 1);
  std::uniform_int_distribution<int> index(0, n - 1);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n * perRow; ++k)
  {
    const int i = index(random), j = index(random);
    dense(std::max(i, j), std::min(i, j)) = value(random);
  }
  const Eigen::MatrixXd full = dense.selfadjointView<Eigen::Lower>();
  for (int i = 0; i < n; ++i)
  {
    dense(i, i) = dominance * (full.row(i).cwiseAbs().sum() - std::abs(full(i, i))) + 0.01;
  }
  SparseCholesky::Matrix lower = Eigen::MatrixXd(dense.triangularView<Eigen::Lower>()).sparseView();
  lower.makeCompressed();
  return lower;
}

} // namespace

TEST(SparseCholesky, FlopsFollowTheFill)
{
  // A dense matrix of 4: columns of L with 3, 2, 1, 0 entries below the diagonal. A diagonal one has none.
  SparseCholesky::Matrix dense =
    Eigen::MatrixXd(Eigen::MatrixXd::Constant(4, 4, 0.1).triangularView<Eigen::Lower>())
      .sparseView();
  SparseCholesky solver;
  solver.analyze(dense);
  EXPECT_EQ(solver.factorFlops(), 3 * 4 + 2 * 3 + 1 * 2);
  SparseCholesky::Matrix diagonal(4, 4);
  diagonal.setIdentity();
  diagonal.makeCompressed();
  solver.analyze(diagonal);
  EXPECT_EQ(solver.factorFlops(), 0);
}

TEST(SparseCholesky, SolvesWhatADenseSolverSolves)
{
  std::mt19937 random(3);
  for (const int n : { 1, 2, 5, 40, 150 })
  {
    SparseCholesky solver;
    SparseCholesky::Matrix lower = randomMatrix(n, 3, random);
    solver.analyze(lower);
    for (const double shift : { 0.0, 0.5 }) // the pattern serves several factorizations
    {
      const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
      ASSERT_TRUE(solver.factorize(lower, shift));
      Eigen::MatrixXd full = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
      full.diagonal().array() += shift;
      EXPECT_LT((full * solver.solve(b) - b).norm(), 1e-10 * b.norm()) << n << " " << shift;
      lower *= 2;
    }
  }
}

TEST(SparseCholesky, TellsWhatIsNotPositiveDefinite)
{
  std::mt19937 random(5);
  const SparseCholesky::Matrix lower = randomMatrix(60, 3, random);
  SparseCholesky solver;
  solver.analyze(lower);
  const Eigen::MatrixXd full = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues()[0];
  EXPECT_TRUE(solver.factorize(lower, -0.99 * least));
  EXPECT_FALSE(solver.factorize(lower, -1.01 * least));
  EXPECT_FALSE(solver.factorize(lower, std::nan("")));
  EXPECT_TRUE(solver.factorize(lower, 0)) << "a failure leaves nothing behind";
}

TEST(SparseCholesky, RefusesOtherMatrices)
{
  std::mt19937 random(7);
  SparseCholesky solver;
  SparseCholesky::Matrix rectangle(3, 2);
  rectangle.makeCompressed();
  EXPECT_THROW(solver.analyze(rectangle), InvalidInput);
  SparseCholesky::Matrix hollow(2, 2);
  hollow.insert(1, 0) = 1;
  hollow.makeCompressed();
  EXPECT_THROW(solver.analyze(hollow), InvalidInput);
  solver.analyze(randomMatrix(20, 2, random));
  EXPECT_THROW(solver.factorize(randomMatrix(21, 2, random), 0), InvalidInput);
}

TEST(SparseCholesky, StopsOnRequest)
{
  std::mt19937 random(9);
  const SparseCholesky::Matrix lower = randomMatrix(40, 3, random);
  SparseCholesky solver;
  solver.analyze(lower);
  PollScope scope([](double, const std::string&) { return false; });
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(solver.factorize(lower, 0), Cancelled);
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(SparseCholesky().analyze(lower), Cancelled);
}
