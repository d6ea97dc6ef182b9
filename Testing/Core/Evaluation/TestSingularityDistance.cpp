// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Evaluation/GeodesicGraph.h"
#include "Evaluation/SingularityDistance.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

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

/// Ways along an axis of the grid are exact but for single precision.
constexpr double kWayRounding = 1e-5;
/// What a way may be longer than the geodesic, see GeodesicGraph.
constexpr double kWayDetour = 1.01;

/// A vertex of the mesh near a point.
Index nearest(const Mesh& mesh, const Vector3& p)
{
  Index best = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    best = (mesh.position[v] - p).norm() < (mesh.position[best] - p).norm() ? v : best;
  }
  return best;
}

/// The least cost of matching the first points with the second ones, one by one, by trying all ways to.
double leastMatching(
  const GeodesicGraph& graph, const std::vector<Index>& from, std::vector<Index> to)
{
  std::sort(to.begin(), to.end());
  double least = std::numeric_limits<double>::infinity();
  do
  {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      sum += graph.distances(from[i], { to[i] }).front();
    }
    least = std::min(least, sum);
  } while (std::next_permutation(to.begin(), to.end()));
  return least;
}

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
      singularityDistance(mesh, before, after).work, 12.0 * std::abs(index), 2 * kWayRounding);
    EXPECT_NEAR(
      singularityDistance(mesh, after, before).work, 12.0 * std::abs(index), 2 * kWayRounding);
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
  EXPECT_NEAR(singularityDistance(mesh, before, after).work, 5, kWayRounding);
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

TEST(SingularityDistance, AlongAGreatCircleIsItsLength)
{
  const Mesh mesh = sphere(4);
  const double radius = mesh.position[0].norm();
  const Index from = nearest(mesh, { radius, 0, 0 });
  for (const double angle : { 0.3, 1.0, 2.0, 3.0 })
  {
    const Index to = nearest(
      mesh, radius * Vector3(std::cos(angle), std::sin(angle) * 0.8, std::sin(angle) * 0.6));
    const double arc =
      radius * std::acos(mesh.position[from].dot(mesh.position[to]) / (radius * radius));
    std::vector<int> before = regularTurns(mesh);
    std::vector<int> after = before;
    before[from] = 3;
    after[to] = 3;
    const SingularityDistance d = singularityDistance(mesh, before, after);
    EXPECT_GE(d.work, arc * 0.999); // the polyhedron lies inside the sphere
    EXPECT_LE(d.work, arc * kWayDetour);
    ASSERT_EQ(d.moves.size(), 1U);
    EXPECT_EQ(d.moves[0].from, from);
    EXPECT_EQ(d.moves[0].to, to);
    EXPECT_EQ(d.moves[0].turns, 1);
  }
}

TEST(SingularityDistance, AlongTheOuterEquatorOfATorusIsItsLength)
{
  const Mesh mesh = torus(60, 30);
  const double equator = 1.4; // the torus has radii 1 and 0.4; its outer equator is a geodesic
  for (const double angle : { 0.2, 0.5, 0.9 })
  {
    const Index from = nearest(mesh, { equator, 0, 0 });
    const Index to = nearest(mesh, { equator * std::cos(angle), equator * std::sin(angle), 0 });
    const Vector3 a = mesh.position[from];
    const Vector3 b = mesh.position[to];
    const double arc = equator * std::abs(std::atan2(a.cross(b).z(), a.dot(b)));
    std::vector<int> before = regularTurns(mesh);
    std::vector<int> after = before;
    before[from] = 5;
    after[to] = 5;
    const double work = singularityDistance(mesh, before, after).work;
    EXPECT_GE(work, arc * 0.995); // 60 chords round
    EXPECT_LE(work, arc * kWayDetour);
  }
}

TEST(SingularityDistance, IsTheLeastOfAllMatchingsAndSymmetric)
{
  const Mesh mesh = sphere(3);
  const GeodesicGraph graph(mesh);
  std::mt19937 random(5);
  for (int round = 0; round < 5; ++round)
  {
    std::vector<Index> order(mesh.vertexCount());
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      order[v] = v;
    }
    std::shuffle(order.begin(), order.end(), random);
    // Two 3 and a 2 become 3, 3, 3 and 3; a 5 and a 3 that are near to each other go.
    std::vector<int> before = regularTurns(mesh);
    std::vector<int> after = before;
    before[order[0]] = before[order[1]] = 3;
    before[order[2]] = 2;
    before[order[3]] = 5;
    before[order[4]] = 3;
    for (int k = 5; k < 9; ++k)
    {
      after[order[k]] = 3;
    }
    // Of a signed measure the 5 is a place that a 3 may go to, too.
    const std::vector<Index> from{ order[0], order[1], order[2], order[2], order[4] };
    const std::vector<Index> to{ order[3], order[5], order[6], order[7], order[8] };
    const SingularityDistance d = singularityDistance(mesh, before, after);
    EXPECT_NEAR(d.work, leastMatching(graph, from, to), 1e-4);
    EXPECT_NEAR(d.work, singularityDistance(mesh, after, before).work, 1e-4);
    EXPECT_EQ(d.unmatched, 0);
    EXPECT_EQ(d.work, singularityDistance(mesh, before, after, 3).work);
  }
}

TEST(SingularityDistance, APermutationOfTheSameSingularitiesIsNone)
{
  const Mesh mesh = sphere(2);
  std::vector<int> turns = regularTurns(mesh);
  for (const Index v : { 3, 17, 40, 99 })
  {
    turns[v] = 3;
  }
  const SingularityDistance d = singularityDistance(mesh, turns, turns);
  EXPECT_EQ(d.work, 0);
  EXPECT_TRUE(d.moves.empty());
}

TEST(SingularityDistance, KeepsToComponents)
{
  const Mesh mesh = disjointUnion(gridPlane(6, 6), gridPlane(6, 6), Vector3(7, 0, 0));
  std::vector<int> before = regularTurns(mesh);
  std::vector<int> after = before;
  before[nearest(mesh, { 3, 3, 0 })] = 3;
  after[nearest(mesh, { 10, 3, 0 })] = 3;
  const SingularityDistance d = singularityDistance(mesh, before, after);
  EXPECT_EQ(d.work, 0);
  EXPECT_EQ(d.unmatched, 2); // one that has nowhere to go, one that comes from nowhere
}
