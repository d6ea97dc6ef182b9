// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "../TestMeshes.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Numerics/NestedSolver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <chrono>
#include <cstring>
#include <random>

using namespace quadrille;

namespace
{

/// A positive definite matrix a triangle, and right sides; the same whoever asks and when.
struct RandomSystem
{
  std::vector<Vector3> position;
  std::vector<std::uint8_t> unknowns;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<NestedSolver::Matrix6> matrix;
  std::vector<NestedSolver::Vector6> rightSide;

  /// every: vertices with one unknown and with none, each one of so many.
  RandomSystem(const Mesh& mesh, int every, double sign = 1)
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-1, 1);
    position = mesh.position;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      unknowns.push_back(v % every == 0 ? 0 : v % every == 1 ? 1 : 2);
    }
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      triangles.push_back({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
      const NestedSolver::Matrix6 root = NestedSolver::Matrix6::NullaryExpr(
        [&](Eigen::Index, Eigen::Index) { return value(random); });
      matrix.push_back(sign * (root * root.transpose() + 0.1 * NestedSolver::Matrix6::Identity()));
      rightSide.push_back(
        NestedSolver::Vector6::NullaryExpr([&](Eigen::Index) { return value(random); }));
    }
  }
  NestedSolver::Element element() const
  {
    return [this](Index t, NestedSolver::Matrix6& m, NestedSolver::Vector6& b)
    {
      m = matrix[t];
      b = rightSide[t];
    };
  }
  /// The same system as a dense one.
  Eigen::VectorXd solveDensely(double shift) const
  {
    std::vector<Eigen::Index> first{ 0 };
    for (const std::uint8_t count : unknowns)
    {
      first.push_back(first.back() + count);
    }
    Eigen::MatrixXd full = shift * Eigen::MatrixXd::Identity(first.back(), first.back());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(first.back());
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      std::vector<Eigen::Index> place;
      for (const Index v : triangles[t])
      {
        for (Eigen::Index k = 0; k < unknowns[v]; ++k)
        {
          place.push_back(first[v] + k);
        }
      }
      for (std::size_t i = 0; i < place.size(); ++i)
      {
        right[place[i]] += rightSide[t][static_cast<Eigen::Index>(i)];
        for (std::size_t j = 0; j < place.size(); ++j)
        {
          full(place[i], place[j]) +=
            matrix[t](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
      }
    }
    return full.ldlt().solve(right);
  }
};

} // namespace

TEST(NestedSolver, SolvesWhatADenseSolverSolves)
{
  for (const Mesh& mesh : { test::gridPlane(1, 1), test::gridPlane(5, 3), test::gridPlane(21, 19),
         test::plateWithHole(6) })
  {
    for (const int every : { 1000000, 5 })
    {
      const RandomSystem system(mesh, every);
      NestedSolver solver(system.position, system.unknowns, system.triangles);
      for (const double shift : { 0.0, 0.5 })
      {
        Eigen::VectorXd x;
        ASSERT_TRUE(solver.solve(system.element(), shift, 1, x));
        const Eigen::VectorXd expected = system.solveDensely(shift);
        ASSERT_EQ(x.size(), expected.size());
        // Two direct methods; the condition number is some thousands.
        EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm())
          << mesh.faceCount() << " " << every;
      }
    }
  }
}

TEST(NestedSolver, SameBytesForAnyNumberOfThreads)
{
  const RandomSystem system(test::gridPlane(60, 60), 7);
  std::vector<Eigen::VectorXd> solutions;
  for (const int threads : { 1, 2, 4 })
  {
    NestedSolver solver(system.position, system.unknowns, system.triangles);
    solutions.emplace_back();
    ASSERT_TRUE(solver.solve(system.element(), 0, threads, solutions.back()));
    EXPECT_EQ(std::memcmp(solutions.back().data(), solutions.front().data(),
                sizeof(double) * static_cast<std::size_t>(solutions.front().size())),
      0);
  }
}

TEST(NestedSolver, TellsWhenAMatrixIsNotPositiveDefinite)
{
  const RandomSystem system(test::gridPlane(9, 9), 1000000, -1);
  NestedSolver solver(system.position, system.unknowns, system.triangles);
  Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 5.0);
  EXPECT_FALSE(solver.solve(system.element(), 0, 2, x));
  EXPECT_EQ(x.size(), 1);
  EXPECT_TRUE(solver.solve(system.element(), 1e3, 2, x)); // the same solver serves again
}

/// Nested dissection of a plane: work grows like n^1.5, a band solver's like n^2.
TEST(NestedSolver, WorkGrowsSlowly)
{
  const auto operations = [](int n)
  {
    const RandomSystem system(test::gridPlane(n, n), 1000000);
    return NestedSolver(system.position, system.unknowns, system.triangles).operations();
  };
  EXPECT_LT(operations(128), 120 * operations(32)); // 16 times the vertices: 64 against 256
}

TEST(NestedSolver, RefusesWhatDoesNotFit)
{
  const RandomSystem system(test::gridPlane(2, 2), 1000000);
  auto triangles = system.triangles;
  triangles.front()[1] = 1000;
  EXPECT_THROW(NestedSolver(system.position, system.unknowns, triangles), InvalidInput);
  EXPECT_THROW(NestedSolver(system.position, { 1, 1 }, system.triangles), InvalidInput);
}

TEST(NestedSolver, StopsOnRequest)
{
  const RandomSystem system(test::gridPlane(40, 40), 1000000);
  NestedSolver solver(system.position, system.unknowns, system.triangles);
  const PollScope scope([](double, const std::string&) { return false; });
  const auto slow = [&](Index t, NestedSolver::Matrix6& m, NestedSolver::Vector6& b)
  {
    const auto begin = std::chrono::steady_clock::now();
    while (t == 0 && std::chrono::steady_clock::now() - begin < 2 * PollScope::kInterval)
    {
    }
    m = system.matrix[t];
    b = system.rightSide[t];
  };
  Eigen::VectorXd x;
  EXPECT_THROW(solver.solve(slow, 0, 1, x), Cancelled);
}
