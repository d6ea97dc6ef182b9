// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Angles.h"
#include "Base/Error.h"
#include "Mesh/Sizing.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Sizes/AdaptiveSizing.h"
#include "Sizes/CurvatureGuides.h"
#include "Sizes/OppositeSheets.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

constexpr double kEdge = 0.2;

std::vector<PatchCurvature> curvaturesOf(const Mesh& mesh, double edge, int threads = 2)
{
  return patchCurvatures(mesh, findPatches(mesh, edge / 4, threads), edge / 2, threads);
}

TEST(Curvature, OfASphereIsThatOfItsRadius)
{
  for (const PatchCurvature& curvature : curvaturesOf(sphere(5), kEdge))
  {
    // Chords of triangles of 0.04: what is left is how unevenly edges lie in a disk of a few triangles.
    EXPECT_NEAR(curvature.largest, 1, 0.12);
    EXPECT_NEAR(curvature.smallest, 1, 0.12);
    EXPECT_LT(curvature.anisotropy(), 0.1);
  }
}

TEST(Curvature, OfACylinderIsRoundItsAxis)
{
  const Mesh mesh = openCylinder(120, 60);
  double radius = 0;
  for (const Vector3& p : mesh.position)
  {
    radius = std::max(radius, std::hypot(p.x(), p.y()));
  }
  const SurfacePatches patches = findPatches(mesh, 0.05 * radius, 2);
  const std::vector<PatchCurvature> curvatures = patchCurvatures(mesh, patches, 0.1 * radius, 2);
  for (std::size_t i = 0; i < curvatures.size(); ++i)
  {
    const Vector3& p = patches.patches[i].centre;
    EXPECT_NEAR(std::abs(curvatures[i].largest) * radius, 1, 0.05);
    EXPECT_NEAR(curvatures[i].smallest * radius, 0, 0.02);
    EXPECT_NEAR(
      std::abs(curvatures[i].direction.dot(Vector3(-p.y(), p.x(), 0).normalized())), 1, 1e-3);
  }
}

TEST(Curvature, OfAPlaneIsNoneAndItsBoundaryCounts)
{
  double most = 0;
  for (const PatchCurvature& curvature : curvaturesOf(gridPlane(20, 20), 4))
  {
    EXPECT_NEAR(curvature.largest, 0, 1e-12);
    most = std::max(most, curvature.curve);
  }
  EXPECT_NEAR(most, 0, 1e-12); // corners of the square are corners, and the sides are straight
}

TEST(Curvature, NoiseBelowTheDistanceHardlyCounts)
{
  Mesh mesh = sphere(6);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.001, 0.001);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + noise(random);
  }
  // From vertex to vertex, 0.02 apart, noise of that height makes curvatures of 5 and more.
  std::vector<double> values;
  for (const PatchCurvature& curvature : curvaturesOf(mesh, 0.4))
  {
    values.push_back(curvature.largest);
  }
  std::sort(values.begin(), values.end());
  EXPECT_NEAR(values[values.size() / 2], 1, 0.15);
  EXPECT_LT(values[values.size() * 95 / 100], 1.5);
}

TEST(AdaptiveSizing, ChordErrorOfASphereIsTheOneAskedFor)
{
  const double error = 0.001;
  const double wanted = std::sqrt(8 * error); // k = 1
  AdaptiveSizes sizes;
  sizes.chordError = error;
  for (const float length : adaptiveLengths(sphere(5), sizes, kEdge, 1, 2))
  {
    EXPECT_NEAR(length, wanted, 0.1 * wanted);
  }
}

/// An open cylinder of twelve sides, with what an exact one of radius 1 has there.
PreparedSurface knownCylinder()
{
  SurfaceInput input = toInput(openCylinder(12, 1));
  input.curvatures.assign(
    input.polygonOffsets.size() - 1, { kNoCurvature.points, { 1, 1, 1 }, { 1, 1, 1 } });
  return prepareSurface(input, {});
}

TEST(AdaptiveSizing, KnownCurvatureTakesThePlaceOfThatOfTriangles)
{
  PreparedSurface surface = knownCylinder();
  refineSurface(surface, 0.1, {}, 2);
  ASSERT_GT(surface.mesh.faceCount(), 500U);
  AdaptiveSizes sizes;
  sizes.chordError = 0.001;
  const CornerCurvatures known = cornerCurvatures(surface, 2);
  for (const float length : adaptiveLengths(surface.mesh, sizes, 0.1, 1, 2, known))
  {
    EXPECT_NEAR(length, std::sqrt(8 * 0.001), 1e-6);
  }
  // The triangles are flat over a few edges, and bend by 30 degrees between them.
  const std::vector<float> shown = adaptiveLengths(surface.mesh, sizes, 0.1, 1, 2);
  EXPECT_EQ(*std::max_element(shown.begin(), shown.end()), std::numeric_limits<float>::infinity());
  sizes = {};
  sizes.turn = 0.2;
  for (const float length : adaptiveLengths(surface.mesh, sizes, 0.1, 1, 2, known))
  {
    EXPECT_NEAR(length, 0.2, 1e-6);
  }
}

TEST(AdaptiveSizing, KnownCurvatureIsLinearAndThatOfSidesStaysThere)
{
  // A square of two triangles: curvature x on the surface, and of the side at y = 0 that of a circle of radius 1 / 3.
  SurfaceInput input = toInput(gridPlane(1, 1));
  for (Index f = 0; f < 2; ++f)
  {
    KnownCurvature known;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto corner = [&](std::size_t i)
      { return input.points[input.polygonPoints[3 * f + i]]; };
      known.atCorner[k] = static_cast<float>(corner(k).x());
      known.alongSide[k] = corner(k).y() == 0 && corner((k + 1) % 3).y() == 0 ? 3 : 0;
    }
    input.curvatures.push_back(known);
  }
  for (const FaceOrder order : { FaceOrder::AsGiven, FaceOrder::FromLowest, FaceOrder::Reversed })
  {
    input.faceOrder = order;
    PreparedSurface surface = prepareSurface(input, {});
    refineSurface(surface, 0.1, {}, 2);
    const Mesh& mesh = surface.mesh;
    const CornerCurvatures known = cornerCurvatures(surface, 2);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& a = mesh.position[mesh.origin[h]];
      EXPECT_NEAR(known.atCorner[h], a.x(), 1e-6);
      if (mesh.isBoundary(h))
      {
        EXPECT_EQ(known.along[h], a.y() == 0 && mesh.position[mesh.target(h)].y() == 0 ? 3 : 0);
      }
    }
    AdaptiveSizes sizes;
    sizes.turn = 1;
    const std::vector<float> lengths = adaptiveLengths(mesh, sizes, 0.1, 1, 2, known);
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      const Vector3& p = mesh.position[v];
      EXPECT_NEAR(1 / lengths[v], p.y() == 0 ? 3 : p.x(), 1e-5);
    }
  }
}

TEST(AdaptiveSizing, WhereNoCurvatureIsKnownTrianglesShowIt)
{
  SurfaceInput input = toInput(sphere(4));
  AdaptiveSizes sizes;
  sizes.chordError = 0.001;
  const PreparedSurface plain = prepareSurface(input, {});
  input.curvatures.assign(input.polygonOffsets.size() - 1, kNoCurvature);
  const PreparedSurface unknown = prepareSurface(input, {});
  EXPECT_EQ(adaptiveLengths(unknown.mesh, sizes, kEdge, 1, 2, cornerCurvatures(unknown, 2)),
    adaptiveLengths(plain.mesh, sizes, kEdge, 1, 2));
  input.curvatures.pop_back();
  EXPECT_THROW(prepareSurface(input, {}), InvalidInput);
}

TEST(AdaptiveSizing, GapsAreThicknessAndDistance)
{
  // A box of 1 by 1 by 0.2 from the unit cube.
  Mesh mesh = unitCube(20);
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() *= 0.2;
  }
  mesh = markFeatures(mesh, 0.6);
  AdaptiveSizes sizes;
  sizes.gapQuads = 4;
  const std::vector<float> lengths = adaptiveLengths(mesh, sizes, 0.2, 0.625, 2); // within 0.5
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool flat = std::abs(faceNormal(mesh, Mesh::face(h)).z()) > 0.5;
    if (flat)
    {
      EXPECT_NEAR(lengths[mesh.origin[h]], 0.05, 1e-6);
    }
  }
  // The sides are 1 apart, beyond the reach; vertices that they share with the flat faces have their length.
  const auto far =
    std::count(lengths.begin(), lengths.end(), std::numeric_limits<float>::infinity());
  EXPECT_GT(far, 0);
  for (const float length : adaptiveLengths(mesh, sizes, 0.2, 0.125, 2))
  {
    EXPECT_EQ(length, std::numeric_limits<float>::infinity());
  }
}

TEST(AdaptiveSizing, OppositeSheetsAreAlsoThoseOutside)
{
  // Two unit cubes, 0.3 apart along x.
  const Mesh one = unitCube(10);
  std::vector<Vector3> points = one.position;
  std::vector<Triangle> triangles;
  for (Index f = 0; f < one.faceCount(); ++f)
  {
    const Index n = one.vertexCount();
    triangles.push_back({ one.origin[3 * f], one.origin[3 * f + 1], one.origin[3 * f + 2] });
    triangles.push_back(
      { n + one.origin[3 * f], n + one.origin[3 * f + 1], n + one.origin[3 * f + 2] });
  }
  for (const Vector3& p : one.position)
  {
    points.push_back(p + Vector3(1.3, 0, 0));
  }
  const Mesh mesh = markFeatures(makeMesh(points, triangles), 0.6);
  const SurfacePatches patches = findPatches(mesh, 0.1, 2);
  const std::vector<float> distances = distancesToOpposite(mesh, patches, 0.5, 2);
  std::size_t gap = 0;
  for (std::size_t i = 0; i < distances.size(); ++i)
  {
    const SurfacePatch& patch = patches.patches[i];
    const bool facesTheOther =
      std::abs(patch.normal.x()) > 0.5 && std::abs(patch.centre.x() - 1.15) < 0.2;
    gap += facesTheOther ? 1 : 0;
    if (facesTheOther)
    {
      EXPECT_NEAR(distances[i], 0.3, 1e-6);
    }
    else
    {
      EXPECT_EQ(distances[i], std::numeric_limits<float>::infinity());
    }
  }
  EXPECT_GT(gap, 0U);
}

TEST(AdaptiveSizing, ResultsDoNotDependOnTheNumberOfThreads)
{
  const Mesh mesh = torus(90, 45);
  AdaptiveSizes sizes;
  sizes.chordError = 0.002;
  sizes.gapQuads = 6;
  const std::vector<float> one = adaptiveLengths(mesh, sizes, 0.1, 5, 1);
  for (const int threads : { 2, 5 })
  {
    EXPECT_EQ(adaptiveLengths(mesh, sizes, 0.1, 5, threads), one);
  }
}

TEST(AdaptiveSizing, TheSmallestWinsWithinTheRange)
{
  Mesh mesh = gridPlane(2, 1);
  AdaptiveSizes sizes;
  sizes.smallest = 0.25;
  sizes.largest = 2;
  const float none = std::numeric_limits<float>::infinity();
  const std::vector<float> lengths{ 1, 6, 0.1F, none, 30, 8 };
  setAdaptiveSizes(mesh, {}, lengths, sizes, 10);
  EXPECT_EQ(mesh.sizing, (std::vector<float>{ 0.25F, 0.6F, 0.25F, 2, 2, 0.8F }));
  setAdaptiveSizes(mesh, { 0.5F, 0.5F, 0.1F, 3, 1, 1 }, lengths, sizes, 10);
  EXPECT_EQ(mesh.sizing, (std::vector<float>{ 0.25F, 0.5F, 0.1F, 2, 1, 0.8F }));
}

TEST(AdaptiveSizing, TheEdgeLengthMakesAsManyQuads)
{
  Mesh mesh = gridPlane(30, 30);
  AdaptiveSizes sizes;
  std::vector<float> lengths;
  for (const Vector3& p : mesh.position)
  {
    lengths.push_back(static_cast<float>(0.5 + 0.1 * p.x()));
  }
  for (const double quads : { 200.0, 1000.0, 4000.0 })
  {
    const DistributedSizes shared = distributeSizes(mesh, {}, lengths, sizes, quads);
    const double s = shared.edgeLength;
    std::vector<float> multiplied = lengths;
    for (float& length : multiplied)
    {
      length = static_cast<float>(shared.lengthFactor * length);
    }
    setAdaptiveSizes(mesh, {}, multiplied, sizes, s);
    // The sum over vertices against the integral over triangles, on which sizes are linear.
    EXPECT_NEAR(sizedArea(mesh) / (s * s), quads, 0.03 * quads);
    // With 200 quads edges are 2 long on average, and lengths of 0.5 to 3.5 would ask for 500: they get longer.
    EXPECT_EQ(shared.lengthFactor > 1.2, quads == 200);
    const auto [least, most] = std::minmax_element(mesh.sizing.begin(), mesh.sizing.end());
    EXPECT_GE(*most / *least, quads == 200 ? 3.0F : 1.0F);
  }
}

TEST(AdaptiveSizing, RefusesWhatIsOutOfRange)
{
  const auto refused = [](const AdaptiveSizes& sizes)
  { EXPECT_THROW(checkAdaptiveSizes(sizes), InvalidInput); };
  AdaptiveSizes sizes;
  checkAdaptiveSizes(sizes);
  sizes.chordError = 0;
  refused(sizes);
  sizes = {};
  sizes.turn = 4;
  refused(sizes);
  sizes = {};
  sizes.gapQuads = -1;
  refused(sizes);
  sizes = {};
  sizes.smallest = 1.5;
  refused(sizes);
  sizes = {};
  sizes.largest = 0.5;
  refused(sizes);
  EXPECT_THROW(findPatches(sphere(2), 0, 1), InvalidInput);
}

TEST(CurvatureGuides, GoRoundACylinderAndLeaveASphereFree)
{
  PreparedSurface cylinder = prepareSurface(toInput(openCylinder(80, 50)), {});
  const Vector3 given(0, 0, 1);
  cylinder.polygonGuides.push_back({ 7, given, 1.0F });
  EXPECT_EQ(addCurvatureGuides(cylinder, 0.3, 0.3, 2), cylinder.mesh.faceCount() - 1U);
  ASSERT_EQ(cylinder.polygonGuides.size(), cylinder.mesh.faceCount());
  EXPECT_TRUE(std::is_sorted(cylinder.polygonGuides.begin(), cylinder.polygonGuides.end(),
    [](const PolygonGuide& a, const PolygonGuide& b) { return a.polygon < b.polygon; }));
  for (const PolygonGuide& guide : cylinder.polygonGuides)
  {
    EXPECT_NEAR(std::abs(guide.direction.z()), guide.polygon == 7 ? 1 : 0, 1e-3);
    EXPECT_GT(guide.weight, 0.8F);
  }
  PreparedSurface ball = prepareSurface(toInput(sphere(5)), {});
  EXPECT_EQ(addCurvatureGuides(ball, 0.3, 0.3, 2), 0U);
}

} // namespace
} // namespace quadrille
