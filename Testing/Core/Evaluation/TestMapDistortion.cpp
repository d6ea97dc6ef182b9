// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "../TestMeshes.h"

#include "Base/Error.h"
#include "Evaluation/MapQuality.h"

#include <gtest/gtest.h>

using namespace quadrille;

namespace
{

std::vector<FixedVec2> stretched(const Mesh& mesh, double u, double v)
{
  std::vector<FixedVec2> uv;
  for (const Index p : mesh.origin)
  {
    uv.push_back(toFixed(Vector2(u * mesh.position[p].x(), v * mesh.position[p].y())));
  }
  return uv;
}

} // namespace

TEST(MapDistortion, IsOneForScaledIsometries)
{
  const Mesh mesh = test::gridPlane(4, 3);
  for (const double scale : { 1.0, 0.25, 8.0 })
  {
    const MapDistortion d = measureDistortion(mesh, stretched(mesh, scale, scale));
    for (const double value : { d.mean, d.median, d.p90, d.p99, d.angle })
    {
      EXPECT_NEAR(value, 1, 1e-12);
    }
    EXPECT_NEAR(d.size, 0, 1e-12);
    EXPECT_EQ(d.left, 0U);
  }
}

TEST(MapDistortion, OfAStretchIsWhatTheFormulaSays)
{
  const Mesh mesh = test::gridPlane(4, 4);
  // Singular values 2 and 1/2 after scaling: (4 + 1/4 + 1/4 + 4) / 4, (4 + 1/4) / 2, the same area.
  const MapDistortion d = measureDistortion(mesh, stretched(mesh, 4, 1));
  EXPECT_NEAR(d.mean, 2.125, 1e-12);
  EXPECT_NEAR(d.p99, 2.125, 1e-12);
  EXPECT_NEAR(d.angle, 2.125, 1e-12);
  EXPECT_NEAR(d.size, 0, 1e-12);
}

TEST(MapDistortion, LeavesOutWhatIsNotPositive)
{
  const Mesh mesh = test::gridPlane(2, 2);
  std::vector<FixedVec2> uv = stretched(mesh, 1, 1);
  std::swap(uv[0], uv[1]);
  const MapDistortion d = measureDistortion(mesh, uv);
  EXPECT_EQ(d.left, 1U);
  EXPECT_TRUE(std::isfinite(d.mean));
  uv.pop_back();
  EXPECT_THROW(measureDistortion(mesh, uv), InvalidInput);
}
