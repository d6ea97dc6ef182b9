// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Refine.h"

#include "SurfaceInputs.h"

namespace quadrille
{

namespace
{

using namespace test;

double longestEdge(const Mesh& mesh)
{
  double longest = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    longest = std::max(longest, mesh.edgeVector(h).norm());
  }
  return longest;
}

int constrainedEdges(const Mesh& mesh, Index f)
{
  int count = 0;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    count += mesh.isConstrained(h) ? 1 : 0;
  }
  return count;
}

int chords(const Mesh& mesh)
{
  std::vector<bool> on(mesh.vertexCount(), false);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      on[mesh.origin[h]] = on[mesh.target(h)] = true;
    }
  }
  int count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += !mesh.isConstrained(h) && on[mesh.origin[h]] && on[mesh.target(h)] ? 1 : 0;
  }
  return count;
}

double featureLength(const Mesh& mesh)
{
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    length += mesh.isFeature(h) ? mesh.edgeVector(h).norm() / 2 : 0;
  }
  return length;
}

/// Prism over a circle of n corners, its round side and its lids in long thin triangles.
SurfaceInput tessellatedCylinder(Index n)
{
  std::vector<Vector3> points;
  for (const double z : { 0.0, 4.0 })
  {
    for (Index i = 0; i < n; ++i)
    {
      points.emplace_back(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), z);
    }
  }
  std::vector<std::vector<Index>> polygons;
  for (Index i = 0; i < n; ++i)
  {
    const Index j = (i + 1) % n;
    polygons.push_back({ i, j, n + j });
    polygons.push_back({ i, n + j, n + i });
    if (i > 1)
    {
      polygons.push_back({ 0, i, i - 1 });
      polygons.push_back({ n, n + i - 1, n + i });
    }
  }
  return makeInput(points, polygons);
}

void expectRefined(const SurfaceInput& input, double featureAngle, double maximumLength)
{
  PreparedSurface surface = prepare(input, featureAngle);
  const TopologySummary before = summarizeTopology(surface.mesh);
  const double areaBefore = area(surface.mesh);
  const double featuresBefore = featureLength(surface.mesh);
  const std::uint64_t hashBefore = surface.hash;
  refineSurface(surface, maximumLength, {});

  expectSound(surface, input);
  EXPECT_EQ(surface.notice, "");
  EXPECT_LE(longestEdge(surface.mesh), maximumLength);
  EXPECT_EQ(chords(surface.mesh), 0);
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    EXPECT_LE(constrainedEdges(surface.mesh, f), 1);
  }
  const TopologySummary after = summarizeTopology(surface.mesh);
  EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
  EXPECT_EQ(after.boundaryLoops, before.boundaryLoops);
  // Sums of as many roundings as there are faces.
  EXPECT_NEAR(area(surface.mesh), areaBefore, 1e-12 * areaBefore * after.faces);
  EXPECT_NEAR(featureLength(surface.mesh), featuresBefore, 1e-12 * featuresBefore * after.faces);
  if (after.faces != before.faces)
  {
    EXPECT_GT(surface.repair.refinedFaces, 0u);
    EXPECT_NE(surface.hash, hashBefore);
  }
}

} // namespace

TEST(Refine, LongEdgesAndChordsAreSplitAndTheSurfaceStays)
{
  expectRefined(tessellatedCylinder(48), 0.7, 0.3);
  expectRefined(toInput(unitCube(1)), 0.7, 0.2);
  expectRefined(toInput(unitCube(1)), 0.7, 10);
  expectRefined(toInput(doubleTorus(1)), 0.7, 0.5);
  expectRefined(toInput(plateWithHole(1)), 0.7, 0.7);
  expectRefined(toInput(plateL(1)), 0.7, 5);
  expectRefined(toInput(openCylinder(12, 1)), 0.7, 0.4);
  expectRefined(toInput(sphere(1)), 0.1, 0.5); // every edge is a feature
  expectRefined(toInput(twoComponents()), 0.7, 0.2);
}

TEST(Refine, ASingleTriangleGetsAVertexInside)
{
  const SurfaceInput input = makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } });
  PreparedSurface surface = prepare(input);
  splitEnclosedFaces(surface);
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_EQ(surface.mesh.faceCount(), 3u);
  EXPECT_EQ(surface.mesh.vertexCount(), 4u);
  // However large the edges are to be, so small a component gets triangles for its block of quads.
  refineSurface(surface, 10, {});
  expectSound(surface, input);
  EXPECT_GE(surface.mesh.faceCount(), 20u);
}

TEST(Refine, AFineMeshWithoutChordsIsLeftAlone)
{
  PreparedSurface surface = prepare(toInput(sphere(3)));
  const std::uint64_t hash = surface.hash;
  refineSurface(surface, 1, {});
  EXPECT_EQ(surface.hash, hash);
  EXPECT_EQ(surface.repair.refinedFaces, 0u);
  EXPECT_TRUE(surface.refinedEntry.empty());
}

TEST(Refine, LocateFollowsAnyPointOfAnyFace)
{
  const SurfaceInput input = tessellatedCylinder(24);
  PreparedSurface surface = prepare(input, 0.7);
  refineSurface(surface, 0.2, {});
  const std::array<double, 3> weights{ 0.5, 0.3, 0.2 };
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    const SourceLocation location = surface.locate(f, weights);
    Vector3 here = Vector3::Zero(), there = Vector3::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      here += weights[k] * surface.mesh.position[surface.mesh.origin[3 * f + k]];
      there += location.weights[k] * input.points[location.points[k]];
      sum += location.weights[k];
      EXPECT_GE(location.weights[k], -1e-14);
      // Repair changed nothing here, so the points are corners of the polygon.
      const Index* corners = input.polygonPoints.data() + 3 * location.polygon;
      EXPECT_NE(std::find(corners, corners + 3, location.points[k]), corners + 3);
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LE((here - there).norm(), 1e-12 * surface.boundingBoxDiagonal);
  }
}

TEST(Refine, SmallestAngleAtMostHalvesTwice)
{
  // Longest-edge bisection keeps angles above half of the smallest one [Rosenberg, Stenger 1975]; a
  // chord or a constrained corner may be cut once more.
  PreparedSurface surface = prepare(toInput(unitCube(1)), 0.7);
  refineSurface(surface, 0.1, {});
  double smallest = kPi;
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    const Vector3 a = surface.mesh.edgeVector(h);
    const Vector3 b = -surface.mesh.edgeVector(Mesh::previous(h));
    smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  EXPECT_GT(smallest, kPi / 4 / 4);
}

TEST(Refine, RunsTwiceToTheSameBytes)
{
  const SurfaceInput input = tessellatedCylinder(32);
  PreparedSurface first = prepare(input, 0.7, 1);
  PreparedSurface second = prepare(input, 0.7, 2);
  refineSurface(first, 0.15, {});
  refineSurface(second, 0.15, {});
  EXPECT_EQ(first.hash, second.hash);
  EXPECT_EQ(first.sourcePolygon, second.sourcePolygon);
  EXPECT_EQ(first.cornerWeights, second.cornerWeights);
}

TEST(Refine, ASecondRefinementBuildsOnTheFirst)
{
  const SurfaceInput input = toInput(unitCube(1));
  PreparedSurface surface = prepare(input, 0.7);
  refineSurface(surface, 0.5, {});
  refineSurface(surface, 0.1, {});
  expectSound(surface, input);
  EXPECT_LE(longestEdge(surface.mesh), 0.1);
}

TEST(Refine, GrowthIsBoundedAndTold)
{
  // 2000 strips a thousand times longer than the edge length, no two in a plane, would need millions of faces.
  std::vector<Vector3> points;
  std::vector<std::vector<Index>> polygons;
  for (Index i = 0; i <= 2000; ++i)
  {
    points.emplace_back(0, i * 1e-4, 5e-5 * (i % 2));
    points.emplace_back(10, i * 1e-4, 5e-5 * (i % 2));
  }
  for (Index i = 0; i < 2000; ++i)
  {
    polygons.push_back({ 2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2 });
  }
  const SurfaceInput input = makeInput(points, polygons);
  PreparedSurface surface = prepare(input);
  refineSurface(surface, 0.01, {});
  EXPECT_NE(surface.notice, "");
  EXPECT_EQ(validate(surface.mesh), "");
  const double bound = 64 * 4000 + 20 * surface.area / (0.01 * 0.01);
  // Chords come on top, at most two faces for each face of the first step.
  EXPECT_LT(surface.mesh.faceCount(), 4 * bound);
}

/// A square with a round hole of n corners, in needles from the hole to the corners of the square.
SurfaceInput holedSquare(Index n)
{
  std::vector<Vector3> points;
  for (Index i = 0; i < n; ++i)
  {
    const double angle = 2 * kPi * (i + 0.5) / n;
    points.emplace_back(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0);
  }
  for (Index i = 0; i < 4; ++i)
  {
    const double angle = kPi / 4 + i * kPi / 2;
    points.emplace_back(
      4 * std::sqrt(2.0) * std::cos(angle), 4 * std::sqrt(2.0) * std::sin(angle), 0);
  }
  std::vector<std::vector<Index>> polygons;
  const auto quadrant = [n](Index i)
  { return n + static_cast<Index>(std::floor((double(i) + 0.5) / n * 4)) % 4; };
  for (Index i = 0; i < n; ++i)
  {
    const Index j = (i + 1) % n;
    polygons.push_back({ i, quadrant(i), j });
    if (quadrant(i) != quadrant(j))
    {
      polygons.push_back({ j, quadrant(i), quadrant(j) });
    }
  }
  return makeInput(points, polygons);
}

double smallestAngle(const Mesh& mesh)
{
  double smallest = kPi;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 a = mesh.edgeVector(h), b = -mesh.edgeVector(Mesh::previous(h));
    smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return smallest;
}

TEST(FlatFlips, NeedlesBetweenAHoleAndTheCornersBecomeRoundTriangles)
{
  const SurfaceInput input = holedSquare(64);
  PreparedSurface surface = prepare(input);
  ASSERT_LT(smallestAngle(surface.mesh), 0.01);
  const double area = surface.area;
  refineSurface(surface, 0.25, {});
  EXPECT_EQ(validate(surface.mesh), "");
  EXPECT_LE(longestEdge(surface.mesh), 0.25);
  EXPECT_GT(smallestAngle(surface.mesh), 0.1);
  // Triangles of half that edge length everywhere would be about as many.
  EXPECT_LT(surface.mesh.faceCount(), 64 * area / (0.25 * 0.25) / 4);
  double sum = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    sum += surface.mesh.faceArea(f);
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

TEST(FlatFlips, PlacesOfFlippedFacesLieInTheirPolygons)
{
  const SurfaceInput input = holedSquare(64);
  PreparedSurface surface = prepare(input);
  refineSurface(surface, 0.5, {});
  refineSurface(surface, 0.25, {}); // flips what the first one has flipped and split
  std::size_t flipped = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    flipped += surface.isFlipped(f) ? 1 : 0;
    for (const std::array<double, 3>& weights :
      { std::array<double, 3>{ 0.5, 0.3, 0.2 }, std::array<double, 3>{ 0, 1, 0 } })
    {
      const SourceLocation location = surface.locate(f, weights);
      Vector3 here = Vector3::Zero(), there = Vector3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
      {
        here += weights[k] * surface.mesh.position[surface.mesh.origin[3 * f + k]];
        there += location.weights[k] * input.points[location.points[k]];
        EXPECT_GE(location.weights[k], -1e-12);
        const Index* corners = input.polygonPoints.data() + 3 * location.polygon;
        EXPECT_NE(std::find(corners, corners + 3, location.points[k]), corners + 3);
      }
      EXPECT_LE((here - there).norm(), 1e-9 * surface.boundingBoxDiagonal);
    }
    // What is kept by corners tells the same place, if from outside of the triangle.
    for (Index h = 3 * f; h < 3 * f + 3 && surface.isFlipped(f); ++h)
    {
      Vector3 there = Vector3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
      {
        there += surface.cornerWeights[surface.refinedEntry[f]][h % 3][k] *
          input.points[surface.sourcePoints[f][k]];
      }
      EXPECT_LE((surface.mesh.position[surface.mesh.origin[h]] - there).norm(), 1e-9);
    }
  }
  EXPECT_GT(flipped, surface.mesh.faceCount() / 8);
}

TEST(FlatFlips, PointsOfTheInputStayKnown)
{
  const SurfaceInput input = holedSquare(64);
  PreparedSurface surface = prepare(input);
  refineSurface(surface, 0.25, {});
  std::vector<std::uint8_t> found(input.points.size(), 0);
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    const Index point = surface.inputPointAt(h);
    if (point != kInvalidIndex)
    {
      found[point] = 1;
      EXPECT_EQ(surface.mesh.position[surface.mesh.origin[h]], input.points[point]);
    }
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), 1), static_cast<std::ptrdiff_t>(found.size()));
}

TEST(FlatFlips, BentEdgesAndFeaturesStay)
{
  // A long rhombus in two needles, on which the short diagonal is the better one.
  const auto rhombus = [](double height)
  {
    return makeInput({ { -4, 0, 0 }, { 0, -0.5, 0 }, { 4, 0, 0 }, { 0, 0.5, height } },
      { { 0, 1, 2 }, { 0, 2, 3 } });
  };
  const auto flips = [](const SurfaceInput& input)
  {
    PreparedSurface surface = prepare(input);
    refineSurface(surface, 3, {});
    return !surface.flipped.empty();
  };
  EXPECT_TRUE(flips(rhombus(0)));
  EXPECT_FALSE(flips(rhombus(1e-4)));
  SurfaceInput input = rhombus(0);
  input.featureEdges = { 0, 1 };
  EXPECT_FALSE(flips(input));
}

TEST(Refine, BadLengthsAreRefused)
{
  PreparedSurface surface = prepare(toInput(sphere(1)));
  for (const double length : { 0.0, -1.0, double(NAN), double(INFINITY) })
  {
    EXPECT_THROW(refineSurface(surface, length, {}), InvalidInput);
  }
}

} // namespace quadrille
