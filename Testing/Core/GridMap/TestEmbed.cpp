// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "GridMap/Certificate.h"
#include "GridMap/Embed.h"
#include "GridMap/MapCheck.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <set>

using namespace quadrille;

namespace
{

/// The map of a surface of axis-parallel squares whose edges have length `cell`: every face is developed along
/// its field, one unit a cell, so all vertices are whole points.
struct BlockMap
{
  Mesh mesh;
  double cell;
  CrossField field;
  std::vector<FixedVec2> uv;

  BlockMap(Mesh m, double cellLength) : mesh(std::move(m)), cell(cellLength)
  {
    CrossFieldOptions options;
    options.targetEdgeLength = cell;
    field = computeCrossField(mesh, options);
    develop(mesh.position);
  }

  /// uv from other positions that lie in the same planes.
  void develop(const std::vector<Vector3>& position)
  {
    uv.clear();
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Index f = Mesh::face(h);
      const Vector3 normal = test::faceNormal(mesh, f);
      const Vector3 first = mesh.edgeVector(3 * f).normalized();
      const Vector3 d =
        std::cos(field.angle[f]) * first + std::sin(field.angle[f]) * normal.cross(first);
      const Vector3 p = position[mesh.origin[h]] / cell;
      // The angle of the field carries its rounding error; what is on a whole line stays on it.
      uv.push_back({ snapped(p.dot(d)), snapped(p.dot(normal.cross(d))) });
    }
  }

  static std::int64_t snapped(double x)
  {
    return static_cast<std::int64_t>(std::llround(x * 1024)) * (kOne / 1024);
  }

  /// Moves every vertex that no constrained edge touches by up to `cells` in the plane of its faces.
  void scramble(double cells, int seed)
  {
    std::vector<bool> free(mesh.vertexCount(), true);
    std::vector<Vector3> normal(mesh.vertexCount());
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      normal[mesh.origin[h]] = test::faceNormal(mesh, Mesh::face(h));
      if (mesh.isConstrained(h))
      {
        free[mesh.origin[h]] = free[mesh.target(h)] = false;
      }
    }
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-cells, cells);
    std::vector<Vector3> moved = mesh.position;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      const Vector3 by(uniform(random), uniform(random), uniform(random));
      if (free[v])
      {
        moved[v] += cell * (by - by.dot(normal[v]) * normal[v]);
      }
    }
    develop(moved);
  }

  Certificate check(const std::vector<FixedVec2>& map) const
  {
    return certify(mesh, map, field.turns, integerVertices(mesh, field));
  }
  EmbedResult embed() const
  {
    EmbedOptions options;
    options.edgeLength = cell;
    return embedMap(mesh, field, uv, options);
  }
};

BlockMap sharpCube(int n)
{
  return BlockMap(test::markFeatures(test::unitCube(n), 0.7), 1.0 / n);
}

} // namespace

TEST(Embed, KeepsAMapThatIsAlreadyBest)
{
  const BlockMap cube = sharpCube(5);
  ASSERT_TRUE(cube.check(cube.uv).valid()) << cube.check(cube.uv).text();
  const EmbedResult result = cube.embed();
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(cube.check(result.uv).valid());
  for (Index h = 0; h < cube.mesh.halfEdgeCount(); ++h)
  {
    // Every J is the unit matrix there; Newton's method stops within rounding and the grid.
    EXPECT_LT((toDouble(result.uv[h]) - toDouble(cube.uv[h])).norm(), 1e-5);
  }
}

TEST(Embed, UntanglesWhatIsFreeAndKeepsTheIntegers)
{
  for (int seed = 0; seed < 5; ++seed)
  {
    BlockMap cube = sharpCube(6);
    cube.scramble(2, seed);
    ASSERT_GT(cube.check(cube.uv).notPositive, 0u);
    ASSERT_EQ(cube.check(cube.uv).seamResiduals, 0u);
    const EmbedResult result = cube.embed();
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    const Certificate c = cube.check(result.uv);
    EXPECT_TRUE(c.valid()) << c.text();
    EXPECT_EQ(c.area, 6 * 36);
    for (Index h = 0; h < cube.mesh.halfEdgeCount(); ++h)
    {
      if (!cube.mesh.isBoundary(h))
      {
        EXPECT_EQ(transitionOf(cube.mesh, result.uv, h), transitionOf(cube.mesh, cube.uv, h));
      }
    }
  }
}

TEST(Embed, FeatureVerticesSlideAlongTheirIsolineOnly)
{
  // Half as many quads as cells: vertices in the middle of an edge lie between whole points.
  BlockMap cube = sharpCube(4);
  cube.cell = 0.5;
  cube.develop(cube.mesh.position);
  ASSERT_TRUE(cube.check(cube.uv).valid()) << cube.check(cube.uv).text();
  const EmbedResult result = cube.embed();
  EXPECT_TRUE(cube.check(result.uv).valid());
}

TEST(Embed, BoundaryVerticesMayNotSlideBeyondACorner)
{
  // Two rows: the vertices of the lower and upper boundary slide, those of the middle are free.
  BlockMap plate(test::gridPlane(5, 2), 1);
  std::vector<Vector3> moved = plate.mesh.position;
  for (Vector3& p : moved)
  {
    if (p.x() > 0 && p.x() < 5 && p.y() != 1)
    {
      p.x() = 2 - p.x(); // 1, 0, -1, -2: in reverse order and over the corner
    }
  }
  plate.develop(moved);
  ASSERT_FALSE(findDefects(plate.mesh, plate.field, plate.uv).reversed.empty());
  const EmbedResult result = plate.embed();
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(plate.check(result.uv).valid());
  EXPECT_TRUE(findDefects(plate.mesh, plate.field, result.uv).none());
}

TEST(Embed, OpenPlates)
{
  BlockMap plate(test::plateWithHole(4), 1);
  plate.scramble(1.5, 7);
  const EmbedResult result = plate.embed();
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(plate.check(result.uv).valid());
}

TEST(Embed, NamesFacesThatTheIntegersLeaveNoArea)
{
  // A plate of one cell: all four corners are locked. Swap the map of two of them.
  BlockMap plate(test::gridPlane(1, 1), 1);
  std::vector<Vector3> flat = plate.mesh.position;
  for (Vector3& p : flat)
  {
    p.x() = 0;
  }
  plate.develop(flat);
  const EmbedResult result = plate.embed();
  EXPECT_EQ(result.status.code, StatusCode::Infeasible);
  EXPECT_EQ(result.inverted.size(), 2u);
  EXPECT_EQ(result.failedAt.size(), 4u);
}

TEST(Embed, RefusesFractionalAndInconsistentMaps)
{
  const BlockMap good = sharpCube(3);
  BlockMap cube = good;
  for (int i = 0; i < 3; ++i)
  {
    cube.uv[i].u += kOne / 2;
    cube.uv[i].v += kOne / 2;
  }
  EXPECT_THROW(cube.embed(), InvalidInput); // fractional transition

  cube = good;
  cube.uv[4].u += 1;
  EXPECT_THROW(cube.embed(), InvalidInput); // the two images of an edge disagree

  cube = good;
  for (FixedVec2& p : cube.uv)
  {
    p = p + FixedVec2{ kOne / 4, kOne / 4 };
  }
  EXPECT_THROW(cube.embed(), InvalidInput); // no edge on a whole isoline any more

  cube = good;
  cube.uv.pop_back();
  EXPECT_THROW(cube.embed(), InvalidInput);
  cube = good;
  cube.cell = 0;
  EXPECT_THROW(cube.embed(), InvalidInput);
}

TEST(Embed, SameBytesEveryTime)
{
  BlockMap cube = sharpCube(5);
  cube.scramble(1, 3);
  EXPECT_EQ(cube.embed().uv, cube.embed().uv);
}
