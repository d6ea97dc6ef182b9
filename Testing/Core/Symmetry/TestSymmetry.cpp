// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Prepare.h"
#include "Symmetry/Symmetry.h"

#include "Evaluation/QuadQuality.h"
#include "Mesh/Distance.h"
#include "MeshInput.h"
#include "SymmetricQuads.h"
#include "Symmetry/PartRequests.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

void expectSymmetric(
  const SymmetricResult& made, const SurfaceInput& input, long long euler, bool closed)
{
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneOnEdges(made);
  expectExactImages(made);
  expectSources(made, input);
  expectWhole(made, euler, closed);
}

TEST(Symmetry, SphereAboutAGivenPlane)
{
  const SurfaceInput input = toInput(sphere(4));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(600), about(Vector3::Zero(), Vector3(0, 0, 3)));
  expectSymmetric(made, input, 2, true);
  // The number asked for is that of the whole.
  EXPECT_NEAR(static_cast<double>(made.remeshed.quads.quads.size()), 600, 150);
  EXPECT_EQ(made.remeshed.quads.quads.size() % 2, 0U);
}

TEST(Symmetry, APlaneThatCutsTrianglesAnywhere)
{
  // No vertex lies in the plane, and triangles behind it are no images of those in front.
  const SurfaceInput input = toInput(torus(50, 27));
  const SymmetricResult made = remeshSymmetric(
    input, aboutQuads(800), about(Vector3::Zero(), Vector3(std::cos(0.3), std::sin(0.3), 0)));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneOnEdges(made);
  expectSources(made, input, kRoundingOfSingle);
  expectWhole(made, 0, true);
  // The facets of 50 sides differ from their images by less than the sagitta of a side.
  EXPECT_GT(made.movedPoints, 0U);
  EXPECT_LE(made.farthestMoved, 1.4 * (1 - std::cos(kPi / 27)));
}

TEST(Symmetry, TorusAboutBothKindsOfPlanes)
{
  const SurfaceInput input = toInput(torus(60, 30));
  for (const Vector3& normal : { Vector3(0, 0, 1), Vector3(1, 0, 0) })
  {
    SCOPED_TRACE(normal.transpose());
    const SymmetricResult made =
      remeshSymmetric(input, aboutQuads(800), about(Vector3::Zero(), normal));
    expectSymmetric(made, input, 0, true);
    EXPECT_EQ(made.remeshed.smallParts.handles, 1U);
  }
}

double lengthOfLines(const QuadMesh& quads)
{
  double length = 0;
  for (const QuadLine& line : quads.lines)
  {
    length += (quads.points[line.a] - quads.points[line.b]).norm();
  }
  return length;
}

TEST(Symmetry, BoxKeepsItsFeatures)
{
  const SurfaceInput input = toInput(unitCube(6));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(300), about(Vector3(0.5, 0.5, 0.5), Vector3(0, 1, 0)));
  expectSymmetric(made, input, 2, true);
  const QuadMesh& quads = made.remeshed.quads;
  EXPECT_TRUE(std::none_of(
    quads.lines.begin(), quads.lines.end(), [](const QuadLine& line) { return line.boundary; }));
  EXPECT_NEAR(lengthOfLines(quads), 12, 1e-9); // the edges of the box
  for (const Vector3& p : input.points)
  {
    const bool isCorner = ((p - Vector3::Constant(0.5)).cwiseAbs().array() > 0.49).all();
    const auto same = [&](const Vector3& q) { return (p - q).norm() < 1e-12; };
    EXPECT_TRUE(!isCorner || std::any_of(quads.points.begin(), quads.points.end(), same));
  }
}

TEST(Symmetry, ClearedFeaturesOfTheOtherSideAreMirrored)
{
  // One edge in front of the plane, one behind it, and one that crosses it.
  SurfaceInput input = toInput(unitCube(6));
  input.drawn.cleared = { { 0.5, 1, 1 }, { 0.5, 0, 0 }, { 1, 0.7, 1 } };
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(300), about(Vector3(0.5, 0.5, 0.5), Vector3(0, 1, 0)));
  expectSymmetric(made, input, 2, true);
  EXPECT_NEAR(lengthOfLines(made.remeshed.quads), 7, 0.01); // with the images of the first two
}

TEST(Symmetry, ARidgeInThePlaneStaysAFeature)
{
  // Two of the box's edges lie in the plane through opposite edges.
  const SurfaceInput input = toInput(unitCube(6));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(300), about(Vector3(0.5, 0.5, 0.5), Vector3(1, -1, 0)));
  expectSymmetric(made, input, 2, true);
  EXPECT_NEAR(lengthOfLines(made.remeshed.quads), 12, 1e-9);
}

TEST(Symmetry, OpenSurfaces)
{
  const SurfaceInput cylinder = toInput(openCylinder(48, 20));
  expectSymmetric(remeshSymmetric(cylinder, aboutQuads(500), about({ 0, 0, 0 }, { 1, 0, 0 })),
    cylinder, 0, false);
  const SurfaceInput plate = toInput(plateWithHole(4));
  expectSymmetric(
    remeshSymmetric(plate, aboutQuads(300), about({ 6, 6, 0 }, { 0, 1, 0 })), plate, 0, false);
}

TEST(Symmetry, TwoMirroredComponents)
{
  const SurfaceInput input =
    toInput(disjointUnion(lopsidedEllipsoid(3), lopsidedEllipsoid(3), Vector3(4, 0, 0)));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(600), about({ 2, 0, 0 }, { 1, 0, 0 }));
  expectSymmetric(made, input, 4, true);
  for (Index p = 0; p < made.mirrorPoint.size(); ++p)
  {
    EXPECT_NE(made.mirrorPoint[p], p);
  }
}

TEST(Symmetry, PlaneIsFoundOfATurnedShape)
{
  const Vector3 axis(1, 2, -0.5);
  const Vector3 shift(10, -4, 3);
  const SurfaceInput input = toInput(turned(lopsidedEllipsoid(4), axis, 0.7, shift));
  const SymmetricResult made = remeshSymmetric(input, aboutQuads(600), {});
  const Vector3 normal = Eigen::AngleAxisd(0.7, axis.normalized()) * Vector3::UnitX();
  // Point and normal as accurate as the coordinates.
  EXPECT_LE(made.plane.normal.cross(normal).norm(), 1e-12);
  EXPECT_LE(std::abs(made.plane.height(shift)), 1e-12 * made.diagonal);
  EXPECT_LE(made.deviation.maximum, 1e-12 * made.diagonal);
  expectSymmetric(made, input, 2, true);
}

TEST(Symmetry, PlaneIsFoundWhereMomentsAreEqual)
{
  // A box's three planes, and its diagonals; any plane through the axis of a torus, and the one across it.
  for (const Mesh& mesh : { unitCube(4), torus(40, 20), sphere(3) })
  {
    const SurfaceInput input = toInput(turned(mesh, Vector3(3, 1, 2), 0.4, Vector3(1, 2, 3)));
    const SymmetricResult made = remeshSymmetric(input, aboutQuads(400), {});
    // A sphere of 642 points is its own image but for the sagitta of its triangles.
    EXPECT_LE(made.deviation.maximum, 0.005);
    EXPECT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  }
}

TEST(Symmetry, NearlySymmetricSurfaceIsFollowed)
{
  const double noise = 0.005;
  const SurfaceInput input = toInput(withNoise(lopsidedEllipsoid(4), noise));
  RemeshOptions options = aboutQuads(600);
  options.featureAngle.reset();
  const SymmetricResult made = remeshSymmetric(input, options, {});
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneOnEdges(made);
  expectSources(made, input);
  EXPECT_GT(made.movedPoints, 0U);
  // Both sides are off by the noise at most, in each of three coordinates.
  EXPECT_LE(made.farthestMoved, 2 * std::sqrt(3.0) * noise + 1e-3);
  EXPECT_LE(made.deviation.maximum, 2 * std::sqrt(3.0) * noise + 1e-3);
  EXPECT_LT(made.plane.normal.cross(Vector3::UnitX()).norm(), 0.01);
  const QuadQuality quality = evaluateQuads(made.remeshed.quads.points, made.remeshed.quads.quads);
  EXPECT_TRUE(quality.manifold && quality.closed);
  EXPECT_EQ(quality.nonPositiveJacobians, 0U);
}

TEST(Symmetry, SameForAnyThreadsAndWithAStore)
{
  const SurfaceInput input = toInput(withNoise(lopsidedEllipsoid(3), 0.01));
  RemeshOptions options = aboutQuads(300);
  options.featureAngle.reset();
  options.mergeCharts = true;
  const SymmetricResult first = remeshSymmetric(input, options, {});
  ResultStore store;
  remeshSymmetric(input, options, {}, &store);
  options.threads = 1;
  const SymmetricResult again = remeshSymmetric(input, options, {}, &store);
  ASSERT_TRUE(first.remeshed.status.ok());
  EXPECT_EQ(again.remeshed.quads.quads, first.remeshed.quads.quads);
  EXPECT_EQ(again.remeshed.quads.points, first.remeshed.quads.points);
  EXPECT_EQ(again.mirrorPoint, first.mirrorPoint);
  EXPECT_TRUE(again.remeshed.uv == first.remeshed.uv);
  const std::vector<std::string>& reused = again.remeshed.reused;
  for (const char* stage : { "whole", "plane", "phase1", "extract" })
  {
    EXPECT_NE(std::find(reused.begin(), reused.end(), stage), reused.end()) << stage;
  }
}

TEST(Symmetry, ValencesOfTheOtherSideAreMirrored)
{
  SurfaceInput input = toInput(lopsidedEllipsoid(4));
  input.targetValences.assign(input.points.size(), 0);
  const Index behind = nearestPoint(input.points, Vector3(-0.7, 0.6, 0.6));
  const Index inPlane = nearestPoint(input.points, Vector3(0, -1.6, 0));
  input.targetValences[behind] = 5;
  input.targetValences[inPlane] = 6;
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(800), about({ 0, 0, 0 }, { 1, 0, 0 }));
  expectSymmetric(made, input, 2, true);
  const QuadMesh& quads = made.remeshed.quads;
  const MirrorPlane& plane = made.plane;
  for (const Vector3& place : { input.points[behind], plane.image(input.points[behind]) })
  {
    const Index p = nearestPoint(quads.points, place);
    EXPECT_LE((quads.points[p] - place).norm(), 1e-12 * made.diagonal);
    EXPECT_EQ(quads.valence[p], 5);
  }
  const Index p = nearestPoint(quads.points, input.points[inPlane]);
  EXPECT_EQ(made.mirrorPoint[p], p);
  EXPECT_EQ(quads.valence[p], 6);
}

/// Places lie inside of faces that are larger than quads; the line crosses the plane.
TEST(Symmetry, WhatIsDrawnIsMirrored)
{
  SurfaceInput input = toInput(unitCube(3));
  const Vector3 behind(0.21, 0.33, 1);
  input.drawn.valences = { { behind, 5 }, { { 0.4, 0.6, 0 }, 5 } };
  input.drawn.features = { { { { 0.25, 0.1, 0 }, { 0.7, 0.27, 0 } } } };
  input.drawn.sizes = { { { 0, 0.5, 0.5 }, 0.15, 0.5, 0 } };
  RemeshOptions options = aboutQuads(1500);
  options.featureAngle.reset();
  const SymmetricResult made = remeshSymmetric(input, options, about({ 0.5, 0, 0 }, { 1, 0, 0 }));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  const QuadMesh& quads = made.remeshed.quads;
  for (const Vector3& place : { behind, made.plane.image(behind) })
  {
    const Index p = nearestPoint(quads.points, place);
    EXPECT_LE((quads.points[p] - place).norm(), 1e-8); // the grid of a run's frame
    EXPECT_EQ(quads.valence[p], 5);
  }
  // Both pieces of the line and their images are edges: points of quads lie along them.
  for (const double share : { 0.2, 0.4, 0.7, 0.9 })
  {
    const Vector3 on = Vector3(0.25, 0.1, 0) + share * Vector3(0.45, 0.17, 0);
    for (const Vector3& p : { on, made.plane.image(on) })
    {
      double least = 1;
      for (const std::array<Index, 4>& quad : quads.quads)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          least = std::min(
            least, distanceToSegment(p, quads.points[quad[i]], quads.points[quad[(i + 1) % 4]]));
        }
      }
      EXPECT_LT(least, 0.05 * made.remeshed.targetEdgeLength);
    }
  }
  const auto sizeNear = [&](const Vector3& place)
  {
    double area = 0, count = 0;
    for (const std::array<Index, 4>& quad : quads.quads)
    {
      if ((quads.points[quad[0]] - place).norm() < 0.1)
      {
        area += 0.5 *
          (quads.points[quad[2]] - quads.points[quad[0]])
            .cross(quads.points[quad[3]] - quads.points[quad[1]])
            .norm();
        count += 1;
      }
    }
    return std::sqrt(area / count);
  };
  EXPECT_NEAR(sizeNear({ 0, 0.5, 0.5 }), sizeNear({ 1, 0.5, 0.5 }), 1e-9);
  EXPECT_LT(sizeNear({ 0, 0.5, 0.5 }), 0.75 * sizeNear({ 0.5, 0.9, 1 }));
}

TEST(Symmetry, ContradictionsAreTold)
{
  SurfaceInput input = toInput(lopsidedEllipsoid(4));
  input.targetValences.assign(input.points.size(), 0);
  const Index front = nearestPoint(input.points, Vector3(0.7, 0.6, 0.6));
  const Index behind = nearestPoint(input.points, Vector3(-0.7, 0.6, 0.6));
  const Index inPlane = nearestPoint(input.points, Vector3(0, -1.6, 0));
  input.targetValences[front] = 3;
  input.targetValences[behind] = 5;
  input.targetValences[inPlane] = 5;
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(800), about({ 0, 0, 0 }, { 1, 0, 0 }));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_TRUE(hasNotice(made, "point " + std::to_string(behind)));
  EXPECT_TRUE(hasNotice(made, "the one in front of the mirror plane is followed"));
  EXPECT_TRUE(hasNotice(made, "point " + std::to_string(inPlane)));
  const QuadMesh& quads = made.remeshed.quads;
  EXPECT_EQ(quads.valence[nearestPoint(quads.points, input.points[behind])], 3);
}

TEST(Symmetry, GuidesOfTheOtherSideAreMirrored)
{
  // Helices of 45 degrees on a quarter of the torus behind the plane: without them quads follow the circles.
  const Mesh mesh = torus(96, 48);
  SurfaceInput input = toInput(mesh);
  const auto guidedBy = [](const Vector3& p, double margin)
  { return p.x() < -0.2 - margin && p.z() > margin; };
  const auto helix = [](const Vector3& p)
  {
    const Vector3 around = Vector3(-p.y(), p.x(), 0).normalized();
    const Vector3 out = (p - Vector3(p.x(), p.y(), 0).normalized()).normalized();
    return Vector3((around + out.cross(around)).normalized());
  };
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 centre =
      (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
        mesh.position[mesh.origin[3 * f + 2]]) /
      3;
    input.guideDirections.push_back(guidedBy(centre, 0) ? helix(centre) : Vector3(0, 0, 0));
  }
  const MirrorPlane plane{ Vector3::Zero(), Vector3::UnitX() };
  const PreparedSurface prepared = prepareSurface(input, {});
  const SearchedSurface whole(prepared);
  SurfacePart half = cutByPlane(prepared.mesh, plane, 1e-9);
  const Isometry mirror = Isometry::of(plane);
  const std::vector<std::string> notices = askOfPart({ whole, mirror, 0, 1e-9, 1e-9, 2 }, half);
  EXPECT_TRUE(notices.empty());
  std::size_t count = 0;
  for (std::size_t t = 0; t < half.face.size(); ++t)
  {
    const Vector3 centre = (half.input.points[half.input.polygonPoints[3 * t]] +
                             half.input.points[half.input.polygonPoints[3 * t + 1]] +
                             half.input.points[half.input.polygonPoints[3 * t + 2]]) /
      3;
    const Vector3& direction = half.input.guideDirections[t];
    // On the borders, where faces are not exact images, either may be.
    if (guidedBy(plane.image(centre), 0.05))
    {
      ++count;
      // Directions were put into the plane of the face, which is off by the angle of a facet.
      EXPECT_GT(std::abs(direction.dot(plane.imageOf(helix(plane.image(centre))))), 0.99);
    }
    else if (!guidedBy(plane.image(centre), -0.05))
    {
      EXPECT_EQ(direction, Vector3(0, 0, 0));
    }
  }
  EXPECT_GT(count, 500U);
}

TEST(Symmetry, SizesOfTheOtherSideAreMirrored)
{
  SurfaceInput input = toInput(lopsidedEllipsoid(4));
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back(p.x() < -0.5 ? 0.5F : 1.0F);
  }
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(800), about({ 0, 0, 0 }, { 1, 0, 0 }));
  expectSymmetric(made, input, 2, true);
  const QuadMesh& quads = made.remeshed.quads;
  double small = 0, large = 0;
  std::size_t smallCount = 0, largeCount = 0;
  for (const Quad& quad : quads.quads)
  {
    const Vector3& a = quads.points[quad[0]];
    const double length = (quads.points[quad[1]] - a).norm();
    const bool isSmall = a.x() > 0.7;
    const bool isLarge = std::abs(a.x()) < 0.2;
    small += isSmall ? length : 0;
    smallCount += isSmall ? 1 : 0;
    large += isLarge ? length : 0;
    largeCount += isLarge ? 1 : 0;
  }
  EXPECT_LT(
    small / static_cast<double>(smallCount), 0.75 * large / static_cast<double>(largeCount));
}

std::string reasonOf(const SurfaceInput& input, const SymmetryOptions& symmetry)
{
  try
  {
    remeshSymmetric(input, aboutQuads(100), symmetry);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return "";
}

TEST(Symmetry, RefusesWhatIsNoPlane)
{
  const SurfaceInput input = toInput(sphere(2));
  EXPECT_NE(reasonOf(input, about({ 0, 0, 0 }, { 0, 0, 0 })).find("normal"), std::string::npos);
  EXPECT_NE(reasonOf(input, about({ 0, NAN, 0 }, { 0, 0, 1 })).find("origin"), std::string::npos);
  EXPECT_NE(
    reasonOf(input, about({ 0, 0, 1 }, { 0, 0, 1 })).find("not symmetric"), std::string::npos);
  EXPECT_NE(
    reasonOf(input, about({ 0, 0, 0.5 }, { 0, 0, 1 })).find("not symmetric"), std::string::npos);
  EXPECT_NE(reasonOf({}, about({ 0, 0, 0 }, { 0, 0, 1 })), "");
  // Its image is the plate itself.
  EXPECT_NE(reasonOf(toInput(gridPlane(4, 4)), about({ 0, 0, 0 }, { 0, 0, 1 })).find("in front of"),
    std::string::npos);
}

TEST(Symmetry, ATubeThatIsOneQuadWideGetsMore)
{
  // Half of it is 0.16 wide, as long as a quad asked for: an edge across would be its own image.
  const SurfaceInput input = toInput(torus(160, 24, 1, 0.05));
  RemeshOptions options = aboutQuads(80);
  options.smallDetails = SmallDetails::Keep;
  const SymmetricResult made = remeshSymmetric(input, options, about({ 0, 0, 0 }, { 0, 0, 1 }));
  expectSymmetric(made, input, 0, true);
  EXPECT_GT(made.remeshed.quads.quads.size(), 130U);
  EXPECT_TRUE(hasNotice(made, "one quad wide"));
}

TEST(Symmetry, ATubeThatStaysOneQuadWideIsToldOnce)
{
  RemeshOptions options = aboutQuads(80);
  options.smallDetails = SmallDetails::Keep;
  const SymmetricResult made =
    remeshSymmetric(toInput(torus(160, 12, 1, 0.012)), options, about({ 0, 0, 0 }, { 0, 0, 1 }));
  EXPECT_NE(made.remeshed.status.message.find("one quad wide"), std::string::npos)
    << made.remeshed.status.message;
  EXPECT_FALSE(hasNotice(made, "one quad wide"));
}

TEST(Symmetry, CurvesOfTheOtherSideAreMirrored)
{
  SurfaceInput input = toInput(torus(60, 30));
  CurveRequest behind{ CurveKind::Cycle, {} };
  CurveRequest across{ CurveKind::Cycle, {} };
  for (int i = 0; i < 24; ++i)
  {
    const double angle = i * kPi / 12;
    const double radius = 1 + 0.4 * std::cos(angle);
    behind.points.emplace_back(-radius, 0, 0.4 * std::sin(angle));
    across.points.emplace_back(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0);
  }
  input.curves = { across, behind };
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(800), about({ 0, 0, 0 }, { 1, 0, 0 }));
  expectSymmetric(made, input, 0, true);
  ASSERT_EQ(made.remeshed.curves.size(), 2U);
  EXPECT_FALSE(made.remeshed.curves[0].met);
  EXPECT_NE(made.remeshed.curves[0].why.find("crosses the mirror plane"), std::string::npos);
  EXPECT_TRUE(made.remeshed.curves[1].met) << made.remeshed.curves[1].why;
  EXPECT_LT(made.remeshed.curves[1].start.x(), 0);
}

TEST(Symmetry, StopsOnRequest)
{
  RemeshOptions options = aboutQuads(300);
  options.progress = [](double fraction, const std::string&) { return fraction < 0.05; };
  const SymmetricResult made = remeshSymmetric(toInput(sphere(4)), options, {});
  EXPECT_EQ(made.remeshed.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(made.remeshed.quads.quads.empty());
}

} // namespace
} // namespace quadrille
