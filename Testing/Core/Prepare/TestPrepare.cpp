// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInputs.h"

#include <cstring>

namespace quadrille
{

namespace
{

using namespace test;

template <typename Array>
bool sameBytes(const Array& a, const Array& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void expectSameBytes(const PreparedSurface& a, const PreparedSurface& b)
{
  EXPECT_TRUE(sameBytes(a.mesh.position, b.mesh.position));
  EXPECT_TRUE(sameBytes(a.mesh.origin, b.mesh.origin));
  EXPECT_TRUE(sameBytes(a.mesh.twin, b.mesh.twin));
  EXPECT_TRUE(sameBytes(a.mesh.flags, b.mesh.flags));
  EXPECT_TRUE(sameBytes(a.sourcePolygon, b.sourcePolygon));
  EXPECT_TRUE(sameBytes(a.sourcePoints, b.sourcePoints));
  EXPECT_EQ(a.hash, b.hash);
}

std::vector<Mesh> cleanMeshes()
{
  return { gridPlane(6, 4), plateWithHole(3), plateL(3), unitCube(4), sphere(3), torus(12, 7),
    doubleTorus(2), openCylinder(9, 4), twoComponents() };
}

} // namespace

TEST(Prepare, CleanMeshesKeepTheirTopologyAndNothingIsReported)
{
  for (const Mesh& mesh : cleanMeshes())
  {
    const SurfaceInput input = toInput(mesh);
    const PreparedSurface surface = prepare(input);
    expectSound(surface, input);
    EXPECT_EQ(surface.repair.text(), "");
    const TopologySummary before = summarizeTopology(mesh);
    const TopologySummary after = summarizeTopology(surface.mesh);
    EXPECT_EQ(after.faces, before.faces);
    EXPECT_EQ(after.vertices, before.vertices);
    EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
    EXPECT_EQ(after.boundaryLoops, before.boundaryLoops);
    EXPECT_EQ(after.components, before.components);
    // The sum of the same areas in another order.
    EXPECT_NEAR(surface.area, area(mesh), 1e-12 * surface.area);
  }
}

TEST(Prepare, SameBytesForAnyNumberOfThreads)
{
  const Mesh mesh = disjointUnion(sphere(6), torus(200, 150), { 3, 0, 0 });
  for (const SurfaceInput& input :
    { toInput(mesh), toSoup(mesh), withRandomOrientation(toInput(mesh)) })
  {
    expectSameBytes(prepare(input, 0.5, 1), prepare(input, 0.5, 3));
  }
}

TEST(Prepare, SoupAndRandomOrientationGiveBackTheMesh)
{
  for (const Mesh& mesh : cleanMeshes())
  {
    const TopologySummary before = summarizeTopology(mesh);
    for (const SurfaceInput& input : { toSoup(mesh), withRandomOrientation(toInput(mesh)) })
    {
      const PreparedSurface surface = prepare(input);
      expectSound(surface, input);
      EXPECT_NE(surface.repair.text(), "");
      const TopologySummary after = summarizeTopology(surface.mesh);
      EXPECT_EQ(after.vertices, before.vertices);
      EXPECT_EQ(after.faces, before.faces);
      EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
      EXPECT_EQ(after.boundaryLoops, before.boundaryLoops);
    }
  }
}

TEST(Prepare, SoupCountsTheMergedPoints)
{
  const Mesh mesh = sphere(2);
  EXPECT_EQ(prepare(toSoup(mesh)).repair.mergedPoints, mesh.halfEdgeCount() - mesh.vertexCount());
}

TEST(Prepare, ClosedComponentsThatAreInsideOutStayInsideOut)
{
  SurfaceInput input = toInput(unitCube(2));
  for (std::size_t i = 0; i < input.polygonPoints.size(); i += 3)
  {
    std::swap(input.polygonPoints.edit()[i], input.polygonPoints.edit()[i + 1]);
  }
  const PreparedSurface surface = prepare(input);
  EXPECT_EQ(surface.repair.reorientedFaces, 0u);
  // Sums of products of coordinates 0, 1/2 and 1, exact in binary but for the division by six.
  EXPECT_NEAR(signedVolume(surface.mesh), -1, 1e-14);
}

TEST(Prepare, MostFacesDecideTheOrientation)
{
  SurfaceInput input = toInput(sphere(2));
  std::swap(input.polygonPoints.edit()[31], input.polygonPoints.edit()[32]);
  std::swap(input.polygonPoints.edit()[61], input.polygonPoints.edit()[62]);
  const PreparedSurface surface = prepare(input);
  EXPECT_EQ(surface.repair.reorientedFaces, 2u);
  EXPECT_GT(signedVolume(surface.mesh), 0);
  expectSound(surface, input);
}

TEST(Prepare, HashTellsPositionsConnectivityAndFeaturesApart)
{
  SurfaceInput input = toInput(unitCube(3));
  const std::uint64_t hash = prepare(input).hash;
  EXPECT_EQ(prepare(input).hash, hash);
  EXPECT_NE(prepare(input, 1.0).hash, hash);

  SurfaceInput moved = input;
  moved.points.edit()[5].x() = std::nextafter(moved.points[5].x(), 2.0);
  EXPECT_NE(prepare(moved).hash, hash);

  SurfaceInput smaller = input;
  smaller.polygonPoints.resize(smaller.polygonPoints.size() - 3);
  smaller.polygonOffsets.pop_back();
  EXPECT_NE(prepare(smaller).hash, hash);
}

TEST(Prepare, FeaturesByAngle)
{
  const PreparedSurface cube = prepare(toInput(unitCube(4)), kPi / 4);
  EXPECT_EQ(featureHalfEdges(cube.mesh), 12 * 4 * 2u);
  // The angle between neighbouring sides is exactly a right one.
  const PreparedSurface none = prepare(toInput(unitCube(4)), 1.6);
  EXPECT_EQ(featureHalfEdges(none.mesh), 0u);
}

TEST(Prepare, FeaturesByPatchAndByBits)
{
  SurfaceInput input = toInput(gridPlane(4, 4));
  input.patchIds.assign(32, -5);
  std::fill(input.patchIds.begin() + 16, input.patchIds.end(), std::int64_t{ 1 } << 40);
  const PreparedSurface byPatch = prepare(input);
  // The line between the second and the third row has four edges.
  EXPECT_EQ(featureHalfEdges(byPatch.mesh), 4 * 2u);

  input.patchIds.clear();
  input.featureEdges.assign(32, 0);
  input.featureEdges[0] = 4; // the diagonal of the first cell: from corner 2 to corner 0
  const PreparedSurface byBit = prepare(input);
  expectSound(byBit, input);
  ASSERT_EQ(featureHalfEdges(byBit.mesh), 2u);
  Index h = 0;
  while (!byBit.mesh.isFeature(h))
  {
    ++h;
  }
  const Vector3 middle =
    (byBit.mesh.position[byBit.mesh.origin[h]] + byBit.mesh.position[byBit.mesh.target(h)]) / 2;
  EXPECT_EQ(middle, Vector3(0.5, 0.5, 0));
}

TEST(Prepare, SliversMakeNoFeaturesOfTheirOwn)
{
  // Two flat triangles with a sliver between them, whose apex is off the plane by less than floats
  // resolve but makes its normal point sideways.
  const double off = 1e-9;
  const SurfaceInput input =
    makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1e-12, off }, { 0.5, 1, 0 }, { 0.5, -1, 0 } },
      { { 0, 1, 2 }, { 0, 2, 3 }, { 2, 1, 3 }, { 1, 0, 4 } });
  const PreparedSurface surface = prepare(input, 0.5);
  expectSound(surface, input);
  EXPECT_EQ(featureHalfEdges(surface.mesh), 0u);
}

TEST(Prepare, InvalidInputIsNamed)
{
  const SurfaceInput good = toInput(unitCube(1));
  const auto messageFor = [&good](const std::function<void(SurfaceInput&)>& damage)
  {
    SurfaceInput input = good;
    damage(input);
    return messageOf([&] { prepare(input); });
  };
  EXPECT_EQ(messageFor([](SurfaceInput&) {}), "");
  EXPECT_TRUE(test::contains(messageFor([](SurfaceInput& in) { in = SurfaceInput(); }), "empty"));
  EXPECT_TRUE(test::contains(messageFor([](SurfaceInput& in) { in.points.clear(); }), "empty"));
  EXPECT_TRUE(test::contains(
    messageFor([](SurfaceInput& in) { in.points.edit()[6].y() = NAN; }), "point 6 "));
  EXPECT_TRUE(test::contains(
    messageFor([](SurfaceInput& in) { in.points.edit()[3].z() = -INFINITY; }), "point 3 "));
  EXPECT_TRUE(test::contains(messageFor([](SurfaceInput& in) { in.polygonPoints.edit()[10] = 99; }),
    "polygon 3 uses point 99"));
  EXPECT_TRUE(test::contains(
    messageFor([](SurfaceInput& in) { in.polygonOffsets.edit()[2] = 12; }), "polygon 2"));
  EXPECT_TRUE(test::contains(messageFor(
                               [](SurfaceInput& in)
                               {
                                 in.polygonOffsets.pop_back();
                                 in.polygonOffsets.push_back(30);
                               }),
    "offsets"));
  EXPECT_TRUE(test::contains(messageFor([](SurfaceInput& in) { in.patchIds.resize(3); }), "patch"));
  EXPECT_TRUE(
    test::contains(messageFor([](SurfaceInput& in) { in.featureEdges.resize(3); }), "feature"));
  EXPECT_TRUE(test::contains(messageFor(
                               [](SurfaceInput& in)
                               {
                                 for (Vector3& p : in.points.editAll())
                                 {
                                   p.setZero();
                                 }
                               }),
    "no face is left"));
}

TEST(Prepare, CancelStops)
{
  PrepareOptions options;
  int calls = 0;
  options.progress = [&calls](double, const std::string&) { return ++calls < 3; };
  EXPECT_THROW(prepareSurface(toInput(sphere(1)), options), Cancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Prepare, SubStagesAreTimed)
{
  const PreparedSurface surface = prepare(toInput(sphere(1)));
  ASSERT_EQ(surface.seconds.size(), 3u);
  EXPECT_EQ(surface.seconds[0].first, "repair");
  EXPECT_EQ(surface.seconds[1].first, "order");
  EXPECT_EQ(surface.seconds[2].first, "connectivity");
}

} // namespace quadrille
