// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "../TestMeshes.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Evaluation/GeodesicGraph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Lengths of arcs are single precision.
constexpr double kArcRounding = 1e-6;
/// What GeodesicGraph promises: on a grid, on an uneven one and on an even sampling.
constexpr double kGridDetour = 1.014;
constexpr double kUnevenGridDetour = 1.025;
constexpr double kSphereDetour = 1.01;

std::vector<Index> allVertices(const Mesh& mesh)
{
  std::vector<Index> all(mesh.vertexCount());
  std::iota(all.begin(), all.end(), Index{ 0 });
  return all;
}

} // namespace

TEST(GeodesicGraph, IsStraightInThePlane)
{
  Mesh mesh = gridPlane(24, 18);
  for (const bool uneven : { false, true })
  {
    if (uneven)
    {
      std::mt19937 random(4);
      std::uniform_real_distribution<double> jitter(-0.2, 0.2);
      for (Vector3& p : mesh.position.editAll())
      {
        const bool onSide = p.x() == 0 || p.x() == 24 || p.y() == 0 || p.y() == 18;
        p += onSide ? Vector3(0, 0, 0) : Vector3(jitter(random), jitter(random), 0);
      }
    }
    const GeodesicGraph graph(mesh);
    for (const Index source : { Index{ 0 }, mesh.vertexCount() / 2 })
    {
      const std::vector<double> d = graph.distances(source, allVertices(mesh));
      for (Index v = 0; v < mesh.vertexCount(); ++v)
      {
        const double straight = (mesh.position[v] - mesh.position[source]).norm();
        EXPECT_GE(d[v], straight * (1 - kArcRounding));
        EXPECT_LE(d[v], straight * (uneven ? kUnevenGridDetour : kGridDetour) + kArcRounding);
      }
    }
  }
}

TEST(GeodesicGraph, FollowsGreatCircles)
{
  const Mesh mesh = sphere(4);
  const GeodesicGraph graph(mesh);
  const std::vector<double> d = graph.distances(0, allVertices(mesh));
  const double radius = mesh.position[0].norm();
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const double cosine = mesh.position[0].dot(mesh.position[v]) / (radius * radius);
    const double arc = radius * std::acos(std::clamp(cosine, -1.0, 1.0));
    // The polyhedron is smaller than the sphere: at level 4 its edges are 0.9995 of their arcs or more.
    EXPECT_GE(d[v], arc * 0.999);
    EXPECT_LE(d[v], arc * kSphereDetour + kArcRounding);
  }
}

TEST(GeodesicGraph, GoesRoundTheBendOfAnLAndStaysOnItsComponent)
{
  // Round an inner corner the way is two straight lines that meet there.
  const Mesh plate = planeCells(8, 8, [](int x, int y) { return x < 4 || y < 4; });
  const auto at = [&](double x, double y)
  {
    Index v = 0;
    while (plate.position[v] != Vector3(x, y, 0))
    {
      ++v;
    }
    return v;
  };
  const GeodesicGraph graph(plate);
  const double way = graph.distances(at(1, 8), { at(8, 1) }).front();
  EXPECT_GE(way, 2 * std::hypot(3, 4) * (1 - kArcRounding));
  EXPECT_LE(way, 2 * std::hypot(3, 4) * kGridDetour);

  const Mesh two = disjointUnion(gridPlane(2, 2), gridPlane(2, 2), Vector3(5, 0, 0));
  EXPECT_TRUE(std::isinf(GeodesicGraph(two).distances(0, { two.vertexCount() - 1 }).front()));
}

TEST(GeodesicGraph, IsTheSameBothWays)
{
  const Mesh mesh = torus(20, 12);
  const GeodesicGraph graph(mesh);
  for (const Index v : { Index{ 7 }, Index{ 100 }, Index{ 211 } })
  {
    EXPECT_NEAR(
      graph.distances(3, { v }).front(), graph.distances(v, { Index{ 3 } }).front(), 1e-5);
  }
}

TEST(GeodesicGraph, RefusesVerticesThatAreNotThere)
{
  const Mesh mesh = gridPlane(2, 2);
  const GeodesicGraph graph(mesh);
  EXPECT_THROW(graph.distances(100, { 0 }), InvalidInput);
  EXPECT_THROW(graph.distances(0, { 100 }), InvalidInput);
}
