// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/DegenerateFaces.h"
#include "SurfaceInputs.h"

namespace quadrille
{

namespace
{

using namespace test;

std::vector<std::vector<Index>> cubeSides(Index first)
{
  // Corner i of a cube is at the bits of i: x, y, z.
  std::vector<std::vector<Index>> sides{ { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
    { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  for (std::vector<Index>& side : sides)
  {
    for (Index& v : side)
    {
      v += first;
    }
  }
  return sides;
}

std::vector<Vector3> cubeCorners(const Vector3& at)
{
  std::vector<Vector3> corners;
  for (int i = 0; i < 8; ++i)
  {
    corners.push_back(at + Vector3(i & 1, i >> 1 & 1, i >> 2 & 1));
  }
  return corners;
}

/// Two unit cubes, the second one moved by `step`; as one list of points, coincident ones joined.
SurfaceInput twoCubes(const Vector3& step)
{
  std::vector<Vector3> points = cubeCorners({ 0, 0, 0 });
  std::vector<Index> ids(8);
  const std::vector<Vector3> second = cubeCorners(step);
  for (std::size_t i = 0; i < 8; ++i)
  {
    const auto found = std::find(points.begin(), points.end(), second[i]);
    ids[i] = static_cast<Index>(found - points.begin());
    if (found == points.end())
    {
      points.push_back(second[i]);
    }
  }
  std::vector<std::vector<Index>> polygons = cubeSides(0);
  for (std::vector<Index> side : cubeSides(0))
  {
    for (Index& v : side)
    {
      v = ids[v];
    }
    polygons.push_back(side);
  }
  return makeInput(points, polygons);
}

/// A band of n quads with half a twist.
SurfaceInput moebius(int n)
{
  std::vector<Vector3> points;
  for (int i = 0; i < n; ++i)
  {
    const double t = 2 * kPi * i / n;
    for (const double s : { -0.3, 0.3 })
    {
      const double r = 1 + s * std::cos(t / 2);
      points.emplace_back(r * std::cos(t), r * std::sin(t), s * std::sin(t / 2));
    }
  }
  std::vector<std::vector<Index>> polygons;
  for (Index i = 0; i < static_cast<Index>(n); ++i)
  {
    const bool last = i + 1 == static_cast<Index>(n);
    const Index a = 2 * i, b = 2 * i + 1;
    polygons.push_back({ a, b, last ? 0 : b + 2, last ? 1 : a + 2 });
  }
  return makeInput(points, polygons);
}

} // namespace

TEST(Repair, SolidsThatShareAnEdgeComeApart)
{
  const SurfaceInput input = twoCubes({ 1, 1, 0 });
  ASSERT_EQ(input.points.size(), 14u);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.nonManifoldEdges, 1u);
  EXPECT_EQ(surface.repair.nonManifoldVertices, 2u);
  const TopologySummary summary = summarizeTopology(surface.mesh);
  EXPECT_EQ(summary.components, 2u);
  EXPECT_EQ(summary.boundaryLoops, 0u);
  EXPECT_EQ(summary.eulerCharacteristic, 4);
}

TEST(Repair, SolidsThatShareAVertexComeApart)
{
  const SurfaceInput input = twoCubes({ 1, 1, 1 });
  ASSERT_EQ(input.points.size(), 15u);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.nonManifoldEdges, 0u);
  EXPECT_EQ(surface.repair.nonManifoldVertices, 1u);
  EXPECT_EQ(summarizeTopology(surface.mesh).components, 2u);
}

TEST(Repair, AWallBetweenTwoSolidsKeepsBothSides)
{
  const SurfaceInput input = twoCubes({ 1, 0, 0 });
  ASSERT_EQ(input.points.size(), 12u);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.duplicateFaces, 0u);
  const TopologySummary summary = summarizeTopology(surface.mesh);
  EXPECT_EQ(summary.components, 2u);
  EXPECT_EQ(summary.boundaryLoops, 0u);
  EXPECT_EQ(summary.eulerCharacteristic, 4);
}

TEST(Repair, ASheetWithTwoSidesKeepsOne)
{
  SurfaceInput input = toInput(gridPlane(5, 4));
  const std::size_t corners = input.polygonPoints.size();
  for (std::size_t i = 0; i < corners; i += 3)
  {
    input.polygonPoints.append(
      { input.polygonPoints[i + 1], input.polygonPoints[i], input.polygonPoints[i + 2] });
    input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.mesh.faceCount(), 40u);
  EXPECT_EQ(surface.repair.duplicateFaces, 40u);
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 1);
}

TEST(Repair, AFlapWithTwoSidesGoes)
{
  // One triangle, in both orientations, that hangs on an edge of a sphere.
  SurfaceInput input = toInput(sphere(1));
  const Index a = input.polygonPoints[0], b = input.polygonPoints[1];
  const Index c = static_cast<Index>(input.points.size());
  input.points.emplace_back(0, 0, 3);
  input.polygonPoints.append({ a, b, c, b, a, c });
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.duplicateFaces, 2u);
  EXPECT_EQ(surface.mesh.faceCount(), 80u);
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 2);
}

TEST(Repair, RepeatedFacesGo)
{
  SurfaceInput input = toInput(torus(8, 6));
  for (const std::size_t face : { 3u, 40u, 3u })
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      input.polygonPoints.push_back(Index{ input.polygonPoints[3 * face + (i + 1) % 3] });
    }
    input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.duplicateFaces, 3u);
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 0);
  EXPECT_EQ(summarizeTopology(surface.mesh).boundaryLoops, 0u);
}

TEST(Repair, AFinOnASheetLeavesTheSheetWhole)
{
  // A flat sheet, and a row of faces that stands on its middle line: three faces at each edge.
  SurfaceInput input = toInput(gridPlane(4, 4));
  const auto at = [&input](double x, double y)
  {
    return static_cast<Index>(
      std::find(input.points.begin(), input.points.end(), Vector3(x, y, 0)) - input.points.begin());
  };
  for (int i = 0; i < 4; ++i)
  {
    const Index a = at(i, 2), b = at(i + 1, 2);
    const Index c = static_cast<Index>(input.points.size());
    input.points.emplace_back(i + 0.5, 2, 1);
    input.polygonPoints.append({ a, b, c });
    input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.nonManifoldEdges, 4u);
  EXPECT_EQ(surface.components, 5u); // the sheet, and four triangles that touch in points only
  Index count = 0;
  const std::vector<Index> component = faceComponents(surface.mesh, count);
  const Index sheet = component[static_cast<std::size_t>(
    std::find(surface.sourcePolygon.begin(), surface.sourcePolygon.end(), 0u) -
    surface.sourcePolygon.begin())];
  EXPECT_EQ(std::count(component.begin(), component.end(), sheet), 32);
}

TEST(Repair, AMoebiusStripIsRefusedByName)
{
  const std::string message = messageOf([] { prepare(moebius(12)); });
  EXPECT_TRUE(test::contains(message, "not orientable")) << message;
  EXPECT_TRUE(test::contains(message, "polygon ")) << message;
}

TEST(Repair, IsolatedPointsGo)
{
  SurfaceInput input = toInput(sphere(1));
  input.points.change(
    [](std::vector<Vector3>& points) { points.insert(points.begin(), 3, Vector3(9, 9, 9)); });
  for (Index& v : input.polygonPoints.editAll())
  {
    v += 3;
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.isolatedPoints, 3u);
  EXPECT_EQ(surface.repair.text(), "3 isolated points dropped");
}

TEST(Repair, TooSmallClosedComponentsGo)
{
  SurfaceInput input = toInput(sphere(1));
  const Index a = static_cast<Index>(input.points.size());
  // A flat tetrahedron: closed, and without any area that could be kept.
  for (const double x : { 5.0, 6.0, 7.0, 8.0 })
  {
    input.points.emplace_back(x, 0, 0);
  }
  for (const std::array<Index, 3>& t : std::vector<std::array<Index, 3>>{
         { a, a + 1, a + 2 }, { a, a + 2, a + 3 }, { a, a + 3, a + 1 }, { a + 1, a + 3, a + 2 } })
  {
    input.polygonPoints.append(t.begin(), t.end());
    input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  }
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.components, 1u);
  EXPECT_EQ(surface.mesh.faceCount(), 80u);
}

TEST(Repair, FacesWithARepeatedCornerGo)
{
  SurfaceInput input = toInput(sphere(1));
  input.polygonPoints.append({ 4, 4, 7, 3, 8, 3 });
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.degenerateFaces, 2u);
  EXPECT_EQ(surface.mesh.faceCount(), 80u);
}

TEST(Repair, AVertexBesideAnEdgeIsPutOntoIt)
{
  // The top of a box has a vertex beside the middle of one edge; a face that is nearly a line fills the crack.
  for (const auto& [offset, flips] : { std::pair(1e-5, 1u), std::pair(1e-2, 0u) })
  {
    std::vector<Vector3> points = cubeCorners({ 0, 0, 0 });
    points.emplace_back(0.5, offset, 1); // 8, beside the edge from 4 to 5
    std::vector<std::vector<Index>> polygons = cubeSides(0);
    polygons[1] = { 4, 8, 5, 7, 6 };
    polygons.push_back({ 4, 5, 8 });
    const SurfaceInput input = makeInput(points, polygons);
    const PreparedSurface surface = prepare(input, 0.5);
    expectSound(surface, input);
    EXPECT_EQ(surface.repair.flippedCaps, flips);
    EXPECT_EQ(
      featureHalfEdges(surface.mesh), 24u + 2 * flips); // the edge of the box has two parts then
    EXPECT_NEAR(signedVolume(surface.mesh), 1, offset);
  }
}

TEST(Repair, CapsAreFlippedAndNoHoleOpens)
{
  // The top of a box has a vertex in the middle of one edge that the side does not know; faces without
  // area (0, 1, m) close the gap.
  std::vector<Vector3> points = cubeCorners({ 0, 0, 0 });
  points.emplace_back(0.5, 0, 1);  // 8, on the edge from 4 to 5
  points.emplace_back(0.25, 0, 1); // 9, between 4 and 8
  std::vector<std::vector<Index>> polygons = cubeSides(0);
  polygons[1] = { 4, 9, 8, 5, 7, 6 };
  polygons.push_back({ 4, 5, 8 });
  polygons.push_back({ 4, 8, 9 });
  const SurfaceInput input = makeInput(points, polygons);
  const PreparedSurface surface = prepare(input, 0.5);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.degenerateFaces, 2u);
  const TopologySummary summary = summarizeTopology(surface.mesh);
  EXPECT_EQ(summary.vertices, 10u);
  EXPECT_EQ(summary.boundaryLoops, 0u);
  EXPECT_EQ(summary.eulerCharacteristic, 2);
  // Products of halves and quarters; divided by six.
  EXPECT_NEAR(signedVolume(surface.mesh), 1, 1e-14);
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    EXPECT_FALSE(isDegenerate(surface.mesh, f));
  }
  // 12 edges, one of them in three pieces.
  EXPECT_EQ(featureHalfEdges(surface.mesh), 28u);
}

TEST(Repair, AnExplicitFeatureOnACapGoesToItsOtherEdges)
{
  SurfaceInput input =
    makeInput({ { 0, 0, 0 }, { 2, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 1, -1, 0 } },
      { { 0, 1, 2 }, { 0, 2, 3 }, { 2, 1, 3 }, { 1, 0, 4 } });
  input.featureEdges = { 1, 0, 0, 0 };
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.mesh.faceCount(), 4u);
  EXPECT_EQ(featureHalfEdges(surface.mesh), 4u);
}

TEST(Repair, ZeroLengthEdgesAreCollapsed)
{
  // A torus where one vertex was split in two at the same place: two faces without area.
  const Mesh mesh = torus(10, 8);
  SurfaceInput input = toInput(mesh);
  const Index v = mesh.origin[0];
  const Index copy = mesh.vertexCount();
  input.points.push_back(mesh.position[v]);
  Index h = 0;
  for (int i = 0; i < 3; ++i) // three neighbouring faces take the copy
  {
    input.polygonPoints.edit()[h] = copy;
    if (i < 2)
    {
      h = mesh.rotateCounterclockwise(h);
    }
  }
  const Index right = mesh.target(0);
  const Index left = mesh.origin[Mesh::previous(h)];
  input.polygonPoints.append({ v, right, copy, v, copy, left });
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  const PreparedSurface surface = prepare(input);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.degenerateFaces, 2u);
  EXPECT_EQ(surface.mesh.faceCount(), mesh.faceCount());
  EXPECT_EQ(surface.mesh.vertexCount(), mesh.vertexCount());
  EXPECT_EQ(summarizeTopology(surface.mesh).eulerCharacteristic, 0);
}

TEST(Repair, AnEdgeBetweenTwoPillarsIsNotDoubled)
{
  // Top and bottom layer are full, between them stand two pillars that touch along an edge. Apart, they
  // share its two ends, which lie in one fan each: the same two vertices would have two edges.
  const LatticeBuilder voxels =
    voxelSides({ 2, 2, 3 }, 1, [](int x, int y, int z) { return z != 1 || x != y; });
  std::vector<std::vector<Index>> polygons;
  for (const Triangle& t : voxels.triangles)
  {
    polygons.push_back({ t[0], t[1], t[2] });
  }
  const SurfaceInput input = makeInput(voxels.points, polygons);
  const PreparedSurface surface = prepare(input, 0.7);
  expectSound(surface, input);
  EXPECT_EQ(surface.repair.nonManifoldEdges, 1u);
  EXPECT_EQ(surface.repair.nonManifoldVertices, 0u);
  EXPECT_EQ(surface.mesh.faceCount(), polygons.size() + 2);
  const TopologySummary summary = summarizeTopology(surface.mesh);
  EXPECT_EQ(summary.boundaryLoops, 0u);
  EXPECT_EQ(summary.eulerCharacteristic, 0); // a ring: two layers, two pillars
  EXPECT_NEAR(signedVolume(surface.mesh), 10, 1e-13);
}

TEST(Repair, TextNamesWhatChanged)
{
  RepairReport report;
  EXPECT_EQ(report.text(), "");
  report.duplicateFaces = 12;
  report.nonManifoldEdges = 1;
  EXPECT_EQ(report.text(), "12 duplicate faces removed, 1 non-manifold edge split");
}

TEST(Repair, AFanOfAnyLengthTakesNoLongerThanItsFaces)
{
  // Half-edges round the tip ascend all the way; looking one way only, each would look at all that follow.
  constexpr Index kFaces = 200000;
  std::vector<Vector3> points{ Vector3(0, 0, 1) };
  std::vector<std::vector<Index>> polygons;
  for (Index i = 0; i < kFaces; ++i)
  {
    const double angle = 2 * kPi * i / kFaces;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    polygons.push_back({ 0, 1 + i, 1 + (i + 1) % kFaces });
  }
  const PreparedSurface surface = prepare(makeInput(points, polygons));
  EXPECT_EQ(surface.mesh.faceCount(), kFaces);
  EXPECT_EQ(surface.components, 1U);
}

} // namespace quadrille
