// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/CarriedPlaces.h"

#include "Base/Error.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// A mesh thinned out, and places on the level: two on each face, and all of its vertices.
struct Thinned
{
  Thinned(Mesh mesh, double edgeLength) : fine(std::move(mesh))
  {
    HierarchyOptions options;
    options.targetEdgeLength = 2 * edgeLength;
    options.threads = 1;
    made = Redecimation(fine, 1, options).take();
    const Mesh& level = made.intermediate.mesh;
    for (Index f = 0; f < level.faceCount(); ++f)
    {
      places.push_back({ f, { 0.2, 0.3, 0.5 } });
      places.push_back({ f, { 0.9, 0.06, 0.04 } });
      places.push_back(
        { f, { f % 3 == 0 ? 1.0 : 0.0, f % 3 == 1 ? 1.0 : 0.0, f % 3 == 2 ? 1.0 : 0.0 } });
    }
  }

  std::vector<SurfacePoint> carry(int threads) const
  {
    return carryPlaces(made.intermediate, made.log, made.log.rounds.size(), places, threads, {});
  }

  static Vector3 placeOn(const Mesh& mesh, const SurfacePoint& at)
  {
    Vector3 place = Vector3::Zero();
    for (Index k = 0; k < 3; ++k)
    {
      place += at.weights[k] * mesh.position[mesh.origin[3 * at.face + k]];
    }
    return place;
  }

  Mesh fine;
  Hierarchy made;
  std::vector<SurfacePoint> places;
};

void expectWeights(const std::vector<SurfacePoint>& carried, const Mesh& fine)
{
  for (const SurfacePoint& place : carried)
  {
    ASSERT_LT(place.face, fine.faceCount());
    EXPECT_GE(*std::min_element(place.weights.begin(), place.weights.end()), 0);
    EXPECT_NEAR(place.weights[0] + place.weights[1] + place.weights[2], 1, 1e-12);
  }
}

/// In a plane every star lies where it is laid out, so points stay where they are.
TEST(CarriedPlaces, PointsOfAPlaneStay)
{
  Thinned thinned(gridPlane(60, 60), 4);
  ASSERT_LT(2 * thinned.made.intermediate.mesh.faceCount(), thinned.fine.faceCount());
  const std::vector<SurfacePoint> carried = thinned.carry(1);
  expectWeights(carried, thinned.fine);
  for (std::size_t i = 0; i < carried.size(); ++i)
  {
    const Vector3 before = Thinned::placeOn(thinned.made.intermediate.mesh, thinned.places[i]);
    // Removals are planned in single precision: weights of a vertex in its ring have seven digits.
    EXPECT_LT((Thinned::placeOn(thinned.fine, carried[i]) - before).norm(), 1e-5);
  }
}

TEST(CarriedPlaces, VerticesOfTheLevelAreThoseOfTheSurface)
{
  Thinned thinned(torus(120, 60, 2, 1), 0.3);
  const std::vector<SurfacePoint> carried = thinned.carry(1);
  expectWeights(carried, thinned.fine);
  const Mesh& level = thinned.made.intermediate.mesh;
  for (std::size_t i = 2; i < carried.size(); i += 3)
  {
    const Index f = thinned.places[i].face;
    EXPECT_EQ(
      Thinned::placeOn(thinned.fine, carried[i]), level.position[level.origin[3 * f + f % 3]]);
  }
}

TEST(CarriedPlaces, TheSameForAnyNumberOfThreads)
{
  Thinned thinned(torus(300, 150, 2, 1), 0.1);
  const std::vector<SurfacePoint> one = thinned.carry(1);
  const std::vector<SurfacePoint> four = thinned.carry(4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i)
  {
    EXPECT_EQ(one[i].face, four[i].face);
    EXPECT_EQ(one[i].weights, four[i].weights);
  }
}

TEST(CarriedPlaces, RefusesAnotherLevel)
{
  Thinned thinned(gridPlane(20, 20), 4);
  thinned.places[0].face = thinned.made.intermediate.mesh.faceCount();
  EXPECT_THROW(thinned.carry(1), InvalidInput);
  thinned.places[0].face = 0;
  thinned.made.intermediate.fineFace[0] = thinned.fine.faceCount();
  EXPECT_THROW(thinned.carry(1), InvalidInput);
}

} // namespace
} // namespace quadrille
