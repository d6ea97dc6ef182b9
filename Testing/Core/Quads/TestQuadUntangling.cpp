// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Extraction/Extraction.h"
#include "Mesh/Surface.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadUntangling.h"
#include "Quads/SurfaceWalk.h"

#include <gtest/gtest.h>

#include <numeric>

namespace quadrille::test
{
namespace
{

QuadMesh rawQuads(const GridMapCase& c)
{
  ExtractionOptions options;
  options.smoothingSteps = 0;
  ExtractionResult result = extractQuads(c.mesh, c.uv, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return result.mesh;
}

/// As thin as the wedges near a tip: long quads whose Jacobians are small even where their shape is as good as can be.
GridMapCase thinCrumpledPlane(unsigned seed, double thickness)
{
  GridMapCase c = crumpledPlane(12, 9, seed, 40000);
  for (Vector3& p : c.mesh.position.editAll())
  {
    p.y() *= thickness;
  }
  return c;
}

std::size_t invertedCount(const QuadMesh& mesh)
{
  return invertedQuads(mesh.points, mesh.quads).size();
}

void expectSamePlaces(const QuadMesh& a, const QuadMesh& b)
{
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.sourceFace, b.sourceFace);
  EXPECT_EQ(a.sourceWeights, b.sourceWeights);
}

/// One quad on two triangles, with a reflex corner that nothing but the surface's own corner can be.
struct Dart
{
  Mesh mesh = makeMesh(
    { { 0, 0, 0 }, { 2, 0, 0 }, { 0.5, 0.5, 0 }, { 0, 2, 0 } }, { { 0, 1, 2 }, { 0, 2, 3 } });
  QuadMesh quads;

  Dart()
  {
    quads.points = mesh.position;
    quads.quads = { { 0, 1, 2, 3 } };
    quads.sourceFace = { 0, 0, 0, 1 };
    for (Index p = 0; p < 4; ++p)
    {
      quads.sourceWeights.emplace_back();
      for (Index i = 0; i < 3; ++i)
      {
        quads.sourceWeights[p][i] = mesh.origin[3 * quads.sourceFace[p] + i] == p ? 1 : 0;
      }
    }
    quads.quadSourceFace = { 0 };
    quads.quadSourceWeights = { { 0.25, 0.25, 0.5 } };
    quads.valence = { 2, 2, 2, 2 };
    quads.onBoundary = { 1, 1, 1, 1 };
    for (Index p = 0; p < 4; ++p)
    {
      QuadLine line;
      line.a = p;
      line.b = (p + 1) % 4;
      line.boundary = true;
      quads.lines.push_back(line);
    }
  }
};

/// Nine quads on a square with sides of 24, at vertices of the mesh. A sharp edge ends in a point of them at (x, 8),
/// and the next point stands such that quads beside it are inverted or nearly so.
struct FadingEdge
{
  static constexpr Index kSide = 24, kEnd = 5;
  Mesh mesh;
  QuadMesh quads;

  FadingEdge(Index endX, std::array<Index, 2> next)
  {
    const auto at = [](Index x, Index y) { return y * (kSide + 1) + x; };
    std::vector<Vector3> points;
    std::vector<std::array<Index, 3>> triangles;
    for (Index y = 0; y <= kSide; ++y)
    {
      for (Index x = 0; x <= kSide; ++x)
      {
        points.emplace_back(x, y, 0);
        if (x < kSide && y < kSide)
        {
          triangles.push_back({ at(x, y), at(x + 1, y), at(x + 1, y + 1) });
          triangles.push_back({ at(x, y), at(x + 1, y + 1), at(x, y + 1) });
        }
      }
    }
    mesh = makeMesh(points, triangles);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3 middle = (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2;
      if (middle.y() == 8 && mesh.edgeVector(h).y() == 0 && middle.x() < endX)
      {
        mesh.flags.edit()[h] = kFeatureEdge;
      }
    }
    std::vector<Index> vertices;
    for (Index i = 0; i < 16; ++i)
    {
      vertices.push_back(at(i % 4 * 8, i / 4 * 8));
    }
    vertices[kEnd] = at(endX, 8);
    vertices[kEnd + 1] = at(next[0], next[1]);
    for (Index i = 0; i < 16; ++i)
    {
      quads.points.push_back(mesh.position[vertices[i]]);
      const auto h = static_cast<Index>(
        std::find(mesh.origin.begin(), mesh.origin.end(), vertices[i]) - mesh.origin.begin());
      quads.sourceFace.push_back(Mesh::face(h));
      quads.sourceWeights.push_back(cornerWeight(h));
      const bool onBoundary = i % 4 == 0 || i % 4 == 3 || i / 4 == 0 || i / 4 == 3;
      quads.onBoundary.push_back(onBoundary ? 1 : 0);
      quads.valence.push_back(onBoundary ? 3 : 4);
      if (i % 4 < 3 && i / 4 < 3)
      {
        quads.quads.push_back({ i, i + 1, i + 5, i + 4 });
        quads.quadSourceFace.push_back(quads.sourceFace.back());
        quads.quadSourceWeights.push_back({});
      }
    }
    QuadLine line;
    line.a = kEnd - 1;
    line.b = kEnd;
    quads.lines.push_back(line);
  }
};

/// The same nine quads; the middle one lies between two features that touch each other: four corners that slide
/// nowhere, two and two at one place.
FadingEdge touchingEdges()
{
  FadingEdge touching(8, { 16, 8 });
  QuadMesh& quads = touching.quads;
  for (const Index p : { 5u, 6u })
  {
    quads.points[p + 4] = quads.points[p];
    quads.sourceFace[p + 4] = quads.sourceFace[p];
    quads.sourceWeights[p + 4] = quads.sourceWeights[p];
  }
  quads.lines.clear();
  for (const Index p : { 5u, 6u, 9u, 10u })
  {
    for (const Index other : { p - 1, p + 1, p < 8 ? p - 4 : p + 4 })
    {
      QuadLine line;
      line.a = p;
      line.b = other;
      quads.lines.push_back(line);
    }
  }
  return touching;
}

} // namespace

TEST(QuadShape, InvertedIsAJacobianOfAtMostZero)
{
  Random random(3);
  const auto coordinate = [&]() { return 0.01 * pick(random, 200); };
  int inverted = 0;
  for (int i = 0; i < 2000; ++i)
  {
    std::array<Vector3, 4> p;
    for (Vector3& x : p)
    {
      x = Vector3(coordinate(), coordinate(), 0.2 * coordinate());
    }
    EXPECT_EQ(isInverted(p), !(scaledJacobian(p) > 0));
    inverted += isInverted(p) ? 1 : 0;
  }
  EXPECT_GT(inverted, 200);
  EXPECT_LT(inverted, 1800);
  const Vector3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
  EXPECT_TRUE(isInverted({ o, o, x, y }));                // an edge without length
  EXPECT_TRUE(isInverted({ o, x, Vector3(2, 0, 0), y })); // a straight corner
  EXPECT_FALSE(isInverted({ o, x, Vector3(x + y), y }));
}

// On a plane every place can be mended, thick or thin.
TEST(QuadUntangling, MendsAllOfAPlane)
{
  for (const double thickness : { 1.0, 0.05, 0.002 })
  {
    const GridMapCase c = thinCrumpledPlane(1, thickness);
    QuadMesh mesh = rawQuads(c);
    ASSERT_GE(invertedCount(mesh), 5u); // else there is nothing to see
    EXPECT_EQ(untangleQuads(c.mesh, mesh, {}), 0u) << thickness;
    EXPECT_EQ(invertedCount(mesh), 0u);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
    {
      const SurfacePoint place{ mesh.sourceFace[i], mesh.sourceWeights[i] };
      EXPECT_NEAR((positionOf(c.mesh, place) - mesh.points[i]).norm(), 0, 1e-12);
      EXPECT_TRUE(!mesh.onBoundary[i] || mesh.points[i].x() == 0 || mesh.points[i].x() == 24 ||
        mesh.points[i].y() == 0 || mesh.points[i].y() == 18 * thickness);
    }
  }
}

TEST(QuadUntangling, MovesNothingButPointsNearBadQuads)
{
  const GridMapCase c = crumpledPlane(40, 30, 4, 50000);
  const QuadMesh raw = rawQuads(c);
  QuadMesh mesh = raw;
  untangleQuads(c.mesh, mesh, {});
  std::vector<Vector3> centres;
  for (const Index q : badQuads(raw.points, raw.quads))
  {
    const std::array<Vector3, 4> p = quadrille::cornersOf(raw.points, raw.quads[q]);
    centres.push_back((p[0] + p[1] + p[2] + p[3]) / 4);
  }
  ASSERT_GT(centres.size(), 0u);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    const bool isNear = std::any_of(centres.begin(), centres.end(),
      [&](const Vector3& centre) { return (centre - raw.points[i]).norm() < 12; }); // six quads
    const bool stays = mesh.points[i] == raw.points[i];
    moved += stays ? 0 : 1;
    EXPECT_TRUE(stays || isNear);
  }
  EXPECT_GT(moved, 0u);
}

TEST(QuadUntangling, LeavesMeshesWithoutSuchQuadsAlone)
{
  for (const GridMapCase& c : allCases(2))
  {
    const QuadMesh raw = rawQuads(c);
    if (badQuads(raw.points, raw.quads).empty())
    {
      QuadMesh mesh = raw;
      EXPECT_EQ(untangleQuads(c.mesh, mesh, {}), 0u);
      expectSamePlaces(mesh, raw);
    }
  }
}

TEST(QuadUntangling, WhatCannotBeMendedStaysAsItWas)
{
  Dart dart;
  const QuadMesh before = dart.quads;
  EXPECT_EQ(untangleQuads(dart.mesh, dart.quads, {}), 1u);
  expectSamePlaces(dart.quads, before);
}

TEST(QuadUntangling, MendsQuadsThatAreNearlyInverted)
{
  FadingEdge edge(11, { 13, 5 });
  ASSERT_EQ(invertedCount(edge.quads), 0u);
  ASSERT_EQ(badQuads(edge.quads.points, edge.quads.quads).size(), 1u);
  untangleQuads(edge.mesh, edge.quads, {});
  EXPECT_TRUE(badQuads(edge.quads.points, edge.quads.quads).empty());
}

// Wherever the corners lie on features that touch each other, the quad between them is flat.
TEST(QuadUntangling, PointsLeaveTouchingFeaturesForTheSakeOfQuads)
{
  FadingEdge touching = touchingEdges();
  QuadMesh& quads = touching.quads;
  const QuadMesh before = quads;
  ASSERT_EQ(invertedCount(quads), 3u);
  untangleQuads(touching.mesh, quads, {});
  expectSamePlaces(quads, before);

  loosenQuads(touching.mesh, quads, {});
  EXPECT_TRUE(badQuads(quads.points, quads.quads).empty());
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    const double off = (quads.points[p] - before.points[p]).norm();
    EXPECT_TRUE(off == 0 || quads.onBoundary[p] == 0) << p;
    EXPECT_LE(off, 0.15 * 8);
    EXPECT_EQ(quads.sourceFace[p], before.sourceFace[p]);
    EXPECT_EQ(quads.sourceWeights[p], before.sourceWeights[p]);
  }
}

TEST(QuadUntangling, HeldPointsLeaveNothing)
{
  FadingEdge touching = touchingEdges();
  const QuadMesh before = touching.quads;
  std::vector<Index> all(touching.mesh.vertexCount());
  std::iota(all.begin(), all.end(), Index{ 0 });
  loosenQuads(touching.mesh, touching.quads, { all, 1 });
  expectSamePlaces(touching.quads, before);

  FadingEdge edge(8, { 16, 8 }); // without bad quads
  const QuadMesh good = edge.quads;
  ASSERT_TRUE(badQuads(good.points, good.quads).empty());
  loosenQuads(edge.mesh, edge.quads, {});
  expectSamePlaces(edge.quads, good);
}

TEST(QuadUntangling, SameBytesForAnyNumberOfThreads)
{
  const GridMapCase c = crumpledPlane(40, 30, 5, 50000);
  const QuadMesh raw = rawQuads(c);
  QuadMesh one = raw;
  QuadMesh three = raw;
  untangleQuads(c.mesh, one, { {}, 1 });
  untangleQuads(c.mesh, three, { {}, 3 });
  EXPECT_NE(one.points, raw.points);
  expectSamePlaces(one, three);
}

// By default it follows the smoothing; without smoothing the points stay where the map has them.
TEST(QuadUntangling, IsPartOfTheExtraction)
{
  const GridMapCase c = thinCrumpledPlane(1, 0.002);
  const ExtractionResult result = extractQuads(c.mesh, c.uv, {});
  ASSERT_TRUE(result.status.ok());
  EXPECT_EQ(invertedCount(result.mesh), 0u);
  EXPECT_GT(invertedCount(rawQuads(c)), 0u);
}

} // namespace quadrille::test
