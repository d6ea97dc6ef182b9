// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMeshes.h"
#include "Export/MeshSets.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quadrille
{

namespace
{

using namespace quadrille::testing;

std::set<Index> cornerNodes(const MeshSets& sets)
{
  std::set<Index> nodes;
  for (const CornerSet& corner : sets.corners)
  {
    nodes.insert(corner.node);
  }
  return nodes;
}

/// What holds for any mesh: patches are a partition; each chain goes along the sides that it names and ends at corners,
/// with none between; no edge is in two chains; names count from 1.
void expectConsistent(const ElementMesh& mesh, const MeshSets& sets)
{
  std::vector<int> taken(mesh.elementCount(), 0);
  for (const ElementSet& patch : sets.patches)
  {
    EXPECT_TRUE(std::is_sorted(patch.elements.begin(), patch.elements.end()));
    for (const Index e : patch.elements)
    {
      ++taken[e];
    }
  }
  EXPECT_TRUE(std::all_of(taken.begin(), taken.end(), [](int count) { return count == 1; }));

  const std::set<Index> corners = cornerNodes(sets);
  std::set<std::pair<Index, Index>> edges;
  for (const EdgeChain& chain : sets.chains)
  {
    const std::size_t count = chain.sides.size();
    ASSERT_EQ(chain.nodes.size(), count + (chain.closed ? 0 : 1));
    for (std::size_t i = 0; i < count; ++i)
    {
      const ElementSide side = chain.sides[i];
      const std::pair<Index, Index> edge =
        std::minmax(chain.nodes[i], chain.nodes[(i + 1) % chain.nodes.size()]);
      const std::pair<Index, Index> ofSide =
        std::minmax(mesh.corner(side.element, side.side), mesh.corner(side.element, side.side + 1));
      EXPECT_EQ(edge, ofSide);
      EXPECT_TRUE(edges.insert(edge).second);
      if (mesh.nodesPerElement > 4)
      {
        EXPECT_EQ(chain.middles[i], mesh.middle(side.element, side.side));
      }
      if (i > 0 || chain.closed)
      {
        EXPECT_EQ(corners.count(chain.nodes[i]), 0U);
      }
    }
    if (!chain.closed)
    {
      EXPECT_EQ(sets.corners[chain.startCorner].node, chain.nodes.front());
      EXPECT_EQ(sets.corners[chain.endCorner].node, chain.nodes.back());
    }
  }
  std::size_t used = 0;
  for (const auto* curves : { &sets.boundaries, &sets.curves })
  {
    for (std::size_t i = 0; i < curves->size(); ++i)
    {
      if ((*curves)[i].isNamed)
      {
        continue;
      }
      EXPECT_EQ((*curves)[i].name,
        (curves == &sets.curves ? "CURVE_" : "BOUNDARY_") + std::to_string(i + 1));
      used += (*curves)[i].chains.size();
      const std::vector<Index> nodes = nodesOf(sets, (*curves)[i]);
      EXPECT_EQ(std::set<Index>(nodes.begin(), nodes.end()).size(), nodes.size());
    }
  }
  EXPECT_EQ(used, sets.chains.size());
}

MeshSets checkedSets(const ElementMesh& mesh)
{
  const MeshSets sets = setsOf(mesh);
  expectConsistent(mesh, sets);
  return sets;
}

} // namespace

TEST(MeshSets, PlateHasOneLoopWithFourCorners)
{
  for (const int nodes : { 4, 8, 9 })
  {
    const ElementMesh plate = nodes == 4 ? flatGrid(5, 3) : secondOrder(flatGrid(5, 3), nodes);
    const MeshSets sets = checkedSets(plate);
    ASSERT_EQ(sets.boundaries.size(), 1U);
    EXPECT_EQ(sets.boundaries[0].chains.size(), 4U);
    EXPECT_EQ(nodesOf(sets, sets.boundaries[0]).size(), nodes == 4 ? 16U : 32U);
    EXPECT_EQ(sidesOf(sets, sets.boundaries[0]).size(), 16U);
    EXPECT_TRUE(sets.curves.empty());
    EXPECT_EQ(cornerNodes(sets), (std::set<Index>{ 0, 5, 18, 23 }));
    ASSERT_EQ(sets.patches.size(), 1U);
    EXPECT_EQ(sets.patches[0].name, "PATCH_1");
    EXPECT_EQ(sets.chains[0].patches, std::vector<Index>{ 0 });
  }
}

/// A plate of 4 x 2: two edges of its lower side have one name, and so has one of a feature through the middle; the
/// node between the two of the lower side has a name, too.
TEST(MeshSets, NamesMakeSetsOfTheirOwn)
{
  ElementMesh plate = flatGrid(4, 2);
  for (const Index i : { 0, 1, 2, 3 })
  {
    markFeature(plate, 5 + i, 6 + i);
  }
  plate.curveNames = { "rim", "rib" };
  plate.curveOf.assign(4 * plate.elementCount(), kInvalidIndex);
  plate.curveOf[0] = plate.curveOf[4] = 0; // below elements 0 and 1
  plate.curveOf[2] = 1;                    // above element 0: from one of its two elements
  plate.namedNodes.push_back({ 1, "hook" });
  const MeshSets sets = setsOf(plate);
  ASSERT_EQ(sets.boundaries.size(), 1U);
  EXPECT_EQ(sidesOf(sets, sets.boundaries[0]).size(), 12U); // all of it, as without names
  ASSERT_EQ(sets.curves.size(), 3U);
  EXPECT_EQ(sets.curves[0].name, "CURVE_1");
  EXPECT_EQ(nodesOf(sets, sets.curves[0]), (std::vector<Index>{ 9, 8, 7, 6 }));
  EXPECT_EQ(sets.curves[1].name, "rim");
  EXPECT_EQ(nodesOf(sets, sets.curves[1]), (std::vector<Index>{ 0, 1, 2 }));
  EXPECT_EQ(sets.curves[1].chains.size(), 2U); // cut at the hook
  EXPECT_EQ(sets.curves[2].name, "rib");
  EXPECT_EQ(nodesOf(sets, sets.curves[2]), (std::vector<Index>{ 6, 5 }));
  for (const Index node : { 0, 2, 6 }) // where names end
  {
    EXPECT_EQ(cornerNodes(sets).count(node), 1U) << node;
  }
  EXPECT_TRUE(std::any_of(sets.corners.begin(), sets.corners.end(),
    [](const CornerSet& corner) { return corner.node == 1 && corner.name == "hook"; }));

  plate.curveOf[2] = 2;
  EXPECT_THROW(setsOf(plate), InvalidInput);
  plate.curveOf[2] = 1;
  plate.namedNodes.push_back({ 15, "nowhere" });
  EXPECT_THROW(setsOf(plate), InvalidInput);
}

TEST(MeshSets, BoundaryHasItsElementsOnTheLeft)
{
  const ElementMesh plate = flatGrid(2, 2);
  const MeshSets sets = checkedSets(plate);
  // Counterclockwise from the first corner; the area by the shoelace formula is that of the plate.
  const std::vector<Index> nodes = nodesOf(sets, sets.boundaries[0]);
  double area = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Vector3& p = plate.nodes[nodes[i]];
    const Vector3& q = plate.nodes[nodes[(i + 1) % nodes.size()]];
    area += (p[0] * q[1] - q[0] * p[1]) / 2;
  }
  EXPECT_EQ(area, 4);
}

TEST(MeshSets, RoundHolesHaveNoCornersHoweverCoarse)
{
  for (const Index around : { 3U, 4U, 6U, 24U })
  {
    const MeshSets sets = checkedSets(annulus(around, 2));
    EXPECT_EQ(sets.boundaries.size(), 2U);
    EXPECT_TRUE(sets.corners.empty());
    EXPECT_TRUE(sets.chains[0].closed && sets.chains[1].closed);
    EXPECT_EQ(sets.chains[0].nodes.size(), around);
  }
}

TEST(MeshSets, CubeHasTwelveCurvesAndEightCorners)
{
  const ElementMesh mesh = cube(3);
  const MeshSets sets = checkedSets(mesh);
  EXPECT_TRUE(sets.boundaries.empty());
  EXPECT_EQ(sets.curves.size(), 12U);
  EXPECT_EQ(sets.corners.size(), 8U);
  EXPECT_EQ(sets.patches.size(), 6U);
  std::vector<int> curvesRound(6, 0);
  for (const EdgeChain& chain : sets.chains)
  {
    EXPECT_EQ(chain.sides.size(), 3U);
    ASSERT_EQ(chain.patches.size(), 2U); // a border of two sides of the cube
    ++curvesRound[chain.patches[0]];
    ++curvesRound[chain.patches[1]];
  }
  EXPECT_EQ(curvesRound, std::vector<int>(6, 4));
}

TEST(MeshSets, FeaturesInsideAPatchAreNoBorder)
{
  ElementMesh plate = flatGrid(4, 4);
  markFeature(plate, 11, 12);
  markFeature(plate, 12, 13);
  const MeshSets sets = checkedSets(plate);
  ASSERT_EQ(sets.curves.size(), 1U);
  // As the lower element has it on its left.
  EXPECT_EQ(nodesOf(sets, sets.curves[0]), (std::vector<Index>{ 13, 12, 11 }));
  EXPECT_TRUE(sets.chains[sets.curves[0].chains[0]].patches.empty());
  // The four of the plate, and both ends of the feature.
  EXPECT_EQ(cornerNodes(sets), (std::set<Index>{ 0, 4, 20, 24, 11, 13 }));
}

TEST(MeshSets, FeatureCutsTheLoopWhereItRunsIntoIt)
{
  ElementMesh plate = flatGrid(4, 2);
  markFeature(plate, 2, 7);
  markFeature(plate, 7, 12);
  const MeshSets sets = checkedSets(plate);
  EXPECT_EQ(cornerNodes(sets), (std::set<Index>{ 0, 2, 4, 10, 12, 14 }));
  EXPECT_EQ(sets.boundaries[0].chains.size(), 6U);
  EXPECT_EQ(sets.curves.size(), 1U);
}

TEST(MeshSets, BentFeatureHasACornerWhereElementsDoNotGoStraightOn)
{
  ElementMesh plate = flatGrid(4, 4);
  for (const auto& [a, b] : { std::pair<Index, Index>{ 10, 11 }, { 11, 12 }, { 12, 7 }, { 7, 2 } })
  {
    markFeature(plate, a, b);
  }
  const MeshSets sets = checkedSets(plate);
  EXPECT_EQ(sets.curves.size(),
    2U); // cut at node 12, a right angle with one element inside and three outside
  EXPECT_EQ(cornerNodes(sets).count(12), 1U);
  EXPECT_EQ(cornerNodes(sets).count(11), 0U);
}

TEST(MeshSets, ClosedFeatureIsOneChainWithoutEnds)
{
  ElementMesh ring = annulus(6, 2);
  for (Index i = 0; i < 6; ++i)
  {
    markFeature(ring, 6 + i, 6 + (i + 1) % 6);
  }
  const MeshSets sets = checkedSets(ring);
  ASSERT_EQ(sets.curves.size(), 1U);
  EXPECT_TRUE(sets.chains[sets.curves[0].chains[0]].closed);
  EXPECT_EQ(nodesOf(sets, sets.curves[0]).size(), 6U);
  EXPECT_TRUE(sets.corners.empty());
}

/// A mark in one of the two elements is enough.
TEST(MeshSets, OneMarkIsEnough)
{
  ElementMesh plate = flatGrid(2, 1);
  plate.featureEdges[0] = 1 << 1;
  EXPECT_EQ(checkedSets(plate).curves.size(), 1U);
}

/// Marks on the boundary change nothing.
TEST(MeshSets, BoundaryIsNoFeature)
{
  ElementMesh plate = flatGrid(2, 1);
  plate.featureEdges = { 0x0F, 0x0F };
  const MeshSets sets = checkedSets(plate);
  EXPECT_EQ(sets.boundaries.size(), 1U);
  EXPECT_EQ(sets.curves.size(), 1U); // the edge between the two elements
}

/// Two plates that touch in one node have one loop each, which both come through it.
TEST(MeshSets, LoopsThroughATouchingPoint)
{
  ElementMesh mesh = flatGrid(2, 2);
  mesh.elements.erase(
    mesh.elements.begin() + 4, mesh.elements.begin() + 12); // keeps elements 0 and 3
  mesh.featureEdges.assign(2, 0);
  const MeshSets sets = checkedSets(mesh);
  EXPECT_EQ(sets.boundaries.size(), 2U);
  EXPECT_EQ(nodesOf(sets, sets.boundaries[0]).size(), 4U);
  EXPECT_EQ(cornerNodes(sets).count(4), 1U); // in the middle, where four edges meet
}

/// Three plates at one edge: it is a feature, no boundary, and ends the loops that run into it.
TEST(MeshSets, ThreeSheetsAtAnEdge)
{
  ElementMesh mesh = flatGrid(2, 1);
  mesh.nodes.emplace_back(1, 0, 1);
  mesh.nodes.emplace_back(1, 1, 1);
  for (const Index node : { 1, 4, 7, 6 })
  {
    mesh.elements.push_back(node);
  }
  mesh.featureEdges.assign(3, 0);
  const MeshSets sets = checkedSets(mesh);
  ASSERT_EQ(sets.curves.size(), 1U);
  EXPECT_EQ(nodesOf(sets, sets.curves[0]).size(), 2U);
  EXPECT_EQ(sets.boundaries.size(), 3U);
  EXPECT_EQ(cornerNodes(sets).count(1), 1U);
  EXPECT_EQ(cornerNodes(sets).count(4), 1U);
}

/// Neighbours that are oriented against each other are neighbours.
TEST(MeshSets, TurnedElementIsNoBoundary)
{
  ElementMesh plate = flatGrid(3, 1);
  std::reverse(plate.elements.begin() + 4, plate.elements.begin() + 8);
  const MeshSets sets = checkedSets(plate);
  EXPECT_EQ(sets.boundaries.size(), 1U);
  EXPECT_EQ(nodesOf(sets, sets.boundaries[0]).size(), 8U);
  EXPECT_EQ(sets.corners.size(), 4U);
}

TEST(MeshSets, PatchesOfOneNameAreOneSet)
{
  ElementMesh mesh = cube(1);
  mesh.patches[5].name = mesh.patches[0].name = "ends";
  mesh.patches[2].number = -7;
  const MeshSets sets = checkedSets(mesh);
  ASSERT_EQ(sets.patches.size(), 5U);
  EXPECT_EQ(sets.patches[0].name, "PATCH_MINUS_7"); // by the numbers
  EXPECT_EQ(sets.patches[1].name, "ends");
  EXPECT_EQ(sets.patches[1].elements, (std::vector<Index>{ 0, 5 }));
  EXPECT_FALSE(sets.patches[0].isNamed);
  EXPECT_TRUE(sets.patches[1].isNamed);
  EXPECT_EQ(nodesOf(mesh, sets.patches[1]).size(), 6U); // two sides that share an edge
}

/// Each node once, shared or not; those of other patches only where they lie on the border.
TEST(MeshSets, NodesOfPatchesAreThoseOfTheirElements)
{
  ElementMesh mesh = flatGrid(3, 1);
  mesh.patches.push_back({ 2, "right" });
  mesh.patchOf = { 0, 0, 1 };
  EXPECT_EQ(nodesOf(mesh, setsOf(mesh).patches[0]), (std::vector<Index>{ 0, 1, 2, 4, 5, 6 }));
  EXPECT_EQ(nodesOf(mesh, setsOf(mesh).patches[1]), (std::vector<Index>{ 2, 3, 6, 7 }));
  for (const int nodes : { 8, 9 })
  {
    const ElementMesh larger = secondOrder(mesh, nodes);
    const MeshSets sets = setsOf(larger);
    // Two elements side by side: 6 corners, 7 middles of edges, and of 9 nodes 2 centres.
    EXPECT_EQ(nodesOf(larger, sets.patches[0]).size(), nodes == 8 ? 13U : 15U);
    EXPECT_EQ(nodesOf(larger, sets.patches[1]).size(), static_cast<std::size_t>(nodes));
  }
}

TEST(MeshSets, PatchesWithoutElementsAreNoSets)
{
  ElementMesh mesh = flatGrid(1, 1);
  mesh.patches.push_back({ 2, "unused" });
  EXPECT_EQ(checkedSets(mesh).patches.size(), 1U);
  EXPECT_TRUE(setsOf(ElementMesh()).patches.empty());
}

TEST(MeshSets, RefusesDamagedMeshes)
{
  const auto refusal = [](ElementMesh mesh, void (*damage)(ElementMesh&)) -> std::string
  {
    damage(mesh);
    try
    {
      setsOf(mesh);
    }
    catch (const InvalidInput& error)
    {
      return error.what();
    }
    return "";
  };
  const ElementMesh plate = flatGrid(2, 1);
  EXPECT_NE(
    refusal(plate, [](ElementMesh& m) { m.elements[6] = 99; }).find("element 1 has the node 99"),
    std::string::npos);
  EXPECT_NE(refusal(plate, [](ElementMesh& m) { m.elements[5] = m.elements[4]; }).find("twice"),
    std::string::npos);
  EXPECT_NE(refusal(plate, [](ElementMesh& m) { m.nodes[3][1] = std::nan(""); }).find("node 3 has"),
    std::string::npos);
  EXPECT_NE(refusal(plate,
              [](ElementMesh& m) {
                m.thickness = { 1, -1 };
              })
              .find("element 1 has the thickness"),
    std::string::npos);
  EXPECT_NE(refusal(plate,
              [](ElementMesh& m) {
                m.axis = { Vector3::Zero(), Vector3(1, 1, 0) };
              })
              .find("axis of element 1"),
    std::string::npos);
  EXPECT_NE(refusal(plate,
              [](ElementMesh& m) {
                m.patchOf = { 0, 1 };
              })
              .find("element 1 is of patch"),
    std::string::npos);
  EXPECT_NE(
    refusal(plate, [](ElementMesh& m) { m.elements.pop_back(); }).find("ends in the middle"),
    std::string::npos);
  EXPECT_NE(refusal(plate, [](ElementMesh& m) { m.featureEdges.push_back(0); })
              .find("feature edges are given"),
    std::string::npos);
}

} // namespace quadrille
