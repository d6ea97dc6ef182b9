// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Base/Angles.h"
#include "Extraction/Extraction.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadSmoothing.h"
#include "Quads/SurfaceWalk.h"

#include <gtest/gtest.h>

namespace quadrille::test
{
namespace
{

QuadMesh extractRaw(const GridMapCase& c)
{
  ExtractionOptions options;
  options.smoothingSteps = 0;
  ExtractionResult result = extractQuads(c.mesh, c.uv, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return result.mesh;
}

std::array<Vector3, 4> cornersOf(const QuadMesh& mesh, std::size_t q)
{
  const auto& c = mesh.quads[q];
  return { mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]], mesh.points[c[3]] };
}

/// All points may move, so that there is something to see.
SmoothingResult smooth(const GridMapCase& c, QuadMesh& mesh, int steps, int threads)
{
  SmoothingOptions options;
  options.steps = steps;
  options.threads = threads;
  options.goodShape = 1;
  return smoothQuads(c.mesh, mesh, options);
}

double worstShape(const QuadMesh& mesh)
{
  double worst = 1;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
  {
    worst = std::min(worst, scaledJacobian(cornersOf(mesh, q)));
  }
  return worst;
}

double meanShape(const QuadMesh& mesh)
{
  double sum = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
  {
    sum += scaledJacobian(cornersOf(mesh, q));
  }
  return sum / static_cast<double>(mesh.quads.size());
}

} // namespace

TEST(QuadMoves, PointsOfACurveDoNotPassEachOther)
{
  const GridMapCase c = squares("plane", gridPlane(6, 6), 1);
  QuadMesh mesh = extractRaw(c);
  const QuadMoves moves(c.mesh, mesh, {});
  std::size_t sliding = 0;
  for (Index p = 0; p < mesh.points.size(); ++p)
  {
    if (moves.freedom(p) != QuadMoves::Freedom::Curve)
    {
      continue;
    }
    ++sliding;
    const bool isBelow = mesh.points[p].y() < 1e-9 || mesh.points[p].y() > 6 - 1e-9;
    const Vector3 along = isBelow ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    for (const double way : { -1.5, -0.9, 0.9, 1.5 }) // edge lengths
    {
      const std::optional<SurfacePoint> place = moves.target(p, way * along);
      ASSERT_EQ(place.has_value(), std::abs(way) < 1) << way;
      if (place)
      {
        EXPECT_LT((positionOf(c.mesh, *place) - mesh.points[p] - way * along).norm(), 1e-12);
      }
    }
  }
  EXPECT_EQ(sliding, 20U);
}

TEST(QuadSmoothing, RaisesShapesAndStaysOnTheSurface)
{
  const GridMapCase c = crumpledPlane(12, 9, 1);
  QuadMesh mesh = extractRaw(c);
  const double worst = worstShape(mesh);
  const double mean = meanShape(mesh);
  ASSERT_LT(mean, 0.95); // else there is nothing to do
  const SmoothingResult result = smooth(c, mesh, 10, 1);
  EXPECT_GT(result.moves, 0u);
  EXPECT_GE(worstShape(mesh), worst);
  EXPECT_GT(meanShape(mesh), mean + 0.5 * (1 - mean)); // a flat plate allows squares
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    const SurfacePoint place{ mesh.sourceFace[i], mesh.sourceWeights[i] };
    EXPECT_NEAR((positionOf(c.mesh, place) - mesh.points[i]).norm(), 0, 1e-12);
    EXPECT_EQ(mesh.points[i].z(), 0);
    for (const double w : place.weights)
    {
      EXPECT_GE(w, 0);
      EXPECT_LE(w, 1);
    }
  }
}

TEST(QuadSmoothing, BoundarySlidesAndCornersStay)
{
  const GridMapCase c = crumpledPlane(6, 5, 2);
  QuadMesh mesh = extractRaw(c);
  const QuadMesh before = mesh;
  smooth(c, mesh, 10, 1);
  int corners = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    const Vector3& p = mesh.points[i];
    if (mesh.onBoundary[i])
    {
      EXPECT_TRUE(p.x() == 0 || p.x() == 12 || p.y() == 0 || p.y() == 10) << p.transpose();
    }
    if (mesh.onBoundary[i] && mesh.valence[i] == 2)
    {
      EXPECT_EQ(p, before.points[i]);
      ++corners;
    }
  }
  EXPECT_EQ(corners, 4);
}

// A plate with a bend between two points of the quads, as arcs of small holes have them: one slides to it.
TEST(QuadSmoothing, PointsOfACurveSlideToItsBends)
{
  GridMapCase c = crumpledPlane(6, 5, 2, 0);
  const double angle = 25 * kPi / 180;
  for (Index v = 0; v < c.mesh.vertexCount(); ++v)
  {
    Vector3& p = c.mesh.position.edit()[v];
    const double beyond = std::max(p.x() - 5, 0.0);
    p = Vector3(std::min(p.x(), 5.0) + std::cos(angle) * beyond, p.y(), std::sin(angle) * beyond);
  }
  QuadMesh mesh = extractRaw(c);
  const auto distanceOfBends = [&]()
  {
    double most = 0;
    for (const double y : { 0.0, 10.0 })
    {
      const Vector3 bend(5, y, 0);
      double least = 10;
      for (const QuadLine& line : mesh.lines)
      {
        const Vector3 a = mesh.points[line.a];
        const Vector3 edge = mesh.points[line.b] - a;
        const double part = std::clamp((bend - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (bend - a - part * edge).norm());
      }
      most = std::max(most, least);
    }
    return most;
  };
  ASSERT_GT(distanceOfBends(), 0.2);
  const SmoothingResult result = smoothQuads(c.mesh, mesh, {});
  EXPECT_GT(result.moves, 0u);
  EXPECT_LT(distanceOfBends(), 0.16);
  EXPECT_GT(worstShape(mesh), 0.3);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    const SurfacePoint place{ mesh.sourceFace[i], mesh.sourceWeights[i] };
    EXPECT_NEAR((positionOf(c.mesh, place) - mesh.points[i]).norm(), 0, 1e-12);
    EXPECT_TRUE(!mesh.onBoundary[i] || meshCorner(mesh, static_cast<Index>(i)) ||
      locateOnCurve(c.mesh, place));
  }
}

// A plate whose quads run aslant in the middle, as a guide has them: smoothing for the sake of shape alone turns them
// back.
TEST(QuadSmoothing, GuidedPointsKeepTheirDirection)
{
  GridMapCase c = crumpledPlane(12, 12, 2, 0);
  constexpr double kSlope = 0.5, kGuided = 7;
  const auto fromCentre = [](const Vector3& p) { return (p - Vector3(12, 12, 0)).norm(); };
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = c.mesh.position[c.mesh.origin[h]];
    const double part = std::clamp((11 - fromCentre(p)) / (11 - kGuided), 0.0, 1.0);
    c.uv[h] = toFixed(Vector2(p.x() / 2, p.y() / 2 - part * kSlope * (p.x() - 12) / 2));
  }
  const Vector3 along = Vector3(1, kSlope, 0).normalized();
  SmoothingOptions options;
  options.steps = 10;
  options.goodShape = 1;
  const auto turned = [&](bool guided)
  {
    options.guides.clear();
    for (Index f = 0; guided && f < c.mesh.faceCount(); ++f)
    {
      if (fromCentre(c.mesh.middleOfFace(f)) < kGuided)
      {
        options.guides.push_back({ f, { along, 1 } });
      }
    }
    QuadMesh mesh = extractRaw(c);
    EXPECT_GT(smoothQuads(c.mesh, mesh, options).moves, 0u);
    double most = 0; // of the edges that should run along it, well inside
    for (const std::array<Index, 4>& quad : mesh.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Vector3& a = mesh.points[quad[i]];
        const Vector3& b = mesh.points[quad[(i + 1) % 4]];
        const double angle = angleBetween(b - a, (b - a).dot(along) < 0 ? -along : along);
        if (fromCentre((a + b) / 2) < 4 && angle < kPi / 4)
        {
          most = std::max(most, angle);
        }
      }
    }
    return most;
  };
  EXPECT_GT(turned(false), radians(5));
  EXPECT_LT(turned(true), radians(1));
}

TEST(QuadSmoothing, FeaturesOfABlockStay)
{
  GridMapCase c = squares("block", markFeatures(doubleTorus(2), 0.7), 3);
  Random random(5);
  MapEditor editor(c);
  editor.refine(random, 3000, false);
  editor.shuffleCharts(random);
  QuadMesh mesh = extractRaw(c);
  const QuadMesh before = mesh;
  const double worst = worstShape(mesh);
  smooth(c, mesh, 5, 1);
  EXPECT_GE(worstShape(mesh), worst);
  std::vector<int> lines(mesh.points.size(), 0);
  for (const QuadLine& line : mesh.lines)
  {
    ++lines[line.a];
    ++lines[line.b];
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    if (lines[i] != 0 && lines[i] != 2)
    {
      EXPECT_EQ(mesh.points[i], before.points[i]);
    }
    if (lines[i] != 0)
    {
      // Still on an edge or a vertex of the mesh, one that is constrained.
      const SurfacePoint place{ mesh.sourceFace[i], mesh.sourceWeights[i] };
      EXPECT_TRUE(locateOnCurve(c.mesh, place) || mesh.points[i] == before.points[i]);
    }
  }
}

TEST(QuadSmoothing, SameBytesForAnyNumberOfThreads)
{
  GridMapCase c = squares("", markFeatures(tripod(3), 0.7), 6);
  Random random(6);
  MapEditor editor(c);
  editor.refine(random, 5000);
  const QuadMesh raw = extractRaw(c);
  QuadMesh one = raw;
  QuadMesh three = raw;
  smooth(c, one, 3, 1);
  smooth(c, three, 3, 3);
  EXPECT_NE(one.points, raw.points);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.sourceFace, three.sourceFace);
  EXPECT_EQ(one.sourceWeights, three.sourceWeights);
}

TEST(QuadSmoothing, ZeroStepsAndBadSteps)
{
  const GridMapCase c = squares("", unitCube(1), 3);
  QuadMesh mesh = extractRaw(c);
  const QuadMesh before = mesh;
  EXPECT_EQ(smooth(c, mesh, 0, 1).moves, 0u);
  EXPECT_EQ(mesh.points, before.points);
  EXPECT_THROW(smooth(c, mesh, -1, 1), InvalidInput);
}

TEST(QuadSmoothing, LeavesGoodQuadsAlone)
{
  const GridMapCase c = crumpledPlane(12, 9, 3);
  const QuadMesh raw = extractRaw(c);
  QuadMesh mesh = raw;
  SmoothingOptions options;
  options.goodShape = 0.7;
  smoothQuads(c.mesh, mesh, options);
  std::vector<double> worst(mesh.points.size(), 1);
  for (std::size_t q = 0; q < raw.quads.size(); ++q)
  {
    for (const Index p : raw.quads[q])
    {
      worst[p] = std::min(worst[p], scaledJacobian(cornersOf(raw, q)));
    }
  }
  int moved = 0;
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
  {
    moved += mesh.points[p] != raw.points[p] ? 1 : 0;
    // A move round a point never makes its quads worse, so who starts above the threshold stays.
    EXPECT_TRUE(worst[p] <= 0.7 || mesh.points[p] == raw.points[p]);
  }
  EXPECT_GT(moved, 0);
}

// Straight over a flat mesh is straight in the plane.
TEST(SurfaceWalk, StraightOverAPlane)
{
  const Mesh mesh = gridPlane(10, 10);
  Random random(9);
  for (int i = 0; i < 200; ++i)
  {
    const SurfacePoint from{ static_cast<Index>(pick(random, 200)), { 0.2, 0.3, 0.5 } };
    const Vector3 start = positionOf(mesh, from);
    const Vector3 d(pick(random, 100) * 0.05 - 2.5, pick(random, 100) * 0.05 - 2.5, 0);
    const Vector3 end = start + d;
    const bool inside = end.x() > 0 && end.y() > 0 && end.x() < 10 && end.y() < 10;
    const auto to = walkSurface(mesh, from, d);
    ASSERT_EQ(to.has_value(), inside);
    if (to)
    {
      EXPECT_NEAR((positionOf(mesh, *to) - end).norm(), 0, 1e-12); // rounding over < 20 faces
    }
  }
}

// Round a cylinder along a circle one comes back.
TEST(SurfaceWalk, RoundACylinder)
{
  const Mesh mesh = openCylinder(12, 4);
  const double side = 2 * std::sin(kPi / 12);
  const SurfacePoint from{ 2 * 12, { 0.5, 0.25, 0.25 } };
  const Vector3 along = mesh.edgeVector(3 * from.face).normalized();
  const auto to = walkSurface(mesh, from, 12 * side * along);
  ASSERT_TRUE(to);
  EXPECT_NEAR((positionOf(mesh, *to) - positionOf(mesh, from)).norm(), 0, 1e-12);
}

TEST(SurfaceWalk, CurvesStopAtForksAndEnds)
{
  const Mesh cylinder = openCylinder(12, 4);
  Index h = 0;
  while (!cylinder.isBoundary(h))
  {
    ++h;
  }
  const double side = cylinder.edgeVector(h).norm();
  for (const double sign : { 1.0, -1.0 })
  {
    const auto round = walkCurve(cylinder, { h, 0.25 }, sign * 12 * side);
    ASSERT_TRUE(round);
    const Vector3 start = positionOf(cylinder, CurvePoint{ h, 0.25 }.onSurface());
    EXPECT_NEAR((positionOf(cylinder, round->onSurface()) - start).norm(), 0, 1e-12);
    EXPECT_FALSE(walkCurve(cylinder, { h, 0.25 }, sign * kInfinity));
  }
  // Three features meet in the corner of a cube.
  const Mesh cube = markFeatures(unitCube(2), 0.7);
  for (Index g = 0; g < cube.halfEdgeCount(); ++g)
  {
    if (cube.isFeature(g))
    {
      EXPECT_FALSE(walkCurve(cube, { g, 0.5 }, 1.1));
      EXPECT_FALSE(walkCurve(cube, { g, 0.5 }, -1.1));
    }
  }
}

} // namespace quadrille::test
