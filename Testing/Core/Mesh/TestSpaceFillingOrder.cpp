// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "SurfaceInputs.h"

#include <algorithm>
#include <cstdlib>
#include <map>
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
    input.points.edit()[shuffled[i]] = points[i];
  }
  for (Index& v : input.polygonPoints.editAll())
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

namespace
{

/// The vertices of a face that is left by their places, under the polygon that it comes from.
std::map<Index, std::array<Vector3, 3>> facesByPolygon(const PreparedSurface& surface)
{
  std::map<Index, std::array<Vector3, 3>> faces;
  const Mesh& mesh = surface.mesh;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (mesh.origin[3 * f] != kInvalidIndex)
    {
      faces[surface.sourcePolygon[f]] = { mesh.position[mesh.origin[3 * f]],
        mesh.position[mesh.origin[3 * f + 1]], mesh.position[mesh.origin[3 * f + 2]] };
    }
  }
  return faces;
}

} // namespace

TEST(SpaceFillingOrder, SurfacesThatLostFacesKeepTheOthers)
{
  std::mt19937 random(11);
  for (const std::size_t count : { 0U, 1U, 40U, 900U })
  {
    PreparedSurface surface = test::prepare(test::toInput(test::sphere(4)));
    const Index faces = surface.mesh.faceCount();
    for (std::size_t i = 0; i < count; ++i)
    {
      removeFace(surface, static_cast<Index>(random() % faces));
    }
    Index last = surface.mesh.faceCount() - 1;
    while (surface.mesh.origin[3 * last] == kInvalidIndex)
    {
      --last;
    }
    surface.valenceRequests.push_back({ surface.mesh.origin[3 * last], 5, 0 });
    const Vector3 asked = surface.mesh.position[surface.mesh.origin[3 * last]];
    surface.vertexBefore.resize(surface.mesh.vertexCount());
    std::iota(surface.vertexBefore.begin(), surface.vertexBefore.end(), Index{ 0 });
    const std::map<Index, std::array<Vector3, 3>> before = facesByPolygon(surface);
    const std::vector<Vector3> places = surface.mesh.position;
    orderSurface(surface, 2);

    const Mesh& mesh = surface.mesh;
    ASSERT_EQ(mesh.faceCount(), before.size());
    EXPECT_EQ(facesByPolygon(surface), before);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Index g = mesh.twin[h];
      if (g != kInvalidIndex)
      {
        ASSERT_EQ(mesh.twin[g], h);
        ASSERT_EQ(mesh.origin[g], mesh.target(h));
        ASSERT_EQ(mesh.target(g), mesh.origin[h]);
      }
    }
    EXPECT_EQ(mesh.position[surface.valenceRequests.front().vertex], asked);
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      ASSERT_EQ(places[surface.vertexBefore[v]], mesh.position[v]);
    }
  }
}

} // namespace quadrille
