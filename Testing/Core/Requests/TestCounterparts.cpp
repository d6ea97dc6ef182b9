// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/Counterparts.h"

#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

using namespace test;

/// A square of side 20 with its boundary.
PreparedSurface plane()
{
  return prepareSurface(toInput(gridPlane(20, 20)), {});
}

Index vertexAt(const Mesh& mesh, const Vector3& place)
{
  const auto at = std::find(mesh.position.begin(), mesh.position.end(), place);
  return static_cast<Index>(at - mesh.position.begin());
}

TEST(Counterparts, AreTheOtherCornersOfASquare)
{
  const PreparedSurface surface = plane();
  const Vector3 place(10, 10, 0);
  const std::vector<ValenceRequest> square =
    counterparts(surface, { vertexAt(surface.mesh, place), 3 }, 4);
  ASSERT_EQ(square.size(), 3U);
  EXPECT_EQ(square[0].valence, 5);
  EXPECT_EQ(square[1].valence, 3);
  EXPECT_EQ(square[2].valence, 5);
  const auto away = [&](std::size_t i)
  { return (surface.mesh.position[square[i].vertex] - place).norm(); };
  EXPECT_NEAR(away(0), 4, 1);
  EXPECT_NEAR(away(1), 4 * std::sqrt(2.0), 1);
  EXPECT_NEAR(away(2), 4, 1);
  for (const ValenceRequest& request : square)
  {
    EXPECT_TRUE(request.mayDrift);
  }
}

TEST(Counterparts, KeepAwayFromWhatBoundsTheFace)
{
  const PreparedSurface surface = plane();
  const std::vector<ValenceRequest> square =
    counterparts(surface, { vertexAt(surface.mesh, { 2, 10, 0 }), 5 }, 4);
  ASSERT_EQ(square.size(), 3U);
  for (const ValenceRequest& request : square)
  {
    EXPECT_GE(surface.mesh.position[request.vertex].x(), 2);
  }
}

TEST(Counterparts, AreNoneWhereThereIsNoRoom)
{
  const PreparedSurface surface = plane();
  EXPECT_TRUE(counterparts(surface, { vertexAt(surface.mesh, { 0, 10, 0 }), 3 }, 4).empty());
  EXPECT_TRUE(counterparts(surface, { vertexAt(surface.mesh, { 1, 1, 0 }), 3 }, 40).empty());
}

} // namespace

} // namespace quadrille
