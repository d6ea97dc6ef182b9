// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/SmallComponents.h"
#include "Prepare/Refine.h"

#include "MeshInput.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

namespace quadrille
{
namespace
{

Mesh scaled(Mesh mesh, double factor)
{
  for (Vector3& p : mesh.position.editAll())
  {
    p *= factor;
  }
  return mesh;
}

/// A sphere with an icosahedron and a square plate beside it, both tiny.
PreparedSurface withIslands()
{
  Mesh mesh = test::disjointUnion(test::sphere(3), scaled(test::sphere(0), 0.05), Vector3(3, 0, 0));
  mesh = test::disjointUnion(mesh, scaled(test::gridPlane(2, 2), 0.02), Vector3(0, 4, 0));
  return test::prepare(test::toInput(mesh));
}

TEST(SmallComponents, BlocksFollowFromTheTopology)
{
  EXPECT_EQ(quadsOfBlock(2, 0), 6);
  EXPECT_EQ(quadsOfBlock(0, 0), 16);
  EXPECT_EQ(quadsOfBlock(-2, 0), 32);
  EXPECT_EQ(quadsOfBlock(1, 1), 4);
  EXPECT_EQ(quadsOfBlock(0, 2), 12);
  EXPECT_EQ(quadsOfBlock(-1, 1), 20);
}

TEST(SmallComponents, AreMeasured)
{
  for (const Mesh& mesh : { test::sphere(2), test::torus(12, 8), test::doubleTorus(2),
         test::gridPlane(3, 4), test::plateWithHole(4), test::openCylinder(8, 3) })
  {
    const TopologySummary topology = summarizeTopology(mesh);
    const ComponentSizes sizes = measureComponents(mesh);
    ASSERT_EQ(sizes.area.size(), 1u);
    EXPECT_NEAR(sizes.area[0], test::area(mesh), 1e-12 * test::area(mesh));
    EXPECT_EQ(sizes.block[0], quadsOfBlock(topology.eulerCharacteristic, topology.boundaryLoops));
  }
}

TEST(SmallComponents, AreFoundByTheSizeOfQuads)
{
  const PreparedSurface surface = withIslands();
  const SmallComponents none = findSmallComponents(surface, 0.001);
  EXPECT_EQ(none.count, 0u);
  EXPECT_EQ(none.components, 3u);
  const SmallComponents small = findSmallComponents(surface, 0.2);
  EXPECT_EQ(small.count, 2u);
  EXPECT_EQ(small.components, 3u);
  EXPECT_EQ(small.quads, 10);
  EXPECT_LT((small.place - Vector3(3, 0, 0)).norm(), 0.01); // the larger one of the two
  EXPECT_EQ(findSmallComponents(surface, 100).count, 3u);
}

TEST(SmallComponents, GoButNeverAll)
{
  PreparedSurface surface = withIslands();
  const std::uint64_t hash = surface.hash;
  EXPECT_EQ(removeSmallComponents(surface, findSmallComponents(surface, 100)), 0u);
  EXPECT_EQ(surface.hash, hash);
  EXPECT_EQ(removeSmallComponents(surface, findSmallComponents(surface, 0.2)), 2u);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_NE(surface.hash, hash);
  EXPECT_EQ(surface.components, 1u);
  const TopologySummary topology = summarizeTopology(surface.mesh);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.eulerCharacteristic, 2);
  EXPECT_NEAR(surface.area, test::area(surface.mesh), 1e-9 * surface.area);
}

TEST(SmallComponents, AreRefinedEnoughForEightIrregularVertices)
{
  PreparedSurface surface = withIslands();
  refineSurface(surface, 0.5, {});
  EXPECT_EQ(validate(surface.mesh), "");
  const ComponentSizes sizes = measureComponents(surface.mesh);
  std::vector<std::size_t> faces(sizes.area.size(), 0);
  for (const Index c : sizes.componentOfFace)
  {
    ++faces[c];
  }
  for (const std::size_t n : faces)
  {
    EXPECT_GE(n, 26u);
  }
}

} // namespace
} // namespace quadrille
