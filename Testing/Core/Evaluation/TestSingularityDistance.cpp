// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Evaluation/SingularityDistance.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// The vertex of a plane at (x, y, 0).
Index at(const Mesh& mesh, double x, double y)
{
  Index v = 0;
  while (v < mesh.vertexCount() && mesh.position[v] != Vector3(x, y, 0))
  {
    ++v;
  }
  return v;
}

/// Rounding of an edge to 1 / 1024 of the mean edge, over at most twenty edges.
constexpr double kRounding = 20.0 / 1024;

} // namespace

TEST(SingularityDistance, IsZeroBetweenEqualFields)
{
  const Mesh mesh = gridPlane(10, 10);
  std::vector<int> turns = regularTurns(mesh);
  turns[at(mesh, 4, 4)] = 3;
  turns[at(mesh, 6, 4)] = 5;
  EXPECT_EQ(singularityDistance(mesh, turns, turns).work, 0);
}

TEST(SingularityDistance, IsTheWayASingularityMovedTimesItsIndex)
{
  const Mesh mesh = gridPlane(20, 10);
  for (const int index : { -2, -1, 1, 2 })
  {
    std::vector<int> before = regularTurns(mesh);
    std::vector<int> after = before;
    before[at(mesh, 3, 5)] = 4 - index;
    after[at(mesh, 15, 5)] = 4 - index;
    EXPECT_NEAR(
      singularityDistance(mesh, before, after).work, 12.0 * std::abs(index), 2 * kRounding);
    EXPECT_NEAR(
      singularityDistance(mesh, after, before).work, 12.0 * std::abs(index), 2 * kRounding);
  }
}

TEST(SingularityDistance, SplitsAndPairsCostTheirWaysOnly)
{
  const Mesh mesh = gridPlane(20, 10);
  std::vector<int> before = regularTurns(mesh);
  std::vector<int> after = before;
  before[at(mesh, 5, 5)] = 2; // splits into two that go two edges each
  after[at(mesh, 3, 5)] = 3;
  after[at(mesh, 7, 5)] = 3;
  after[at(mesh, 14, 2)] = 3; // and a new pair, one edge apart
  after[at(mesh, 15, 2)] = 5;
  EXPECT_NEAR(singularityDistance(mesh, before, after).work, 5, kRounding);
}

TEST(SingularityDistance, TellsSumsThatDiffer)
{
  const Mesh mesh = gridPlane(10, 10);
  std::vector<int> after = regularTurns(mesh);
  after[at(mesh, 5, 5)] = 3;
  EXPECT_EQ(singularityDistance(mesh, regularTurns(mesh), after).unmatched, 1);
  EXPECT_THROW(singularityDistance(mesh, after, {}), InvalidInput);
}

TEST(SingularityDistance, HistogramLeavesRegularAndBoundaryVerticesOut)
{
  const Mesh mesh = gridPlane(10, 10);
  std::vector<int> turns = regularTurns(mesh);
  EXPECT_TRUE(singularityHistogram(mesh, turns).empty());
  turns[at(mesh, 0, 0)] = 1;
  turns[at(mesh, 2, 2)] = 3;
  turns[at(mesh, 4, 2)] = 3;
  turns[at(mesh, 6, 2)] = 5;
  const std::map<int, std::size_t> expected{ { 3, 2 }, { 5, 1 } };
  EXPECT_EQ(singularityHistogram(mesh, turns), expected);
}
