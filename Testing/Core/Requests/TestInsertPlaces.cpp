// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/InsertPlaces.h"

#include "Mesh/Distance.h"
#include "Mesh/Sizing.h"
#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Requests/MeshPaths.h"
#include "Requests/StrokeGuides.h"
#include "Requests/VerticesForSizes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace quadrille
{

namespace
{

using namespace test;

PreparedSurface prepared(const Mesh& mesh)
{
  PrepareOptions options;
  options.featureAngle = kPi / 4;
  return prepareSurface(toInput(mesh), options);
}

double areaOf(const Mesh& mesh)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area += mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm() / 2;
  }
  return area;
}

/// Corners of all faces lie where their sources say.
void expectSources(const PreparedSurface& surface, const Mesh& input)
{
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    std::array<double, 3> corner{};
    corner[h % 3] = 1;
    const SourceLocation source = surface.locate(Mesh::face(h), corner);
    Vector3 p = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      p += source.weights[k] * input.position[source.points[k]];
    }
    EXPECT_LT((p - surface.mesh.position[surface.mesh.origin[h]]).norm(), 1e-12);
  }
}

double requestedLength(const Mesh& mesh)
{
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    length += (mesh.flags[h] & kRequestedFeature) != 0 ? mesh.edgeVector(h).norm() / 2 : 0;
  }
  return length;
}

Vector3 onSphere(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  return Vector3(normal(random), normal(random), normal(random)).normalized();
}

/// Through vertices, and between places on edges: what is led round two of them may be longer than round one.
TEST(MeshPaths, AreStraightThroughVertices)
{
  const std::array<Vector3, 4> middles{ Vector3(0.5, 0.5, 1), { 1, 0.5, 0.5 }, { 0.5, 0.5, 0 },
    { 0, 0.5, 0.5 } };
  for (const double longest : { 0.2, 0.1, 0.05 })
  {
    PreparedSurface surface = prepared(unitCube(1));
    refineSurface(surface, longest, {});
    for (std::size_t i = 0; i < middles.size(); ++i)
    {
      const std::vector<Vector3> path =
        courseOnMesh(surface.mesh, { middles[i], middles[(i + 1) % middles.size()] }).points;
      for (const Vector3& p : path)
      {
        EXPECT_NEAR(p.y(), 0.5, 1e-12) << longest << ' ' << i;
      }
    }
  }
}

TEST(MeshPlaces, AreTheNearestOnes)
{
  const Mesh mesh = sphere(2);
  std::mt19937 random(7);
  std::vector<Vector3> points;
  for (int i = 0; i < 40; ++i)
  {
    points.push_back((i % 2 == 0 ? 1.0 : 1.3) * onSphere(random));
  }
  const std::vector<MeshPlace> places = placesOnMesh(mesh, points, 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double least = 1e300;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      least = std::min(least, (nearestOnFace(mesh, f, points[i]) - points[i]).norm());
    }
    EXPECT_NEAR((places[i].point - points[i]).norm(), least, 1e-12);
  }
}

TEST(MeshPlaces, PathsInThePlaneAreStraight)
{
  const Mesh mesh = gridPlane(9, 7);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0.1, 8.9), y(0.1, 6.9);
  for (int i = 0; i < 50; ++i)
  {
    const std::vector<MeshPlace> ends =
      placesOnMesh(mesh, { Vector3(x(random), y(random), 0), Vector3(x(random), y(random), 0) }, 1);
    const auto path = pathOnMesh(mesh, ends[0], ends[1]);
    ASSERT_TRUE(path);
    for (const EdgeCrossing& crossing : path->crossings)
    {
      EXPECT_LT(distanceToSegment(crossing.point(mesh), ends[0].point, ends[1].point), 1e-9);
    }
  }
}

/// Unfolding two sides of a cube, the shortest way over their edge is a straight line.
TEST(MeshPlaces, PathsOverAnEdgeAreStraightWhenUnfolded)
{
  const Mesh mesh = unitCube(1);
  const std::vector<MeshPlace> ends =
    placesOnMesh(mesh, { Vector3(0.4, 0.1, 1), Vector3(1, 0.9, 0.8) }, 1);
  const auto path = pathOnMesh(mesh, ends[0], ends[1]);
  ASSERT_TRUE(path);
  double length = 0;
  Vector3 from = ends[0].point;
  for (const EdgeCrossing& crossing : path->crossings)
  {
    length += (crossing.point(mesh) - from).norm();
    from = crossing.point(mesh);
  }
  length += (ends[1].point - from).norm();
  EXPECT_NEAR(length, std::hypot(0.6 + 0.2, 0.8), 1e-9);
}

TEST(MeshPlaces, PathsOnASphereAreAboutGreatCircles)
{
  const Mesh mesh = sphere(3);
  std::mt19937 random(11);
  for (int i = 0; i < 30; ++i)
  {
    const Vector3 a = onSphere(random);
    Vector3 b = onSphere(random);
    b = (a + 0.8 * b).normalized();
    const std::vector<MeshPlace> ends = placesOnMesh(mesh, { a, b }, 1);
    const auto path = pathOnMesh(mesh, ends[0], ends[1]);
    ASSERT_TRUE(path);
    double length = 0;
    Vector3 from = ends[0].point;
    for (const EdgeCrossing& crossing : path->crossings)
    {
      length += (crossing.point(mesh) - from).norm();
      from = crossing.point(mesh);
    }
    length += (ends[1].point - from).norm();
    EXPECT_NEAR(length / std::acos(a.dot(b)), 1, 0.03); // the mesh lies inside of the sphere
  }
}

TEST(MeshPlaces, HaveNoPathToAnotherComponent)
{
  const Mesh mesh = twoComponents();
  EXPECT_FALSE(pathOnMesh(mesh, { 0, nearestOnFace(mesh, 0, Vector3::Zero()) },
    { mesh.faceCount() - 1, nearestOnFace(mesh, mesh.faceCount() - 1, Vector3::Zero()) }));
}

TEST(InsertPlaces, APlaceBecomesAVertexAndTheShapeStays)
{
  const Mesh cube = unitCube(1);
  PreparedSurface surface = prepared(cube);
  const Vector3 place(0.3, 0.45, 1);
  EXPECT_FALSE(insertValences(surface, { { place, 3 } }, { 0.05, 1 }).splitConstraint);
  EXPECT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(surface.valenceRequests.size(), 1U);
  EXPECT_LT((surface.mesh.position[surface.valenceRequests[0].vertex] - place).norm(), 1e-12);
  EXPECT_EQ(surface.mesh.vertexCount(), 9U);
  EXPECT_NEAR(areaOf(surface.mesh), 6, 1e-12);
  expectSources(surface, cube);
}

TEST(InsertPlaces, NearPlacesTakeVerticesAndEdges)
{
  PreparedSurface surface = prepared(unitCube(1));
  // Within a hundredth of 0.1 of a corner and of an edge of the cube, and farther away.
  EXPECT_TRUE(
    insertValences(surface, { { { 0.0005, 0.0005, 1 }, 3 }, { { 0.5, 0.0005, 1 }, 5 } }, { 0.1, 1 })
      .splitConstraint);
  EXPECT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(surface.valenceRequests.size(), 2U);
  EXPECT_EQ(surface.mesh.vertexCount(), 9U);
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    const Vector3& p = surface.mesh.position[request.vertex];
    EXPECT_EQ(p, request.valence == 3 ? Vector3(0, 0, 1) : Vector3(p.x(), 0, 1));
  }
}

TEST(InsertPlaces, AFineMeshKeepsItsVertices)
{
  PreparedSurface surface = prepared(sphere(4));
  const Index before = surface.mesh.vertexCount();
  std::mt19937 random(5);
  std::vector<ValencePlace> asked;
  for (int i = 0; i < 10; ++i)
  {
    asked.push_back({ onSphere(random), 5 });
  }
  insertValences(surface, asked, { 1.0, 1 });
  EXPECT_EQ(surface.mesh.vertexCount(), before);
  EXPECT_EQ(surface.valenceRequests.size(), 10U);
}

TEST(InsertPlaces, ContradictionsAreLeftOutAndTold)
{
  PreparedSurface surface = prepared(unitCube(2));
  const Vector3 place(0.3, 0.45, 1);
  const InsertedValences two =
    insertValences(surface, { { place, 3 }, { place, 5 }, { place, 3 } }, { 0.05, 1 });
  ASSERT_EQ(two.notices.size(), 1U);
  EXPECT_NE(two.notices[0].find("(0.3, 0.45, 1)"), std::string::npos) << two.notices[0];
  ASSERT_EQ(surface.valenceRequests.size(), 1U);
  EXPECT_EQ(surface.valenceRequests[0].valence, 3);

  PreparedSurface open = prepared(gridPlane(3, 3));
  EXPECT_EQ(insertValences(open, { { { 1.5, 0, 0 }, 2 } }, { 0.1, 1 }).notices.size(), 1U);
  EXPECT_TRUE(open.valenceRequests.empty());
}

/// Many random lines over a cube of twelve triangles, which cross each other and the cube's edges.
TEST(InsertPlaces, FeaturePathsAreEdges)
{
  const Mesh cube = unitCube(1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int run = 0; run < 20; ++run)
  {
    PreparedSurface surface = prepared(cube);
    std::vector<FeatureRequest> features(4);
    for (FeatureRequest& feature : features)
    {
      feature.points = { Vector3(unit(random), unit(random), 1),
        Vector3(unit(random), unit(random), 1), Vector3(1, unit(random), unit(random)) };
    }
    std::vector<std::string> notices;
    const auto paths = insertFeatures(surface, features, { 0.02, 1 }, notices);
    EXPECT_TRUE(notices.empty());
    EXPECT_EQ(validate(surface.mesh), "");
    EXPECT_NEAR(areaOf(surface.mesh), 6, 1e-9);
    expectSources(surface, cube);
    double length = 0;
    for (std::size_t k = 0; k < paths.size(); ++k)
    {
      for (const Vector3& p : features[k].points)
      {
        double least = 1;
        for (const Vector3& q : paths[k])
        {
          least = std::min(least, (p - q).norm());
        }
        EXPECT_LT(least, 0.01 * 0.02 + 1e-12);
      }
      // On one side of the cube it is straight.
      for (const Vector3& q : paths[k])
      {
        if (q.z() == 1 && q.x() < 1)
        {
          const double away =
            std::min(distanceToSegment(q, features[k].points[0], features[k].points[1]),
              (q - features[k].points[1]).norm());
          EXPECT_TRUE(away < 0.001 || q.x() >= features[k].points[1].x()) << away;
        }
      }
      for (std::size_t i = 0; i + 1 < paths[k].size(); ++i)
      {
        length += (paths[k][i + 1] - paths[k][i]).norm();
      }
    }
    EXPECT_NEAR(requestedLength(surface.mesh), length, 1e-6);
  }
}

// Drawn a little beyond an edge of the cube, or not quite as far; far beyond it; and from one edge to another one.
TEST(InsertPlaces, AFeatureThatEndsBesideACurveEndsOnIt)
{
  struct Case
  {
    std::vector<Vector3> drawn;
    Vector3 begin, end;
  };
  const std::vector<Case> cases{
    { { { 0.3, 0.5, 1 }, { 1, 0.5, 1 }, { 1, 0.5, 0.99 } }, { 0.3, 0.5, 1 }, { 1, 0.5, 1 } },
    { { { 0.3, 0.5, 1 }, { 0.99, 0.5, 1 } }, { 0.3, 0.5, 1 }, { 1, 0.5, 1 } },
    { { { 0.3, 0.5, 1 }, { 1, 0.5, 1 }, { 1, 0.5, 0.9 } }, { 0.3, 0.5, 1 }, { 1, 0.5, 0.9 } },
    { { { 0, 0.5, 0.99 }, { 0, 0.5, 1 }, { 1, 0.5, 1 }, { 1, 0.5, 0.99 } }, { 0, 0.5, 1 },
      { 1, 0.5, 1 } },
  };
  for (const Case& made : cases)
  {
    PreparedSurface surface = prepared(unitCube(1));
    std::vector<std::string> notices;
    const std::array<double, 2> near{ 0.02, 0.02 };
    const std::vector<Vector3> path =
      insertFeatures(surface, { { made.drawn } }, { 0.1, 1 }, notices, { near }).front();
    EXPECT_LT((path.front() - made.begin).norm(), 1e-12) << path.front().transpose();
    EXPECT_LT((path.back() - made.end).norm(), 1e-12) << path.back().transpose();
    double length = 0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
    {
      length += (path[i + 1] - path[i]).norm();
    }
    EXPECT_NEAR(requestedLength(surface.mesh), length, 1e-12);
  }
}

// A line over itself: what its end crosses is cut in parts, all of which are features.
TEST(InsertPlaces, AFeatureMayCrossItself)
{
  PreparedSurface surface = prepared(unitCube(1));
  std::vector<std::string> notices;
  const std::vector<Vector3> drawn{ { 0.2, 0.5, 1 }, { 0.8, 0.5, 1 }, { 0.8, 0.8, 1 },
    { 0.53, 0.8, 1 }, { 0.53, 0.2, 1 } };
  insertFeatures(surface, { { drawn } }, { 0.1, 1 }, notices);
  EXPECT_NEAR(requestedLength(surface.mesh), 0.6 + 0.3 + 0.27 + 0.6, 1e-9);
}

TEST(InsertPlaces, AFeatureAlongEdgesAddsNothing)
{
  PreparedSurface surface = prepared(unitCube(4));
  const Index before = surface.mesh.vertexCount();
  std::vector<std::string> notices;
  insertFeatures(surface, { { { { 0.25, 0.25, 1 }, { 0.75, 0.25, 1 } } } }, { 0.1, 1 }, notices);
  EXPECT_EQ(surface.mesh.vertexCount(), before);
  EXPECT_NEAR(requestedLength(surface.mesh), 0.5, 1e-12);
}

TEST(InsertPlaces, FeaturesBetweenComponentsAreLeftOutAndTold)
{
  PreparedSurface surface = prepared(twoComponents());
  const Vector3 a = surface.mesh.position[0];
  Vector3 b = a;
  for (const Vector3& p : surface.mesh.position)
  {
    b = (p - a).norm() > (b - a).norm() ? p : b;
  }
  std::vector<std::string> notices;
  insertFeatures(surface, { { { a, b } } }, { 0.1, 1 }, notices);
  EXPECT_EQ(notices.size(), 1U);
  EXPECT_EQ(requestedLength(surface.mesh), 0);
}

TEST(InsertPlaces, SizesHoldWithinTheirRadius)
{
  const Mesh cube = unitCube(1);
  PreparedSurface surface = prepared(cube);
  const SizeRequest size{ { 0.5, 0.5, 1 }, 0.2, 0.4, 1 };
  insertSizes(surface, { size }, {}, { 0.05, 1 });
  EXPECT_EQ(validate(surface.mesh), "");
  expectSources(surface, cube);
  ASSERT_EQ(surface.mesh.sizing.size(), surface.mesh.vertexCount());
  std::size_t within = 0;
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    const double distance = (surface.mesh.position[v] - size.place).norm();
    EXPECT_TRUE(distance > size.radius || surface.mesh.sizing[v] == 0.4F);
    EXPECT_TRUE(distance < 2 * size.radius || surface.mesh.sizing[v] > 0.6F);
    within += distance <= size.radius ? 1 : 0;
  }
  EXPECT_GE(within, 9U);
  // The area in quads: 0.4 within the radius, 1 elsewhere, with a band between them.
  const double inside = kPi * 0.04;
  EXPECT_GT(sizedArea(surface.mesh), 6 - inside + inside / 0.16);
  EXPECT_LT(sizedArea(surface.mesh), 6 + 3 * inside / 0.16);
}

TEST(InsertPlaces, LargerSizesHoldWithinTheirRadiusAndDecreaseBeyond)
{
  constexpr double kEdgeLength = 0.05;
  PreparedSurface surface = prepared(unitCube(1));
  const SizeRequest size{ { 0.5, 0.5, 1 }, 0.2, 1.6, 1 };
  const SizeRequest smaller{ { 0.5, 0.5, 0 }, 0.1, 0.5, 2 };
  insertSizes(surface, { size, smaller }, {}, { kEdgeLength, 1 });
  // 0.6 to lose, a quarter an edge length.
  constexpr double kBeyond = 0.6 / 0.25 * kEdgeLength;
  std::size_t between = 0;
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    const Vector3& p = surface.mesh.position[v];
    const double beyond = (p - size.place).norm() - size.radius;
    const float asked = surface.mesh.sizing[v];
    EXPECT_TRUE(beyond > 0 || asked == 1.6F);
    EXPECT_TRUE(beyond < kBeyond || asked <= 1);
    EXPECT_TRUE((p - smaller.place).norm() > smaller.radius || asked == 0.5F);
    between += asked > 1 && asked < 1.6F ? 1 : 0;
  }
  EXPECT_GE(between, 4U);
  // Both pass to those around as gradually as they have to.
  EXPECT_LT(limitSizeGrowth(surface.mesh, kEdgeLength).most, 1 + 1e-5);
}

TEST(InsertPlaces, ASizeThatALaterOneCoversDoesNotPassOn)
{
  PreparedSurface surface = prepared(unitCube(8));
  const Vector3 place(0.5, 0.5, 1);
  insertSizes(surface, { { place, 0.2, 0.4, 1 }, { place, 0.3, 1, 2 } }, {}, { 0.05, 1 });
  for (const float size : surface.mesh.sizing)
  {
    EXPECT_EQ(size, 1);
  }
}

TEST(InsertPlaces, TheSizeOfTheHighestOrderCounts)
{
  PreparedSurface surface = prepared(unitCube(8));
  const Vector3 place(0.5, 0.5, 1);
  insertSizes(surface, { { place, 0.3, 0.4, 3 }, { place, 0.2, 0.7, 2 } }, {}, { 0.05, 1 });
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v)
  {
    if ((surface.mesh.position[v] - place).norm() <= 0.2)
    {
      EXPECT_EQ(surface.mesh.sizing[v], 0.4F);
    }
  }
}

TEST(StrokeGuides, GuideWhatTheyCrossAndWhatIsNear)
{
  const Mesh mesh = gridPlane(20, 20);
  const Vector3 a(3.2, 3.1, 0), b(16.3, 11.4, 0);
  constexpr double kEdgeLength = 3.6;
  for (const double radius : { 0.0, 2.0 })
  {
    std::vector<bool> guided(mesh.faceCount(), false);
    for (const StrokeFace& face :
      facesOfStrokes(mesh, { { { a, b }, 1, radius, 0 } }, kEdgeLength, 1))
    {
      guided[face.face] = true;
      EXPECT_GT(std::abs(face.direction.dot((b - a).normalized())), 1 - 1e-9);
    }
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const Vector3 centre =
        (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
          mesh.position[mesh.origin[3 * f + 2]]) /
        3;
      const double distance = distanceToSegment(centre, a, b);
      const double reach = radius + 0.25 * kEdgeLength;
      EXPECT_TRUE(guided[f] || distance > reach - 1e-9);
      EXPECT_TRUE(!guided[f] ||
        distance <= std::max(reach, 0.75)); // a triangle reaches so far from its centre
    }
  }
}

TEST(StrokeGuides, TheLaterOneCountsUnlessOrdersSayOtherwise)
{
  const Mesh mesh = gridPlane(10, 10);
  const StrokeRequest along{ { { 1, 5.2, 0 }, { 9, 5.2, 0 } }, 1, 1, 0 };
  const StrokeRequest across{ { { 5.2, 1, 0 }, { 5.2, 9, 0 } }, 1, 1, 0 };
  const MeshPlace middle = placesOnMesh(mesh, { Vector3(5.2, 5.2, 0) }, 1)[0];
  for (const bool isLater : { true, false })
  {
    StrokeRequest first = along;
    first.order = isLater ? 0 : 1;
    for (const StrokeFace& face : facesOfStrokes(mesh, { first, across }, 1, 1))
    {
      if (face.face == middle.face)
      {
        EXPECT_NEAR(std::abs(face.direction.x()), isLater ? 0 : 1, 1e-12);
      }
    }
  }
}

TEST(InsertValences, AVertexTakesThePlaceWhereAFaceOfAnotherPartIsNearer)
{
  // A small cube stands on a larger one.
  constexpr double kGap = 1e-9;
  Mesh small = unitCube(1);
  for (Vector3& p : small.position.editAll())
  {
    p = 0.6 * p;
  }
  PreparedSurface surface =
    prepared(disjointUnion(unitCube(4), small, Vector3(0.2, 0.2, 1 + kGap)));
  const Index before = surface.mesh.vertexCount();
  const Vector3 place(0.5, 0.5, 1 + kGap);
  insertValences(surface, { { place, 3 } }, { 0.05, 1 });
  EXPECT_EQ(surface.mesh.vertexCount(), before);
  ASSERT_EQ(surface.valenceRequests.size(), 1U);
  EXPECT_EQ(surface.mesh.position[surface.valenceRequests[0].vertex], Vector3(0.5, 0.5, 1));
}

TEST(VerticesForSizes, AreSpreadOverTheRegionOffFeatures)
{
  constexpr double kS = 0.02;
  PreparedSurface surface = prepared(unitCube(64));
  EXPECT_TRUE(verticesForSizes(surface, kS).empty());
  const SizeRequest size{ { 0.5, 0.8, 1 }, 0.15, 2, 1 };
  surface.sizes = { size };
  const std::vector<Index> vertices = verticesForSizes(surface, kS);
  // Sizes grow by a quarter an edge length, so that the region ends four of these beyond the radius.
  const double reach = 0.15 + 4 * kS;
  EXPECT_GT(vertices.size(), 30U);
  EXPECT_LT(vertices.size(), 200U);
  for (const Index v : vertices)
  {
    const Vector3& p = surface.mesh.position[v];
    EXPECT_LE((p - size.place).norm(), reach);
    // An edge of the cube lies in the region.
    EXPECT_FALSE(p.y() == 1 && p.z() == 1);
    for (const Index other : vertices)
    {
      EXPECT_TRUE(v == other || (p - surface.mesh.position[other]).norm() >= 2 * kS);
    }
  }
}

} // namespace
} // namespace quadrille
