// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The library through its public header alone.
#include <quadrille/quadrille.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

using namespace quadrille;

namespace
{

/// The square [0, 1] x [0, 1] of n x n squares, each cut in two.
TriangleMesh square(std::uint32_t n)
{
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
  {
    for (std::uint32_t i = 0; i <= n; ++i)
    {
      mesh.points.push_back({ double(i) / n, double(j) / n, 0 });
    }
  }
  for (std::uint32_t j = 0; j < n; ++j)
  {
    for (std::uint32_t i = 0; i < n; ++i)
    {
      const PointId a = j * (n + 1) + i;
      mesh.triangles.push_back({ a, a + 1, a + n + 2 });
      mesh.triangles.push_back({ a, a + n + 2, a + n + 1 });
    }
  }
  return mesh;
}

double area(const QuadResult& result)
{
  double sum = 0;
  for (const auto& q : result.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const auto& a = result.points[q[i]];
      const auto& b = result.points[q[(i + 1) % 4]];
      sum += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
  }
  return sum;
}

QuadOptions quadsOf(std::size_t count)
{
  QuadOptions options;
  options.quads = count;
  return options;
}

} // namespace

TEST(MakeQuads, CoverTheSquareCounterclockwise)
{
  const QuadResult result = makeQuads(square(20), quadsOf(100));
  // Points of the boundary stay on it, so that the quads have the area of the square; its sign is their orientation.
  EXPECT_NEAR(area(result), 1, 1e-12);
  EXPECT_GT(result.quads.size(), 50U);
  EXPECT_LT(result.quads.size(), 200U);
  EXPECT_NEAR(result.edgeLength, 0.1, 1e-12); // of 100 quads of the area 1
  EXPECT_TRUE(result.stopped.empty());
}

TEST(MakeQuads, PlacesAreThePoints)
{
  const TriangleMesh mesh = square(20);
  const QuadResult result = makeQuads(mesh, quadsOf(100));
  ASSERT_EQ(result.pointPlaces.size(), result.points.size());
  for (std::size_t p = 0; p < result.points.size(); ++p)
  {
    const SurfacePlace& place = result.pointPlaces[p];
    ASSERT_LT(place.triangle, mesh.triangles.size());
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto& corners = mesh.triangles[place.triangle];
      EXPECT_NE(std::find(corners.begin(), corners.end(), place.points[i]), corners.end());
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        sum[axis] += place.weights[i] * mesh.points[place.points[i]][axis];
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(sum[axis], result.points[p][axis], 1e-12);
    }
  }
}

TEST(MakeQuads, PatchesAndFeatureEdgesBecomeEdges)
{
  TriangleMesh byPatch = square(20);
  TriangleMesh byEdge = byPatch;
  byEdge.featureEdges.assign(byEdge.triangles.size(), 0);
  for (std::size_t t = 0; t < byPatch.triangles.size(); ++t)
  {
    const auto& corners = byPatch.triangles[t];
    double x = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      x += byPatch.points[corners[i]][0] / 3;
      const double a = byEdge.points[corners[i]][0], b = byEdge.points[corners[(i + 1) % 3]][0];
      byEdge.featureEdges[t] |=
        (std::abs(a - 0.35) < 1e-9 && std::abs(b - 0.35) < 1e-9) ? 1 << i : 0;
    }
    byPatch.patchIds.push_back(x < 0.35 ? 7 : -2);
  }
  for (const TriangleMesh& mesh : { byPatch, byEdge })
  {
    const QuadResult result = makeQuads(mesh, quadsOf(100));
    double length = 0;
    for (const auto& edge : result.featureEdges)
    {
      EXPECT_NEAR(result.points[edge[0]][0], 0.35, 1e-12);
      EXPECT_NEAR(result.points[edge[1]][0], 0.35, 1e-12);
      length += std::abs(result.points[edge[0]][1] - result.points[edge[1]][1]);
    }
    EXPECT_NEAR(length, 1, 1e-12); // the whole line
  }
}

TEST(MakeQuads, ThreadsDoNotChangeTheResult)
{
  QuadOptions options = quadsOf(300);
  options.threads = 1;
  const QuadResult one = makeQuads(square(40), options);
  options.threads = 3;
  const QuadResult three = makeQuads(square(40), options);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.quads, three.quads);
}

TEST(MakeQuads, WhatIsWrongIsNamed)
{
  const auto reasonOf = [](const TriangleMesh& mesh, const QuadOptions& options)
  {
    try
    {
      makeQuads(mesh, options);
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string("no InputError");
  };
  TriangleMesh mesh = square(4);
  mesh.triangles[5][1] = 1000;
  EXPECT_NE(reasonOf(mesh, quadsOf(10)).find("5"), std::string::npos)
    << reasonOf(mesh, quadsOf(10));
  mesh = square(4);
  mesh.patchIds = { 1, 2 };
  EXPECT_EQ(reasonOf(mesh, quadsOf(10)),
    "patchIds has 2 values, but there are 32 triangles: it has to have one each, or none");
  QuadOptions both = quadsOf(10);
  both.edgeLength = 1;
  EXPECT_NE(reasonOf(square(4), both).find("only one of"), std::string::npos);
  QuadOptions angle = quadsOf(10);
  angle.featureAngle = 0;
  EXPECT_NE(reasonOf(square(4), angle).find("featureAngle"), std::string::npos);
  EXPECT_NE(reasonOf(TriangleMesh(), quadsOf(10)), "no InputError");
}

TEST(MakeQuads, StopsAndRefuses)
{
  QuadOptions options = quadsOf(100);
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(makeQuads(square(20), options), StoppedError);
  options = quadsOf(100);
  options.maximumQuads = 10;
  EXPECT_THROW(makeQuads(square(20), options), QuadError);
}

TEST(MakeQuads, ProgressGoesToItsEnd)
{
  double last = -1;
  QuadOptions options = quadsOf(100);
  options.progress = [&last](double fraction, const std::string&)
  {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return true;
  };
  makeQuads(square(20), options);
  EXPECT_GT(last, 0.9);
}

TEST(MakeQuads, VersionIsThatOfTheProject)
{
  EXPECT_STREQ(libraryVersion(), QUADRILLE_VERSION);
}
