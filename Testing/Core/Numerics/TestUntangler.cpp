// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Numerics/IsotropicEnergy.h"
#include "Numerics/LocalProblem.h"
#include "Numerics/ReducedTriangles.h"
#include "Numerics/Untangler.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

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

/// To count what is inverted as it is.
UntangleOptions stepless()
{
  UntangleOptions options;
  options.maximumSteps = 0;
  return options;
}

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

/// In the middle the references are so many times as wide as the cells that the border leaves them.
Square withWideMiddle(int n, double wide)
{
  Square square(n);
  for (int j = n / 4; j < n - n / 4; ++j)
  {
    for (int i = n / 4; i < n - n / 4; ++i)
    {
      for (int k = 0; k < 2; ++k)
      {
        const std::size_t t = 2 * static_cast<std::size_t>(j * n + i) + static_cast<std::size_t>(k);
        square.problem.inverseReference[t] =
          square.problem.inverseReference[t] * Eigen::Vector2d(1 / wide, 1).asDiagonal();
        square.problem.weight[t] *= wide;
      }
    }
  }
  return square;
}

double ratioOf(const Jacobian& j)
{
  const double a = j.squaredNorm() / (2 * determinantOf(j));
  return a + std::sqrt(std::max(0.0, a * a - 1));
}

/// Of the weight of all triangles, that of those beyond the ratio.
double shareBeyond(const UntangleProblem& problem, const Eigen::VectorXd& y, double ratio)
{
  std::vector<Jacobian> jacobians;
  ReducedTriangles(problem).jacobians(y, jacobians);
  double beyond = 0, all = 0;
  for (std::size_t t = 0; t < jacobians.size(); ++t)
  {
    all += problem.weight[t];
    beyond += ratioOf(jacobians[t]) > ratio ? problem.weight[t] : 0;
  }
  return beyond / all;
}

} // namespace

TEST(RatioEnergy, DerivativesAreThoseOfItsValue)
{
  RatioEnergy energy;
  energy.weight = 3;
  energy.bound = 1.1;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-2, 2);
  int tried = 0;
  for (int i = 0; i < 4000 && tried < 200; ++i)
  {
    const Jacobian j(uniform(random), uniform(random), uniform(random), uniform(random));
    // The knee is narrow against the difference step elsewhere.
    energy.knee = i % 2 == 0 ? 0.02 : 0.5;
    if (!energy.applies(j) || determinantOf(j) < 0.3 || ratioOf(j) < 1.8)
    {
      continue;
    }
    ++tried;
    Jacobian gradient;
    Eigen::Matrix4d hessian;
    energy.derivatives(j, gradient, hessian);
    constexpr double kStep = 1e-5;
    Eigen::Matrix4d second;
    for (int k = 0; k < 4; ++k)
    {
      const Jacobian step = kStep * Jacobian::Unit(k);
      const double slope = (energy.value(j + step) - energy.value(j - step)) / (2 * kStep);
      EXPECT_NEAR(gradient[k], slope, 1e-5 * (1 + gradient.norm()));
      for (int l = 0; l < 4; ++l)
      {
        const Jacobian other = 10 * kStep * Jacobian::Unit(l), one = 10 * step;
        second(k, l) = (energy.value(j + one + other) - energy.value(j + one - other) -
                         energy.value(j - one + other) + energy.value(j - one - other)) /
          (4 * 100 * kStep * kStep);
      }
    }
    Eigen::Matrix4d projected = Eigen::Matrix4d::Zero();
    // Of any size, as the test of SparseCholesky has it; one of four rows is further seconds of the compiler.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(Eigen::MatrixXd{ second });
    for (int k = 0; k < 4; ++k)
    {
      const Eigen::Vector4d direction = spectrum.eigenvectors().col(k);
      projected += std::max(0.0, spectrum.eigenvalues()[k]) * direction * direction.transpose();
    }
    EXPECT_LT((hessian - projected).norm(), 1e-3 * (1 + second.norm())) << j.transpose();
  }
  EXPECT_EQ(tried, 200);
}

TEST(RatioEnergy, BeginsSmoothlyAtTheLimit)
{
  RatioEnergy energy;
  energy.weight = 1;
  energy.bound = (2 + 0.5) / 2;
  const auto stretched = [](double ratio) { return Jacobian(ratio, 0, 0, 1); };
  EXPECT_FALSE(energy.applies(stretched(1.99)));
  EXPECT_FALSE(energy.applies(stretched(1 / 1.99)));
  EXPECT_FALSE(energy.applies(Jacobian(1, 0, 0, -1)));
  EXPECT_FALSE(energy.applies(Jacobian(1, 0, 0, 0)));
  for (const double ratio : { 2.0001, 1 / 2.0001 })
  {
    ASSERT_TRUE(energy.applies(stretched(ratio)));
    Jacobian gradient;
    Eigen::Matrix4d hessian;
    energy.derivatives(stretched(ratio), gradient, hessian);
    EXPECT_LT(energy.value(stretched(ratio)), 1e-8);
    EXPECT_LT(gradient.norm(), 1e-3);
  }
  EXPECT_GT(energy.value(stretched(3)), 1e-3);
}

TEST(AxisEnergy, DerivativesAreThoseOfItsValue)
{
  AxisEnergy energy;
  energy.weight = 3;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 100; ++i)
  {
    const Jacobian j(uniform(random), uniform(random), uniform(random), uniform(random));
    const Jacobian off(uniform(random), uniform(random), uniform(random), uniform(random));
    Jacobian gradient = Jacobian::Zero();
    Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
    energy.addDerivatives(off, j, gradient, hessian);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 4; ++k)
    {
      const Jacobian step = kStep * Jacobian::Unit(k);
      // Central differences: the error is of the order of the step squared.
      EXPECT_NEAR(gradient[k],
        (energy.value(off.dot(j + step)) - energy.value(off.dot(j - step))) / (2 * kStep), 1e-7);
      Jacobian before = Jacobian::Zero(), after = Jacobian::Zero();
      Eigen::Matrix4d unused = Eigen::Matrix4d::Zero();
      energy.addDerivatives(off, j - step, before, unused);
      energy.addDerivatives(off, j + step, after, unused);
      EXPECT_LT((hessian.col(k) - (after - before) / (2 * kStep)).norm(), 1e-6);
    }
  }
}

TEST(Untangler, ALimitLowersTheShareBeyondIt)
{
  constexpr double kLimit = 1.4;
  const Square square = withWideMiddle(16, 4);
  UntangleOptions options;
  options.areaWeight = 1;
  options.polishSteps = 60;
  const UntangleResult free = untangle(square.problem, square.inside, options);
  options.anisotropyLimit = kLimit;
  const UntangleResult limited = untangle(square.problem, square.inside, options);
  EXPECT_TRUE(limited.inverted.empty());
  const double before = shareBeyond(square.problem, free.y, 1.05 * kLimit);
  EXPECT_GT(before, 0.5);
  EXPECT_LT(shareBeyond(square.problem, limited.y, 1.05 * kLimit), 0.5 * before);
  // Where no triangle has a limit it changes nothing.
  options.limitedTriangles = 0;
  EXPECT_EQ(untangle(square.problem, square.inside, options).y, free.y);
}

TEST(Untangler, ALimitThatNothingReachesChangesNoBit)
{
  const Square square = withWideMiddle(12, 2);
  const Eigen::VectorXd start = square.inside + randomVector(square.inside.size(), -1, 1, 7);
  const UntangleResult off = untangle(square.problem, start, UntangleOptions());
  UntangleOptions options;
  options.anisotropyLimit = 1e9;
  const UntangleResult on = untangle(square.problem, start, options);
  EXPECT_EQ(on.y, off.y);
  EXPECT_EQ(on.steps, off.steps);
}

TEST(Untangler, ALimitIsLookedAtOnceTheMapIsValid)
{
  const Square square = withWideMiddle(12, 2);
  for (int seed = 0; seed < 5; ++seed)
  {
    const Eigen::VectorXd start = square.inside + randomVector(square.inside.size(), -2, 2, seed);
    UntangleOptions options;
    options.polishSteps = 0;
    const UntangleResult off = untangle(square.problem, start, options);
    options.anisotropyLimit = 1.1;
    const UntangleResult on = untangle(square.problem, start, options);
    EXPECT_GT(off.steps, 1);
    EXPECT_TRUE(off.inverted.empty()) << "seed " << seed;
    EXPECT_EQ(on.y, off.y) << "seed " << seed;
    options.polishSteps = 20;
    const UntangleResult limited = untangle(square.problem, start, options);
    EXPECT_TRUE(limited.inverted.empty()) << "seed " << seed;
    EXPECT_NE(limited.y, off.y) << "seed " << seed;
  }
}

TEST(Untangler, GoesOnWhereAFewStepsLeaveAPositiveMapFarFromItsMinimum)
{
  // All points are pressed to the left side: rows of slivers, each positive.
  constexpr int kCells = 20;
  const Square square(kCells);
  Eigen::VectorXd start = square.inside;
  for (Eigen::Index i = 0; i < start.size(); i += 2)
  {
    start[i] = kCells * std::pow(start[i] / kCells, 6);
  }
  const auto deviation = [&](const UntangleResult& result)
  { return (result.y - square.inside).cwiseAbs().maxCoeff(); };
  UntangleOptions options;
  options.areaWeight = 1;
  options.polishSteps = 4;
  const UntangleResult few = untangle(square.problem, start, options);
  options.leastGain = 0.01;
  const UntangleResult all = untangle(square.problem, start, options);
  EXPECT_TRUE(few.inverted.empty() && all.inverted.empty());
  EXPECT_LT(few.steps, 7);
  EXPECT_GT(deviation(few), 1);
  EXPECT_LT(deviation(all), 0.2);
  // Near the minimum it takes no more.
  EXPECT_LE(untangle(square.problem, all.y, options).steps, 4);
}

TEST(Untangler, RefusesALimitThatIsNone)
{
  const Square square(3);
  for (const double limit : { 0.99, -1.0, std::numeric_limits<double>::infinity(),
         std::numeric_limits<double>::quiet_NaN() })
  {
    UntangleOptions options;
    options.anisotropyLimit = limit;
    EXPECT_THROW(untangle(square.problem, square.inside, options), InvalidInput) << limit;
  }
}

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

/// Points of the square at most `distance` from the middle, along either axis.
std::vector<std::uint8_t> nearMiddle(int n, int distance)
{
  std::vector<std::uint8_t> near;
  for (int p = 0; p < (n + 1) * (n + 1); ++p)
  {
    const int i = p % (n + 1), j = p / (n + 1);
    near.push_back(std::max(std::abs(i - n / 2), std::abs(j - n / 2)) <= distance ? 1 : 0);
  }
  return near;
}

TEST(LocalProblem, MendsAPlaceAndHoldsTheRest)
{
  const int n = 12;
  const Square square(n);
  // The rest is not where the whole would have it, and stays so.
  Eigen::VectorXd bent = square.inside + randomVector(square.inside.size(), -0.05, 0.05, 1);
  const std::vector<std::uint8_t> moved = nearMiddle(n, 1), near = nearMiddle(n, 2);
  const LocalProblem middle = localProblem(square.problem, bent, moved);
  ASSERT_EQ(middle.unknowns.size(), 2u * 3 * 3);
  const Eigen::VectorXd tangled = middle.put(Eigen::VectorXd::Zero(18), bent);
  ASSERT_FALSE(untangle(square.problem, tangled, stepless()).inverted.empty());

  const LocalProblem local = localProblem(square.problem, tangled, near);
  EXPECT_EQ(local.unknowns.size(), 2u * 5 * 5);
  // The cells between the points near and those round them.
  EXPECT_EQ(local.triangles.size(), 2u * 6 * 6 - 2);
  const UntangleResult result =
    untangle(local.problem, fitReferences(local.problem), UntangleOptions());
  EXPECT_TRUE(result.inverted.empty());
  const Eigen::VectorXd mended = local.put(result.y, tangled);
  EXPECT_TRUE(untangle(square.problem, mended, stepless()).inverted.empty());
  std::vector<std::uint8_t> isFree(static_cast<std::size_t>(bent.size()), 0);
  for (const Index unknown : local.unknowns)
  {
    isFree[unknown] = 1;
  }
  for (Eigen::Index i = 0; i < bent.size(); ++i)
  {
    EXPECT_TRUE(isFree[static_cast<std::size_t>(i)] != 0 || mended[i] == bent[i]) << i;
  }
}

TEST(LocalProblem, OfAllPointsIsTheWhole)
{
  const Square square(6);
  const Eigen::VectorXd y = square.inside + randomVector(square.inside.size(), -1, 1, 2);
  const LocalProblem local = localProblem(square.problem, y, nearMiddle(6, 6));
  // But for those in two corners, which nothing moves.
  EXPECT_EQ(local.triangles.size() + 2, square.problem.triangles.size());
  EXPECT_LT((fitReferences(local.problem) - square.inside).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LocalProblem, RefusesWhatDoesNotFit)
{
  const Square square(3);
  EXPECT_THROW(localProblem(square.problem, square.inside, nearMiddle(4, 1)), InvalidInput);
  EXPECT_THROW(
    localProblem(square.problem, Eigen::VectorXd::Zero(1), nearMiddle(3, 1)), InvalidInput);
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
  // A unit is a microsecond, a third of which a triangle takes without the factorization.
  EXPECT_GE(3 * a.work, static_cast<std::size_t>(a.steps) * triangles);
  EXPECT_GT(static_cast<double>(b.work) / b.steps, 2 * static_cast<double>(a.work) / a.steps);
}

TEST(Untangler, CancelsFromTheCallback)
{
  const Square square(6);
  UntangleOptions options;
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(untangle(square.problem, square.inside, options), Cancelled);
}
