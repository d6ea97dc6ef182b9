// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Numerics/Untangler.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <limits>
#include <random>

using namespace quadrille;

namespace
{

/// A unit square of n by n cells, split into triangles, whose border points are fixed.
struct Square
{
  UntangleProblem problem;
  Eigen::VectorXd inside; ///< the unknowns at the regular grid

  explicit Square(int n)
  {
    const int points = (n + 1) * (n + 1);
    problem.offset = Eigen::VectorXd::Zero(2 * points);
    std::vector<Eigen::Triplet<double>> triplets;
    std::vector<double> regular;
    for (int p = 0; p < points; ++p)
    {
      const int i = p % (n + 1), j = p / (n + 1);
      const bool border = i == 0 || j == 0 || i == n || j == n;
      for (int k = 0; k < 2; ++k)
      {
        const double value = k == 0 ? i : j;
        if (border)
        {
          problem.offset[2 * p + k] = value;
        }
        else
        {
          triplets.emplace_back(2 * p + k, static_cast<int>(regular.size()), 1.0);
          regular.push_back(value);
        }
      }
    }
    problem.basis.resize(2 * points, regular.size());
    problem.basis.setFromTriplets(triplets.begin(), triplets.end());
    inside = Eigen::Map<Eigen::VectorXd>(regular.data(), regular.size());
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
        problem.triangles.push_back({ a, b, c });
        problem.triangles.push_back({ a, c, d });
        problem.inverseReference.push_back((Eigen::Matrix2d() << 1, 1, 0, 1).finished().inverse());
        problem.inverseReference.push_back((Eigen::Matrix2d() << 1, 0, 1, 1).finished().inverse());
        problem.weight.insert(problem.weight.end(), { 0.5, 0.5 });
      }
    }
  }
};

Eigen::VectorXd randomVector(Eigen::Index size, double low, double high, int seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  Eigen::VectorXd result(size);
  for (double& value : result)
  {
    value = uniform(random);
  }
  return result;
}

} // namespace

TEST(Untangler, RecoversARandomlyPerturbedSquareWithFixedBorder)
{
  for (int seed = 0; seed < 10; ++seed)
  {
    const Square square(20);
    const Eigen::VectorXd start = square.inside + randomVector(square.inside.size(), -2, 2, seed);
    UntangleOptions options;
    options.polishSteps = 30;
    const UntangleResult result = untangle(square.problem, start, options);
    EXPECT_TRUE(result.inverted.empty()) << "seed " << seed;
    EXPECT_GT(result.minimumDeterminant, 0);
    // The regular grid is the minimum (every J is the unit matrix) and Newton's method converges
    // quadratically: what is left after the polish is rounding and the stop at a gain of 1e-5.
    EXPECT_LT((result.y - square.inside).cwiseAbs().maxCoeff(), 1e-2) << "seed " << seed;
  }
}

TEST(Untangler, RecoversFromAllPointsAnywhere)
{
  const Square square(12);
  const UntangleResult result =
    untangle(square.problem, randomVector(square.inside.size(), 0, 12, 3), UntangleOptions());
  EXPECT_TRUE(result.inverted.empty());
  EXPECT_LT(result.steps, 40);
}

TEST(Untangler, FitOfReachableReferencesIsExact)
{
  const Square square(8);
  // A linear solve of well conditioned size: 1e-9 is far above its rounding.
  EXPECT_LT((fitReferences(square.problem) - square.inside).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Untangler, ReportsTrianglesThatCannotBecomePositive)
{
  Square square(4);
  // Border point 2 moved to the far side: its triangles cannot all be mended by inner points.
  std::swap(square.problem.offset[0], square.problem.offset[2 * 4]);
  const UntangleResult result = untangle(square.problem, square.inside, UntangleOptions());
  EXPECT_FALSE(result.inverted.empty());
  EXPECT_TRUE(result.y.allFinite());
}

TEST(Untangler, RefusesWhatIsNotFiniteOrDoesNotFit)
{
  const Square square(3);
  Eigen::VectorXd start = square.inside;
  start[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(untangle(square.problem, start, UntangleOptions()), InvalidInput);
  EXPECT_THROW(untangle(square.problem, Eigen::VectorXd::Zero(1), UntangleOptions()), InvalidInput);
}

TEST(Untangler, SameBytesEveryTime)
{
  const Square square(10);
  const Eigen::VectorXd start = square.inside + randomVector(square.inside.size(), -1, 1, 5);
  const UntangleResult a = untangle(square.problem, start, UntangleOptions());
  const UntangleResult b = untangle(square.problem, start, UntangleOptions());
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.steps, b.steps);
}

TEST(Untangler, WorkCountsTheFactorizations)
{
  // Inner points that all depend on all unknowns fill the factor; the map is the same.
  const Square sparse(14);
  Square filled(14);
  const Eigen::Index n = filled.inside.size();
  const Eigen::VectorXd u = Eigen::VectorXd::Constant(n, 1 / std::sqrt(static_cast<double>(n)));
  const Eigen::MatrixXd mirror = Eigen::MatrixXd::Identity(n, n) - 2 * u * u.transpose();
  filled.problem.basis = Eigen::SparseMatrix<double>((filled.problem.basis * mirror).sparseView());
  const Eigen::VectorXd start = sparse.inside + randomVector(n, -0.2, 0.2, 9);
  const UntangleResult a = untangle(sparse.problem, start, UntangleOptions());
  const UntangleResult b = untangle(filled.problem, mirror * start, UntangleOptions());
  const std::size_t triangles = sparse.problem.triangles.size();
  EXPECT_GE(a.work, static_cast<std::size_t>(a.steps) * triangles);
  EXPECT_GT(static_cast<double>(b.work) / b.steps, 2 * static_cast<double>(a.work) / a.steps);
}

TEST(Untangler, CancelsFromTheCallback)
{
  const Square square(6);
  UntangleOptions options;
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(untangle(square.problem, square.inside, options), Cancelled);
}
