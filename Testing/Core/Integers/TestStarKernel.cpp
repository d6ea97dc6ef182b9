// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StarKernel.h"

#include "GridMap/MapCheck.h"
#include "SyntheticMaps.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::test
{
namespace
{

void move(UvMesh& mesh, Index v, FixedVec2 by)
{
  int turns = 0;
  for (const Index h : mesh.star(v))
  {
    mesh.uv[h] = mesh.uv[h] + rotate(by, -turns);
    turns -= mesh.rotation[Mesh::previous(h)];
  }
}

void expectThatEdgesAgree(const UvMesh& mesh)
{
  for (Index h = 0; h < mesh.origin.size(); ++h)
  {
    if (mesh.twin[h] != kInvalidIndex)
    {
      EXPECT_EQ(mesh.vector(mesh.twin[h]), -rotate(mesh.vector(h), mesh.rotation[h])) << h;
    }
  }
}

/// The vertex leaves its star, and comes back into it from `corner`.
void expectReturn(const SyntheticMap& map, UvMesh& mesh, Index v, FixedVec2 by, Index corner)
{
  ASSERT_TRUE(findNotPositive(map.mesh, mesh.uv).empty());
  move(mesh, v, by);
  ASSERT_FALSE(findNotPositive(map.mesh, mesh.uv).empty());
  EXPECT_TRUE(moveIntoKernel(mesh, corner));
  EXPECT_TRUE(findNotPositive(map.mesh, mesh.uv).empty());
  expectThatEdgesAgree(mesh);
}

/// A vertex with so many fixed edges that leave it, straight through.
Index vertexWith(const UvMesh& mesh, bool onBoundary, std::size_t fixedEdges)
{
  for (Index v = 0; v < mesh.outgoing.size(); ++v)
  {
    const std::vector<Index> star = mesh.star(v);
    const bool boundary = mesh.twin[star.front()] == kInvalidIndex;
    const auto fixed = static_cast<std::size_t>(
      std::count_if(star.begin(), star.end(), [&](Index h) { return mesh.isFixed(h); }));
    // A corner of a boundary has one or two triangles.
    if (boundary == onBoundary && fixed == fixedEdges && star.size() > 2)
    {
      return v;
    }
  }
  return kInvalidIndex;
}

SyntheticMap plate()
{
  return plateMap(gridPlane(4, 4), 1, 4, 5, 1);
}

UvMesh meshOf(const SyntheticMap& map)
{
  return UvMesh::from(map.mesh, map.field, map.uv);
}

TEST(StarKernel, BringsAVertexBackIntoItsStar)
{
  const SyntheticMap map = plate();
  UvMesh mesh = meshOf(map);
  const Index v = vertexWith(mesh, false, 0);
  ASSERT_NE(v, kInvalidIndex);
  expectReturn(map, mesh, v, { 9 * kOne, 2 * kOne }, mesh.outgoing[v]);
}

TEST(StarKernel, KeepsAVertexOfTheBoundaryOnIt)
{
  const SyntheticMap map = plate();
  UvMesh mesh = meshOf(map);
  const Index v = vertexWith(mesh, true, 1);
  ASSERT_NE(v, kInvalidIndex);
  const Index h = mesh.outgoing[v];
  const FixedVec2 along = mesh.vector(h);
  ASSERT_TRUE(along.u == 0 || along.v == 0);
  const FixedVec2 before = mesh.uv[h];
  expectReturn(map, mesh, v, along + along, mesh.star(v).back()); // any of its corners will do
  EXPECT_EQ(along.u == 0 ? mesh.uv[h].u : mesh.uv[h].v, along.u == 0 ? before.u : before.v);
}

TEST(StarKernel, KeepsAVertexOfAFeatureOnIt)
{
  const SyntheticMap map = axisAlignedMap(markFeatures(unitCube(5), 0.7), 1, 5, 6, 1);
  UvMesh mesh = meshOf(map);
  const Index v = vertexWith(mesh, false, 2);
  ASSERT_NE(v, kInvalidIndex);
  const std::vector<Index> star = mesh.star(v);
  const auto fixed =
    std::find_if(star.begin(), star.end(), [&](Index h) { return mesh.isFixed(h); });
  int turns = 0; // to the chart of the first face of the star
  for (auto h = star.begin(); h != fixed; ++h)
  {
    turns -= mesh.rotation[Mesh::previous(*h)];
  }
  const FixedVec2 along = rotate(mesh.vector(*fixed), turns);
  const FixedVec2 before = mesh.uv[star.front()];
  expectReturn(map, mesh, v, along + along, star.front());
  const FixedVec2 after = mesh.uv[star.front()];
  EXPECT_EQ(along.u == 0 ? after.u : after.v, along.u == 0 ? before.u : before.v);
}

TEST(StarKernel, LeavesAVertexWithoutKernelWhereItIs)
{
  const SyntheticMap map = plate();
  UvMesh mesh = meshOf(map);
  const Index v = vertexWith(mesh, false, 0);
  ASSERT_NE(v, kInvalidIndex);
  // A neighbour goes to the other side: an edge of the ring has the whole star on its wrong side.
  const Index h = mesh.outgoing[v];
  const FixedVec2 across = mesh.vector(h);
  move(mesh, mesh.target(h), { -8 * across.u, -8 * across.v });
  const std::vector<FixedVec2> before = mesh.uv;
  EXPECT_FALSE(moveIntoKernel(mesh, h));
  EXPECT_TRUE(mesh.uv == before);
}

} // namespace
} // namespace quadrille::test
