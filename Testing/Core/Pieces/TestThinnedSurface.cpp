// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/ThinnedSurface.h"

#include "Base/Error.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/ConstraintWords.h"
#include "MeshInput.h"
#include "Pieces/RemeshInPieces.h"
#include "PiecesChecks.h"
#include "Prepare/ConstraintPlacement.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

TEST(ThinnedSurface, TorusHasItsQuadsOnTheInput)
{
  const SurfaceInput input = toInput(torus(160, 80, 2, 1));
  const PiecesResult made = remeshThinned(input, askForQuads(500));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_LT(made.joinedTriangles, input.polygonOffsets.size() - 1);
  EXPECT_TRUE(made.remeshed.certificate.valid());
  EXPECT_EQ(made.remeshed.certificate.triangles, made.remeshed.surface.mesh.faceCount());
  EXPECT_NEAR(static_cast<double>(made.remeshed.quads.quads.size()), 500, 100);
  expectPlacesOfSources(made, input);
}

TEST(ThinnedSurface, TheSameForAnyNumberOfThreads)
{
  const SurfaceInput input = toInput(torus(160, 80, 2, 1));
  const PiecesResult one = remeshThinned(input, askForQuads(400, 1));
  const PiecesResult four = remeshThinned(input, askForQuads(400, 4));
  ASSERT_TRUE(one.remeshed.status.ok()) << one.remeshed.status.message;
  EXPECT_EQ(one.remeshed.quads.quads, four.remeshed.quads.quads);
  EXPECT_EQ(one.remeshed.quads.points, four.remeshed.quads.points);
  for (std::size_t v = 0; v < one.pointSource.size(); ++v)
  {
    EXPECT_EQ(one.pointSource[v].polygon, four.pointSource[v].polygon);
    EXPECT_EQ(one.pointSource[v].weights, four.pointSource[v].weights);
  }
}

/// As remesh() does: the run has coordinates of its own.
TEST(ThinnedSurface, AShiftedMirrorImageHasTheSameQuads)
{
  SurfaceInput input = toInput(torus(160, 80, 2, 1));
  for (Vector3& p : input.points.editAll())
  {
    p = p.cast<float>().cast<double>();
  }
  SurfaceInput image = input;
  for (Vector3& p : image.points.editAll())
  {
    p = Vector3(64 - p.x(), p.y(), p.z());
  }
  const PiecesResult made = remeshThinned(input, askForQuads(400));
  const PiecesResult mirrored = remeshThinned(image, askForQuads(400));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  ASSERT_EQ(mirrored.remeshed.quads.points.size(), made.remeshed.quads.points.size());
  for (std::size_t v = 0; v < made.pointSource.size(); ++v)
  {
    const Vector3& p = mirrored.remeshed.quads.points[v];
    EXPECT_LT((Vector3(64 - p.x(), p.y(), p.z()) - made.remeshed.quads.points[v]).norm(), 1e-9);
  }
  expectPlacesOfSources(mirrored, image);
}

TEST(ThinnedSurface, HandlesBelowAQuadAreCutFirst)
{
  const Vector3 place = Vector3(1, 0.2, 0.3).normalized();
  SurfaceInput input = toInput(sphereWithHandle(5, place).mesh);
  for (Vector3& p : input.points.editAll())
  {
    p = 3 * p + Vector3(10, 20, 30);
  }
  const PiecesResult made = remeshThinned(input, askForQuads(80));
  const RemeshResult& remeshed = made.remeshed;
  ASSERT_TRUE(remeshed.status.ok()) << remeshed.status.message;
  EXPECT_EQ(remeshed.quads.points.size(), remeshed.quads.quads.size() + 2); // a sphere
  ASSERT_EQ(remeshed.details.size(), 1U);
  EXPECT_EQ(remeshed.details.front().decision, DetailDecision::Simplify);
  EXPECT_LT((remeshed.details.front().place - Vector3(10, 20, 30) - 3 * place).norm(), 0.6);
  ASSERT_FALSE(remeshed.notices.empty());
  EXPECT_NE(remeshed.notices.front().find("1 handle was cut and closed"), std::string::npos);
  for (const Vector3& p : remeshed.quads.points)
  {
    EXPECT_NEAR((p - Vector3(10, 20, 30)).norm(), 3, 0.03);
  }
}

TEST(ThinnedSurface, EdgesOfACubeStaySharp)
{
  const PiecesResult made = remeshThinned(toInput(unitCube(40)), askForQuads(600));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  // Each edge of the cube is a line of the quads.
  const QuadMesh& quads = made.remeshed.quads;
  double length = 0;
  for (const QuadLine& line : quads.lines)
  {
    length += (quads.points[line.a] - quads.points[line.b]).norm();
  }
  EXPECT_NEAR(length, 12, 1e-6);
}

TEST(ThinnedSurface, AnOpenSurfaceKeepsItsBoundary)
{
  const SurfaceInput input = toInput(gridPlane(90, 90));
  const PiecesResult made = remeshThinned(input, askForQuads(300));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  double length = 0;
  for (const QuadLine& line : made.remeshed.quads.lines)
  {
    length += (made.remeshed.quads.points[line.a] - made.remeshed.quads.points[line.b]).norm();
  }
  const auto byX = [](const Vector3& a, const Vector3& b) { return a.x() < b.x(); };
  const double width = std::max_element(input.points.begin(), input.points.end(), byX)->x() -
    std::min_element(input.points.begin(), input.points.end(), byX)->x();
  EXPECT_NEAR(length, 4 * width, 1e-6 * width);
  expectPlacesOfSources(made, input);
}

/// Two components and points that no polygon uses: what repair drops and orders is told in terms of the input.
TEST(ThinnedSurface, SourcesAreThoseOfTheInput)
{
  SurfaceInput input = toInput(torus(120, 60, 2, 1));
  input.points.change(
    [](std::vector<Vector3>& points) { points.insert(points.begin(), Vector3(100, 100, 100)); });
  for (Index& id : input.polygonPoints.editAll())
  {
    ++id;
  }
  const Index second = static_cast<Index>(input.points.size());
  const SurfaceInput other = toInput(torus(120, 60, 2, 1));
  for (const Vector3& p : other.points)
  {
    input.points.push_back(p + Vector3(10, 0, 0));
  }
  for (const Index id : other.polygonPoints)
  {
    input.polygonPoints.push_back(second + id);
    if (input.polygonPoints.size() % 3 == 0)
    {
      input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    }
  }
  const PiecesResult made = remeshThinned(input, askForQuads(800));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectPlacesOfSources(made, input);
}

/// A torus round z on which something is asked for, by arrays and drawn.
struct AskedTorus
{
  SurfaceInput input = toInput(torus(160, 80, 2, 0.8));
  AskedConstraints asked;

  /// The point at these angles.
  static Vector3 at(double around, double across)
  {
    const double r = 2 + 0.8 * std::cos(across);
    return { r * std::cos(around), r * std::sin(around), 0.8 * std::sin(across) };
  }

  std::vector<Vector3> ring(double across, double from, double to) const
  {
    std::vector<Vector3> points;
    for (double around = from; around < to + 1e-9; around += (to - from) / 20)
    {
      points.push_back(at(around, across));
    }
    return points;
  }

  template <class Draw>
  void draw(const Draw& add)
  {
    const SurfacePlaces places(input);
    const SurfacePaths paths(input);
    ConstraintPlacement placement(input, places, paths);
    add(placement);
    placement.addTo(input);
    asked.placed = placement.result().placed;
  }

  /// Whether each of the constraints is met.
  std::vector<bool> met(const RemeshResult& made)
  {
    asked.curves = made.curves;
    asked.edgeLength =
      lengthOfSizeOne(made.targetEdgeLength, made.targetQuads, made.quads.quads.size());
    std::vector<bool> met;
    for (const ConstraintWord& word : judgeConstraints(asked, made.quads, {}))
    {
      met.push_back(word.isMet);
      EXPECT_TRUE(word.isMet) << word.kind << " " << word.deviation << " " << word.reason;
    }
    return met;
  }
};

/// Every constraint gets the word that it gets on the whole surface, and points lie on the input.
void expectSameWords(AskedTorus torus, std::size_t quads, std::size_t words)
{
  const RemeshResult whole = remesh(torus.input, askForQuads(quads));
  const PiecesResult made = remeshThinned(torus.input, askForQuads(quads));
  ASSERT_TRUE(whole.status.ok()) << whole.status.message;
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_LT(made.joinedTriangles, torus.input.polygonOffsets.size() / 2);
  const std::vector<bool> met = torus.met(made.remeshed);
  EXPECT_EQ(met.size(), words);
  EXPECT_EQ(met, torus.met(whole));
  expectPlacesOfSources(made, torus.input);
}

TEST(ThinnedSurface, DrawnFeaturesAreFollowed)
{
  AskedTorus torus;
  torus.draw(
    [&](ConstraintPlacement& placement)
    {
      placement.addFeature({ 0, torus.ring(0.7, 0, 1.5) });
      placement.addSize(1, AskedTorus::at(5, 0), 0.5, 0.7);
    });
  expectSameWords(torus, 300, 2);
}

TEST(ThinnedSurface, ClearedFeaturesAreNone)
{
  SurfaceInput input = toInput(unitCube(40));
  input.drawn.cleared = { { 0.5, 0, 1 } };
  const PiecesResult made = remeshThinned(input, askForQuads(600));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  const QuadMesh& quads = made.remeshed.quads;
  double length = 0;
  for (const QuadLine& line : quads.lines)
  {
    length += (quads.points[line.a] - quads.points[line.b]).norm();
  }
  EXPECT_NEAR(length, 11, 0.01);
}

TEST(ThinnedSurface, ValencesStay)
{
  AskedTorus torus;
  torus.input.targetValences.assign(torus.input.points.size(), 0);
  torus.input.targetValences[1234] = 3;
  torus.input.targetValences[7000] = 4;
  torus.asked.arrays = arrayConstraints(torus.input);
  torus.draw([&](ConstraintPlacement& placement)
    { placement.addValence(0, AskedTorus::at(2.713, 1.277), 5); });
  expectSameWords(torus, 300, 3);
}

TEST(ThinnedSurface, ConnectionsJoinTheirEnds)
{
  AskedTorus torus;
  torus.draw(
    [&](ConstraintPlacement& placement)
    {
      placement.addValence(0, AskedTorus::at(0.5, 1), 3);
      placement.addValence(1, AskedTorus::at(1.6, 1), 5);
      placement.addCurve(2, CurveKind::Connection, torus.ring(1, 0.5, 1.6));
    });
  expectSameWords(torus, 300, 3);
}

TEST(ThinnedSurface, CyclesAreClosed)
{
  AskedTorus torus;
  torus.draw(
    [&](ConstraintPlacement& placement)
    {
      std::vector<Vector3> ring = torus.ring(1, 0, 6.1);
      placement.addCurve(0, CurveKind::Cycle, std::move(ring));
    });
  expectSameWords(torus, 300, 1);
}

/// A preview makes as many quads as the run, at its intermediate level.
TEST(ThinnedSurface, APreviewIsThatOfTheRun)
{
  const SurfaceInput input = toInput(torus(160, 80, 2, 1));
  RemeshOptions options = askForQuads(400);
  const PiecesResult made = remeshThinned(input, options);
  options.preview = true;
  const PiecesResult preview = remeshThinned(input, options);
  ASSERT_TRUE(preview.remeshed.status.ok()) << preview.remeshed.status.message;
  EXPECT_EQ(preview.remeshed.quads.quads.size(), made.remeshed.quads.quads.size());
  EXPECT_TRUE(preview.pointSource.empty());
}

/// Triangles of the thinned surface know a polygon on their side of each border.
TEST(ThinnedSurface, PolygonsBesideKeepToTheirPatch)
{
  SurfaceInput input = toInput(unitCube(40));
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  for (std::size_t f = 0; f < polygons; ++f)
  {
    const Vector3 middle =
      (input.points[input.polygonPoints[3 * f]] + input.points[input.polygonPoints[3 * f + 1]] +
        input.points[input.polygonPoints[3 * f + 2]]) /
      3;
    input.patchIds.push_back(middle.x() > 0.5 ? 7 : 3);
  }
  RemeshOptions options = askForQuads(300);
  options.featureAngle.reset();
  const PiecesResult made = remeshThinned(input, options);
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  ASSERT_EQ(made.polygonBeside.size(), made.joinedTriangles);
  const PreparedSurface& surface = made.remeshed.surface;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    Vector3 middle = Vector3::Zero();
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      middle += surface.mesh.position[surface.mesh.origin[h]] / 3;
    }
    EXPECT_EQ(
      input.patchIds[made.polygonBeside[surface.sourcePolygon[f]]], middle.x() > 0.5 ? 7 : 3);
  }
}

/// A component without a map is left out, and told by all its polygons of the input.
TEST(ThinnedSurface, WhatIsLeftOutIsToldByPolygonsOfTheInput)
{
  SurfaceInput input = toInput(disjointUnion(sphere(5), sphere(3), Vector3(3, 0, 0)));
  const std::size_t fine = toInput(sphere(5)).polygonOffsets.size() - 1;
  input.featureEdges.assign(fine, 0);
  const std::vector<std::uint8_t> tree = spanningTree(sphere(3));
  input.featureEdges.insert(input.featureEdges.end(), tree.begin(), tree.end());
  RemeshOptions options = askForQuads(40);
  EXPECT_FALSE(remeshThinned(input, options).remeshed.status.ok());
  options.leavesOutFailed = true;
  const PiecesResult made = remeshThinned(input, options);
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_LT(made.joinedTriangles, fine);
  const FailedParts& failed = made.remeshed.failed;
  EXPECT_EQ(failed.components, 1U);
  ASSERT_EQ(failed.polygons.size(), input.polygonOffsets.size() - 1 - fine);
  EXPECT_EQ(failed.polygons.front(), fine);
  expectPlacesOfSources(made, input);
}

TEST(ThinnedSurface, RefusesWhatNeedsTheWholeSurface)
{
  SurfaceInput held = toInput(sphere(4));
  held.held.emplace_back();
  EXPECT_THROW(remeshThinned(held, askForQuads(100)), InvalidInput);
  SurfaceInput guided = toInput(sphere(4));
  guided.guideDirections.assign(guided.polygonOffsets.size() - 1, Vector3::UnitX());
  EXPECT_THROW(remeshThinned(guided, askForQuads(100)), InvalidInput);
  SurfaceInput broken = toInput(sphere(4));
  broken.polygonPoints.edit()[300] = 123456;
  EXPECT_THROW(remeshThinned(broken, askForQuads(100)), InvalidInput);
}

TEST(ThinnedSurface, StopsOnRequest)
{
  const SurfaceInput input = toInput(torus(160, 80, 2, 1));
  for (const double at : { 0.0, 0.2, 0.5, 0.7 })
  {
    RemeshOptions options = askForQuads(500);
    bool hasAsked = false;
    options.progress = [&](double fraction, const std::string&)
    {
      hasAsked = hasAsked || fraction >= at;
      return !hasAsked;
    };
    const PiecesResult made = remeshThinned(input, options);
    EXPECT_EQ(made.remeshed.status.code, StatusCode::Cancelled) << at;
    EXPECT_TRUE(made.remeshed.quads.quads.empty());
  }
}

} // namespace
} // namespace quadrille
