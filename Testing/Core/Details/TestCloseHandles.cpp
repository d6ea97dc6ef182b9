// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/CloseHandles.h"

#include "Base/Angles.h"
#include "Details/Handles.h"
#include "Mesh/CutOpen.h"
#include "Mesh/Topology.h"
#include "SurfaceInputs.h"
#include "TestHandleMeshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille
{
namespace
{

std::vector<std::vector<Index>> placesOf(const Mesh& mesh, double limit)
{
  std::vector<std::vector<Index>> places;
  for (const HandleLoop& loop : findHandles(mesh, limit).loops)
  {
    places.push_back(loop.vertices);
  }
  return places;
}

void expectSourcesFit(const PreparedSurface& surface)
{
  ASSERT_EQ(surface.sourcePolygon.size(), surface.mesh.faceCount());
  ASSERT_EQ(surface.sourcePoints.size(), surface.mesh.faceCount());
  ASSERT_EQ(surface.refinedEntry.size(), surface.mesh.faceCount());
}

TEST(CloseHandles, TinyHandleOfASphereIsGone)
{
  const test::SphereWithHandle model = test::sphereWithHandle(4, Vector3(1, 2, 3).normalized());
  PreparedSurface surface = test::prepare(test::toInput(model.mesh));
  const std::uint64_t hash = surface.hash;
  const double area = surface.area;
  const double limit = 1.5 * model.mouthLength;
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, limit), 2 * limit).size(), 1u);
  EXPECT_EQ(validate(surface.mesh), "");
  const TopologySummary topology = summarizeTopology(surface.mesh);
  EXPECT_EQ(topology.eulerCharacteristic, 2);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.boundaryLoops, 0u);
  EXPECT_EQ(surface.repair.closedHandles, 1u);
  EXPECT_TRUE(test::contains(surface.repair.text(), "1 small handle cut and closed"));
  EXPECT_NE(surface.hash, hash);
  EXPECT_NEAR(surface.area, test::area(surface.mesh), 1e-12);
  EXPECT_LT(surface.area, area);
  for (const Vector3& p : surface.mesh.position)
  {
    EXPECT_LT(p.norm(), 1 + 1e-12) << "what bowed out of the sphere is gone";
  }
  expectSourcesFit(surface);
}

/// A plate of 9 x 9 x 3 with a hole of 1 x 1 through its middle.
SurfaceInput drilledPlate()
{
  return test::toInput(
    test::voxelSurface({ 9, 9, 3 }, 2, [](int x, int y, int) { return x != 4 || y != 4; }));
}

/// Of the vertices on the wall of the hole, between its mouths.
std::size_t countInHole(const Mesh& mesh, double height = 3)
{
  return static_cast<std::size_t>(std::count_if(mesh.position.begin(), mesh.position.end(),
    [height](const Vector3& p)
    {
      return std::max(std::abs(p.x() - 4.5), std::abs(p.y() - 4.5)) < 0.6 && p.z() > 0 &&
        p.z() < height;
    }));
}

TEST(CloseHandles, HoleThroughAPlateIsFilledUpToItsMouths)
{
  PreparedSurface surface = test::prepare(drilledPlate());
  ASSERT_GT(countInHole(surface.mesh), 0u);
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 4.1), 8.2).size(), 1u);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  EXPECT_EQ(countInHole(surface.mesh), 0u);
  EXPECT_NEAR(surface.area, 2 * 81 + 4 * 27, 1e-9) << "a plate without a hole";
  EXPECT_NEAR(surface.area, test::area(surface.mesh), 1e-9);
  expectSourcesFit(surface);
}

/// As CAD programs write a bore: what is round it is far shorter than the triangles along it.
TEST(CloseHandles, BoreOfLongTrianglesIsFilledUpToItsMouths)
{
  Mesh plate =
    test::voxelSurface({ 9, 9, 3 }, 1, [](int x, int y, int) { return x != 4 || y != 4; });
  for (Vector3& p : plate.position.editAll())
  {
    p.z() *= 10;
  }
  PreparedSurface surface = test::prepare(test::toInput(plate));
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 4.1), 8.2).size(), 1u);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  EXPECT_EQ(countInHole(surface.mesh, 30), 0u);
  EXPECT_NEAR(surface.area, 2 * 81 + 4 * 270, 1e-9) << "a block without a bore";
  EXPECT_NEAR(surface.area, test::area(surface.mesh), 1e-9);
  expectSourcesFit(surface);
}

TEST(CloseHandles, WhatIsThickEnoughForQuadsIsNoStub)
{
  PreparedSurface surface = test::prepare(drilledPlate());
  const std::size_t before = countInHole(surface.mesh);
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 4.1), 8.2, 3.9).size(), 1u);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  EXPECT_GE(countInHole(surface.mesh), before); // both pits stay, with the caps between them
}

TEST(CloseHandles, WhatIsAskedForInAHoleStays)
{
  SurfaceInput input = drilledPlate();
  input.targetValences.assign(input.points.size(), 0);
  for (std::size_t i = 0; i < input.points.size(); ++i)
  {
    input.targetValences[i] = input.points[i] == Vector3(4, 4, 1.5) ? 5 : 0;
  }
  PreparedSurface surface = test::prepare(input);
  ASSERT_EQ(surface.valenceRequests.size(), 1u);
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 4.1), 8.2).size(), 1u);
  EXPECT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(surface.valenceRequests.size(), 1u);
  EXPECT_EQ(surface.mesh.position[surface.valenceRequests[0].vertex], Vector3(4, 4, 1.5));
}

TEST(CloseHandles, CapsTakeTheAttributesOfTheFacesBesideThem)
{
  const Mesh mesh = test::torus(40, 10, 1, 0.2);
  PreparedSurface surface = test::prepare(test::toInput(mesh));
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 1.5), 2).size(), 1u);
  std::size_t off = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      const Vector3 p = test::cornerOnInput(surface, mesh.position, f, corner);
      const Vector3& q =
        surface.mesh.position[surface.mesh.origin[3 * f + static_cast<Index>(corner)]];
      off += (p - q).norm() > 1e-12 ? 1 : 0;
      EXPECT_LT((p - q).norm(), 0.21); // the middles, from the middle of an edge on the tube
    }
  }
  EXPECT_EQ(off, 20u); // the middle corners of two fans of 10
  EXPECT_EQ(surface.mesh.faceCount(), mesh.faceCount() + 20);
}

TEST(CloseHandles, AllHandlesOfABlockOneByOne)
{
  PreparedSurface surface = test::prepare(test::toInput(test::doubleTorus(4)));
  // Two loops of 4 sides each, in one call: one component, no handle.
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 4.1), 8.2).size(), 2u);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  EXPECT_EQ(summarizeTopology(surface.mesh).components, 1u);
}

TEST(CloseHandles, OneHandleIsNeverCutTwice)
{
  PreparedSurface surface = test::prepare(test::toInput(test::torus(40, 10, 1, 0.2)));
  std::vector<std::vector<Index>> places;
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    places.push_back({ v });
  }
  ASSERT_EQ(closeHandles(surface, places, 2).size(), 1u);
  EXPECT_EQ(summarizeTopology(surface.mesh).components, 1u);
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
}

TEST(CloseHandles, WhatIsLongOrNoHandleStays)
{
  for (const Mesh& mesh :
    { test::torus(40, 10, 1, 0.2), test::sphere(3), test::openCylinder(20, 20, 0.1, 1) })
  {
    PreparedSurface surface = test::prepare(test::toInput(mesh));
    const std::uint64_t hash = surface.hash;
    std::vector<std::vector<Index>> places;
    for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
    {
      places.push_back({ v });
    }
    EXPECT_EQ(closeHandles(surface, places, 1).size(), 0u);
    EXPECT_EQ(surface.hash, hash);
    EXPECT_EQ(surface.repair.closedHandles, 0u);
  }
}

/// Two cubes at the same place, joined crosswise along slits in two of their edges.
Mesh cubesJoinedAtSlits()
{
  const Mesh cube = test::unitCube(4);
  Mesh mesh = test::disjointUnion(cube, cube, Vector3::Zero());
  std::vector<std::uint8_t> isCut(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 from = mesh.position[mesh.origin[h]], to = mesh.position[mesh.target(h)];
    const bool isOnEdge = from.x() == from.y() && to.x() == from.x() && to.y() == from.x() &&
      (from.x() == 0 || from.x() == 1);
    isCut[h] = isOnEdge && std::min(from.z(), to.z()) > 0.2 && std::max(from.z(), to.z()) < 0.8;
  }
  cutOpen(mesh, isCut);
  std::vector<Index> stands(mesh.vertexCount());
  std::iota(stands.begin(), stands.end(), Index{ 0 });
  const auto boundary = boundaryHalfEdges(mesh);
  const Index half = mesh.halfEdgeCount() / 2;
  for (const Index h : boundary)
  {
    for (const Index g : boundary)
    {
      if (h < half && g >= half && mesh.position[mesh.origin[h]] == mesh.position[mesh.target(g)] &&
        mesh.position[mesh.target(h)] == mesh.position[mesh.origin[g]])
      {
        mesh.twin.edit()[h] = g;
        mesh.twin.edit()[g] = h;
        stands[mesh.target(g)] = mesh.origin[h];
        stands[mesh.origin[g]] = mesh.target(h);
      }
    }
  }
  Mesh joined;
  std::vector<Index> newId(stands.size(), 0);
  for (Index v = 0; v < stands.size(); ++v)
  {
    newId[v] = joined.vertexCount();
    if (stands[v] == v)
    {
      joined.position.push_back(Vector3(mesh.position[v]));
    }
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    joined.origin.push_back(Index{ newId[stands[mesh.origin[h]]] });
  }
  joined.twin = mesh.twin;
  joined.flags.assign(mesh.halfEdgeCount(), 0);
  return joined;
}

/// The loop round a slit leads along an edge and back: its cap has no area, and would be a face between sharp edges.
TEST(CloseHandles, CapsWithoutAreaAreNoFaces)
{
  const Mesh mesh = cubesJoinedAtSlits();
  ASSERT_EQ(validate(mesh), "");
  ASSERT_EQ(summarizeTopology(mesh).eulerCharacteristic, 0);
  PreparedSurface surface = test::prepare(test::toInput(mesh), kRightAngle / 2);
  ASSERT_EQ(closeHandles(surface, placesOf(surface.mesh, 1.1), 2.2).size(), 1U);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
  Mesh opened = surface.mesh;
  cutOpenAtFeatures(opened);
  Index count = 0;
  const std::vector<Index> labels = faceComponents(opened, count);
  std::vector<double> areas(count, 0);
  for (Index f = 0; f < labels.size(); ++f)
  {
    areas[labels[f]] += surface.mesh.faceArea(f);
  }
  EXPECT_GT(*std::min_element(areas.begin(), areas.end()), 0.1);
}

TEST(CloseHandles, LoopsOfTheBoundaryAreNotCut)
{
  // A row of holes with every vertex of one circle on one of them: each loop round the tube meets the boundary.
  constexpr Index kAround = 40;
  Mesh mesh = test::torus(kAround, 10, 1, 0.2);
  std::vector<test::Triangle> triangles;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (f >= 2 * kAround || f % 4 != 0)
    {
      triangles.push_back({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
    }
  }
  mesh = test::makeMesh(mesh.position, triangles);
  PreparedSurface surface = test::prepare(test::toInput(mesh));
  std::vector<std::vector<Index>> places;
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    places.push_back({ v });
  }
  ASSERT_EQ(findHandles(surface.mesh, 2).loops.size(), 1u);
  EXPECT_EQ(closeHandles(surface, places, 2).size(), 0u);
}

} // namespace
} // namespace quadrille
