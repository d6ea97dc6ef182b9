// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SpaceFillingOrder.h"
#include "SurfaceInputs.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

namespace quadrille
{

using namespace test;

TEST(SpaceFillingOrder, HilbertCurveVisitsEveryCellAndStepsToANeighbour)
{
  constexpr int kBits = 3;
  constexpr std::uint32_t kSize = 1u << kBits;
  std::vector<std::array<std::uint32_t, 3>> cellOf(kSize * kSize * kSize, { kSize, 0, 0 });
  for (std::uint32_t x = 0; x < kSize; ++x)
  {
    for (std::uint32_t y = 0; y < kSize; ++y)
    {
      for (std::uint32_t z = 0; z < kSize; ++z)
      {
        const std::uint64_t key = hilbertKey({ x, y, z }, kBits);
        ASSERT_LT(key, cellOf.size());
        EXPECT_EQ(cellOf[key][0], kSize) << "two cells with key " << key;
        cellOf[key] = { x, y, z };
      }
    }
  }
  for (std::size_t i = 1; i < cellOf.size(); ++i)
  {
    int steps = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      steps += std::abs(static_cast<int>(cellOf[i][k]) - static_cast<int>(cellOf[i - 1][k]));
    }
    EXPECT_EQ(steps, 1);
  }
}

TEST(SpaceFillingOrder, IsAPermutationAndKeepsTheOrderOfEqualPoints)
{
  std::vector<Vector3> points(1000, Vector3(1, 2, 3));
  std::vector<Index> order = spaceFillingOrder(points, 2);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  points = sphere(4).position;
  order = spaceFillingOrder(points, 2);
  EXPECT_EQ(order, spaceFillingOrder(points, 1));
  EXPECT_EQ(std::set<Index>(order.begin(), order.end()).size(), points.size());
  EXPECT_TRUE(spaceFillingOrder({}, 1).empty());
}

TEST(SpaceFillingOrder, IsTheOrderOfTheKeys)
{
  // One in ten points is far away, so that the others fill few buckets with many items each, more than are sorted
  // by comparing, and many points share a cell.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Vector3> points{ Vector3(0, 0, 0), Vector3(1, 1, 1) };
  for (int i = 0; i < 20000; ++i)
  {
    const double size = i % 10 == 0 ? 1 : 0.01;
    points.emplace_back(
      size * coordinate(random), size * coordinate(random), size * coordinate(random));
  }
  std::vector<std::uint64_t> key;
  for (const Vector3& p : points)
  {
    const auto cell = [](double x) { return static_cast<std::uint32_t>(x * 2047); };
    key.push_back(hilbertKey({ cell(p.x()), cell(p.y()), cell(p.z()) }, 11));
  }
  std::vector<Index> expected(points.size());
  std::iota(expected.begin(), expected.end(), Index{ 0 });
  std::stable_sort(
    expected.begin(), expected.end(), [&](Index a, Index b) { return key[a] < key[b]; });
  for (const int threads : { 1, 2, 4, 8 })
  {
    EXPECT_EQ(spaceFillingOrder(points, threads), expected);
  }
}

TEST(SpaceFillingOrder, NeighboursInStorageAreNeighboursInSpace)
{
  // On a surface, a curve that fills space jumps far only now and then: the mean step stays within a
  // few edge lengths, where shuffled vertices would be a radius apart.
  SurfaceInput input = toInput(sphere(5));
  std::vector<Index> shuffled(input.points.size());
  std::iota(shuffled.begin(), shuffled.end(), 0u);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  const std::vector<Vector3> points = input.points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    input.points[shuffled[i]] = points[i];
  }
  for (Index& v : input.polygonPoints)
  {
    v = shuffled[v];
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  double steps = 0;
  for (Index v = 1; v < surface.mesh.vertexCount(); ++v)
  {
    steps += (surface.mesh.position[v] - surface.mesh.position[v - 1]).norm();
  }
  const double edge = surface.mesh.edgeVector(0).norm();
  EXPECT_LT(steps / surface.mesh.vertexCount(), 3 * edge);
  Index previous = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    const Index* v = surface.mesh.origin.data() + 3 * f;
    const Index lowest = std::min({ v[0], v[1], v[2] });
    EXPECT_GE(lowest, previous);
    previous = lowest;
  }
}

} // namespace quadrille
