// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/Topology.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille
{

namespace
{

struct NamedMesh
{
  std::string name;
  Mesh mesh;
  long long chi;
  Index loops;
  Index components;
};

std::vector<NamedMesh> sharedMeshes()
{
  return { { "plane", test::gridPlane(4, 3), 1, 1, 1 }, { "hole", test::plateWithHole(2), 0, 2, 1 },
    { "L", test::plateL(3), 1, 1, 1 }, { "cube", test::unitCube(3), 2, 0, 1 },
    { "sphere", test::sphere(2), 2, 0, 1 }, { "torus", test::torus(7, 5), 0, 0, 1 },
    { "square torus", test::squareTorus(2), 0, 0, 1 },
    { "double torus", test::doubleTorus(2), -2, 0, 1 },
    { "cylinder", test::openCylinder(6, 3), 0, 2, 1 }, { "two", test::twoComponents(), 4, 0, 2 } };
}

std::string refusalOf(const std::function<void()>& call)
{
  try
  {
    call();
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

} // namespace

TEST(Topology, SharedMeshesHaveTheirTopology)
{
  for (const NamedMesh& named : sharedMeshes())
  {
    SCOPED_TRACE(named.name);
    EXPECT_EQ(validate(named.mesh), "");
    const TopologySummary summary = summarizeTopology(named.mesh);
    EXPECT_EQ(summary.eulerCharacteristic, named.chi);
    EXPECT_EQ(summary.boundaryLoops, named.loops);
    EXPECT_EQ(summary.components, named.components);
    if (named.loops == 0)
    {
      EXPECT_GT(test::signedVolume(named.mesh), 0);
    }
  }
}

// More faces than one thread takes at once.
TEST(Topology, SummaryByManyThreads)
{
  Mesh mesh = test::torus(200, 150);
  for (const int i : { 1, 2, 3 })
  {
    mesh =
      test::disjointUnion(std::move(mesh), test::plateWithHole(10 * i), Vector3(5.0 * i, 0, 0));
  }
  for (const int threads : { 1, 2, 5 })
  {
    const TopologySummary summary = summarizeTopology(mesh, threads);
    EXPECT_EQ(summary.components, 4u);
    EXPECT_EQ(summary.boundaryLoops, 6u);
    EXPECT_EQ(summary.eulerCharacteristic, 0);
  }
}

TEST(Topology, OutgoingHalfEdgesReachEveryFaceOfTheirVertex)
{
  for (const NamedMesh& named : sharedMeshes())
  {
    SCOPED_TRACE(named.name);
    const Mesh& mesh = named.mesh;
    const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
    Index visited = 0;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      Index h = outgoing[v];
      do
      {
        EXPECT_EQ(mesh.origin[h], v);
        ++visited;
        h = mesh.rotateCounterclockwise(h);
      } while (h != kInvalidIndex && h != outgoing[v]);
    }
    EXPECT_EQ(visited, mesh.halfEdgeCount());
  }
}

TEST(Topology, CubeHasItsTwelveEdgesAsFeatures)
{
  const Mesh cube = test::markFeatures(test::unitCube(5), test::kPi / 4);
  // 12 edges of 5 cells each, two half-edges an edge.
  EXPECT_EQ(std::count(cube.flags.begin(), cube.flags.end(), kFeatureEdge), 12 * 5 * 2);
  EXPECT_EQ(validate(cube), "");
}

TEST(Topology, ComponentsAreNumberedByTheirLowestFace)
{
  Index count = 0;
  const Mesh mesh = test::twoComponents();
  const std::vector<Index> component = faceComponents(mesh, count);
  EXPECT_EQ(count, 2u);
  EXPECT_TRUE(std::is_sorted(component.begin(), component.end()));
  EXPECT_EQ(std::count(component.begin(), component.end(), 0u), 320);
}

TEST(Topology, PairingSurvivesAVertexOfHighValence)
{
  // A cone of 20,000 faces: all in the bucket of vertex 0, which must not cost quadratic time.
  const Index rim = 20000;
  std::vector<Index> origin;
  for (Index i = 0; i < rim; ++i)
  {
    origin.insert(origin.end(), { 0, 1 + i, 1 + (i + 1) % rim });
  }
  const std::vector<Index> twin = pairHalfEdges(origin, rim + 1);
  EXPECT_EQ(std::count(twin.begin(), twin.end(), kInvalidIndex), rim);
}

TEST(Topology, PairingNamesWhatIsWrong)
{
  EXPECT_NE(refusalOf(
              [] {
                pairHalfEdges({ 0, 1, 2, 1, 0, 3, 0, 1, 4 }, 5);
              })
              .find("(0, 1)"),
    std::string::npos);
  EXPECT_NE(refusalOf(
              [] {
                pairHalfEdges({ 0, 1, 2, 0, 1, 3 }, 4);
              })
              .find("same direction"),
    std::string::npos);
  EXPECT_NE(refusalOf([] { pairHalfEdges({ 0, 1, 7 }, 4); }).find("vertex 7"), std::string::npos);
  EXPECT_NE(refusalOf(
              [] {
                pairHalfEdges({ 0, 1, 1 }, 4);
              })
              .find("two corners"),
    std::string::npos);
  EXPECT_TRUE(pairHalfEdges({}, 0).empty());
}

TEST(Topology, ValidateFindsEachKindOfDamage)
{
  const Mesh good = test::markFeatures(test::unitCube(2), 1);
  const auto damaged = [&good](const std::function<void(Mesh&)>& damage)
  {
    Mesh mesh = good;
    damage(mesh);
    return validate(mesh);
  };
  EXPECT_EQ(validate(good), "");
  EXPECT_NE(damaged([](Mesh& m) { m.twin.edit()[4] = 4; }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.twin.edit()[4] = kInvalidIndex; }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.flags.edit()[5] ^= kFeatureEdge; }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.flags.pop_back(); }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.position.edit()[3].x() = NAN; }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.position.emplace_back(0, 0, 0); }), "");
  EXPECT_NE(damaged([](Mesh& m) { m.origin.edit()[0] = m.vertexCount(); }), "");
}

TEST(Topology, ValidateFindsABowTie)
{
  const Mesh bowTie =
    test::makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { -1, 0, 0 }, { -1, -1, 0 } },
      { { 0, 1, 2 }, { 0, 3, 4 } });
  EXPECT_NE(validate(bowTie).find("vertex 0 is not manifold"), std::string::npos);
}

} // namespace quadrille
