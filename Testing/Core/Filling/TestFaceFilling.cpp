// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FillFaces.h"
#include "QuadChecks.h"

#include "Filling/FaceFilling.h"
#include "Filling/FaceGround.h"
#include "Mesh/Sizing.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace quadrille::test
{
namespace
{

struct Shapes
{
  std::size_t quads = 0;
  double worst = 1, mean = 0;
  double irregular = 0; ///< share of the inner points with another number of quads than 4
};

QuadMesh allPoints(const FillCase& c, const FaceFill& fill)
{
  QuadMesh quads;
  quads.points = c.mesh.position;
  append(quads.points, fill.points);
  quads.quads = fill.quads;
  return quads;
}

/// Of each quad with respect to the normal of the face below its middle.
Shapes shapesOf(const FillCase& c, const FaceFill& fill, double edgeLength)
{
  const FaceGround ground(c.mesh, c.isPin, edgeLength);
  const QuadMesh mesh = allPoints(c, fill);
  Shapes shapes;
  shapes.quads = mesh.quads.size();
  std::vector<int> counts(mesh.points.size(), 0);
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    Vector3 normal = Vector3::Zero();
    for (const Index v : quad)
    {
      ++counts[v];
      normal += v < c.mesh.vertexCount()
        ? ground.normals()[v]
        : ground.at(mesh.points[v], Vector3::Zero(), mesh.points[v])->normal;
    }
    const double shape = quadShape(cornersOf(mesh.points, quad), normal);
    shapes.worst = std::min(shapes.worst, shape);
    shapes.mean += shape / static_cast<double>(mesh.quads.size());
  }
  for (std::size_t v = c.mesh.vertexCount(); v < counts.size(); ++v)
  {
    shapes.irregular += (counts[v] != 4 ? 1.0 : 0.0) / static_cast<double>(fill.points.size());
  }
  return shapes;
}

/// All that holds for every fill. With QUADRILLE_PRINT_FILLS in the environment, a line says what it is like.
Shapes checkFill(const FillCase& c, double edgeLength)
{
  const auto start = std::chrono::steady_clock::now();
  const std::optional<FaceFill> fill = fillFace(c.mesh, c.isPin, edgeLength);
  const double seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!fill)
  {
    ADD_FAILURE() << "no fill";
    return {};
  }
  const QuadMesh mesh = allPoints(c, *fill);
  const IndependentCheck check(mesh);
  const TopologySummary face = summarizeTopology(c.mesh);
  EXPECT_TRUE(check.oriented && check.vertexManifold);
  EXPECT_EQ(check.components, 1u);
  EXPECT_EQ(check.boundaryLoops, face.boundaryLoops);
  const FaceGround ground(c.mesh, c.isPin, edgeLength);
  const QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  std::vector<std::uint8_t> isUsed(mesh.points.size(), 0);
  std::size_t pinEdges = 0;
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    const Index from = mesh.quads[h / 4][h % 4], to = mesh.quads[h / 4][(h + 1) % 4];
    isUsed[from] = 1;
    if (topology.twin[h] == kInvalidIndex)
    {
      EXPECT_TRUE(ground.isPin(from));
      EXPECT_EQ(ground.nextPin(from), to);
      ++pinEdges;
    }
  }
  const auto pins = static_cast<std::size_t>(std::count(c.isPin.begin(), c.isPin.end(), 1));
  EXPECT_EQ(pinEdges, pins);
  EXPECT_EQ(static_cast<long long>(pins + fill->points.size() + mesh.quads.size()) -
      static_cast<long long>(check.edges),
    face.eulerCharacteristic);
  EXPECT_EQ(static_cast<std::size_t>(std::count(isUsed.begin(), isUsed.end(), 1)),
    pins + fill->points.size());
  EXPECT_EQ(fill->sourceFace.size(), fill->points.size());
  EXPECT_EQ(fill->sourceWeights.size(), fill->points.size());
  for (std::size_t i = 0; i < fill->points.size(); ++i)
  {
    Vector3 place = Vector3::Zero();
    for (Index k = 0; k < 3; ++k)
    {
      EXPECT_GE(fill->sourceWeights[i][k], 0);
      place +=
        fill->sourceWeights[i][k] * c.mesh.position[c.mesh.origin[3 * fill->sourceFace[i] + k]];
    }
    EXPECT_NEAR((place - fill->points[i]).norm(), 0, 1e-9);
  }
  const Shapes shapes = shapesOf(c, *fill, edgeLength);
  if (std::getenv("QUADRILLE_PRINT_FILLS") != nullptr)
  {
    std::printf("%-22s triangles %6u pins %4zu quads %5zu mean %.3f worst %6.3f irregular %.2f "
                "seconds %.3f\n",
      testing::UnitTest::GetInstance()->current_test_info()->name(), c.mesh.faceCount(), pins,
      shapes.quads, shapes.mean, shapes.worst, shapes.irregular, seconds);
  }
  return shapes;
}

void expectGood(const FillCase& c, double edgeLength)
{
  const Shapes shapes = checkFill(c, edgeLength);
  EXPECT_GE(shapes.mean, 0.75);
  EXPECT_GT(shapes.worst, 0);
}

FillCase rectangle(double width, double height, double spacing = 1, int between = 0)
{
  return planeCase({ polygonLoop(
    { { 0, 0 }, { width, 0 }, { width, height }, { 0, height } }, spacing, between) });
}

} // namespace

TEST(FaceFilling, Rectangle6x4)
{
  expectGood(rectangle(6, 4), 1);
}

TEST(FaceFilling, Rectangle20x20)
{
  expectGood(refined(rectangle(20, 20), 2), 1);
}

TEST(FaceFilling, UnevenSides)
{
  // 7 pins' spaces against 6 and 4 against 3.
  PinLoop loop;
  const auto side = [&](const Vector2& a, const Vector2& b, int count)
  {
    for (int i = 0; i < count; ++i)
    {
      loop.add(a + (b - a) * i / count, true);
    }
  };
  side({ 0, 0 }, { 6.5, 0 }, 7);
  side({ 6.5, 0 }, { 6.5, 3.5 }, 4);
  side({ 6.5, 3.5 }, { 0, 3.5 }, 6);
  side({ 0, 3.5 }, { 0, 0 }, 3);
  expectGood(planeCase({ loop }), 1);
}

TEST(FaceFilling, FourPinsAreOneQuad)
{
  const FillCase c = refined(rectangle(1, 1), 4);
  const auto fill = fillFace(c.mesh, c.isPin, 0.1);
  ASSERT_TRUE(fill.has_value());
  EXPECT_EQ(fill->quads.size(), 1u);
  EXPECT_TRUE(fill->points.empty());
  EXPECT_EQ(checkFill(c, 0.1).worst, 1);
}

TEST(FaceFilling, SixPins)
{
  const FillCase c = refined(planeCase({ circleLoop({ 0, 0 }, 1, 6, 7) }), 1);
  const Shapes shapes = checkFill(c, 1);
  EXPECT_LE(shapes.quads, 3u);
  EXPECT_GT(shapes.worst, 0);
}

TEST(FaceFilling, DiscWithOddHole)
{
  // A ring as wide as a quad.
  const FillCase c =
    planeCase({ circleLoop({ 0, 0 }, 1.8, 11, 3), circleLoop({ 0.1, 0 }, 0.8, 5, 3, true) });
  EXPECT_GT(checkFill(c, 1).worst, 0.3);
}

TEST(FaceFilling, FewPinsOnBothLoops)
{
  // Hardly room for a ring of quads.
  const FillCase c =
    planeCase({ circleLoop({ 0, 0 }, 1.2, 7, 5), circleLoop({ 0, 0.1 }, 0.4, 5, 5, true) });
  EXPECT_GT(checkFill(c, 1).worst, 0.1);
}

TEST(FaceFilling, Disc)
{
  expectGood(planeCase({ circleLoop({ 0, 0 }, 8 / kPi, 16, 3) }), 1);
}

TEST(FaceFilling, LargeDisc)
{
  expectGood(refined(planeCase({ circleLoop({ 0, 0 }, 40 / kPi, 80, 0) }), 4), 1);
}

TEST(FaceFilling, AnnulusWithSmallHole)
{
  expectGood(
    planeCase({ circleLoop({ 0, 0 }, 4, 26, 3), circleLoop({ 0, 0 }, 0.3, 4, 7, true) }), 1);
}

TEST(FaceFilling, Strip)
{
  expectGood(rectangle(30, 1), 1);
}

TEST(FaceFilling, BentStrip)
{
  expectGood(
    planeCase({ circleLoop({ 0, 0 }, 5.5, 33, 3), circleLoop({ 0, 0 }, 4.5, 29, 3, true) }), 1);
}

TEST(FaceFilling, HalfSphere)
{
  const FillCase c = bent(refined(planeCase({ circleLoop({ 0, 0 }, 1, 24, 1) }), 4),
    [](const Vector3& p)
    {
      const double r = std::min(1.0, p.norm()), angle = r * kRightAngle;
      const Vector3 out = r > 0 ? Vector3(p / p.norm()) : Vector3::Zero();
      return Vector3(4 * (std::sin(angle) * out + std::cos(angle) * Vector3::UnitZ()));
    });
  expectGood(c, 1);
}

TEST(FaceFilling, PartOfACylinder)
{
  const FillCase c = bent(refined(rectangle(10, 6), 3),
    [](const Vector3& p)
    { return Vector3(3 * std::cos(p.x() / 3), 3 * std::sin(p.x() / 3), p.y()); });
  expectGood(c, 1);
}

TEST(FaceFilling, CornersL)
{
  expectGood(planeCase({ polygonLoop(
               { { 0, 0 }, { 8, 0 }, { 8, 3 }, { 4, 3 }, { 4, 7 }, { 0, 7 } }, 1, 2) }),
    1);
}

TEST(FaceFilling, RandomSpacing)
{
  std::mt19937 random(7);
  for (int i = 0; i < 10; ++i)
  {
    PinLoop loop;
    const std::array<Vector2, 5> corners{ Vector2(0, 0), Vector2(9, 0), Vector2(9, 5),
      Vector2(4, 8), Vector2(0, 8) };
    for (std::size_t k = 0; k < 5; ++k)
    {
      const Vector2 &a = corners[k], &b = corners[(k + 1) % 5];
      for (double at = 0; at < (b - a).norm() - 0.6;)
      {
        loop.add(a + (b - a).normalized() * at, true);
        at += 0.6 + 0.9 * (random() / 4294967296.0);
      }
    }
    if (loop.points.size() % 2 == 1)
    {
      loop.points.insert(loop.points.begin() + 1, loop.points[1] / 2);
      loop.isPin.push_back(1);
    }
    expectGood(planeCase({ loop }), 1);
  }
}

TEST(FaceFilling, NarrowSlot)
{
  const PinLoop loop = polygonLoop(
    { { 0, 0 }, { 8, 0 }, { 8, 3 }, { 3, 3 }, { 3, 3.3 }, { 8, 3.3 }, { 8, 6.6 }, { 0, 6.6 } }, 1,
    1);
  expectGood(planeCase({ loop }), 1);
}

TEST(FaceFilling, ThreeHoles)
{
  expectGood(planeCase({ polygonLoop({ { 0, 0 }, { 12, 0 }, { 12, 8 }, { 0, 8 } }, 1, 1),
               circleLoop({ 3, 3 }, 1.3, 8, 3, true), circleLoop({ 8, 5 }, 2, 11, 3, true),
               circleLoop({ 9.5, 1.6 }, 0.5, 5, 3, true) }),
    1);
}

TEST(FaceFilling, ThinStrips)
{
  for (const double width : { 0.5, 0.1, 0.01 })
  {
    EXPECT_GT(checkFill(rectangle(30, width), 1).worst, 0);
    PinLoop loop;
    for (int i = 0; i < 30; ++i)
    {
      loop.add({ i, 0 }, true);
    }
    for (int i = 0; i < 28; ++i)
    {
      loop.add({ 30 - i * 30 / 28.0, width }, true);
    }
    checkFill(planeCase({ loop }), 1);
  }
}

TEST(FaceFilling, Crescent)
{
  PinLoop loop;
  for (int i = 0; i < 40; ++i)
  {
    const double angle = kPi * i / 40;
    loop.add(5 * Vector2(std::cos(angle), std::sin(angle)), i % 4 == 0);
  }
  for (int i = 0; i < 40; ++i)
  {
    const double angle = kPi * i / 40;
    loop.add(Vector2(-5 * std::cos(angle), 3.5 * std::sin(angle)), i % 5 == 0);
  }
  checkFill(planeCase({ loop }), 1);
}

TEST(FaceFilling, Tubes)
{
  for (const int pins : { 3, 4, 6, 8, 16 })
  {
    for (const double length : { 0.3, 1.0, 2.0, 5.0, 30.0 })
    {
      FillCase c;
      const int around = 48, along = length < 1 ? 1 : 10;
      c.mesh = openCylinder(around, along, pins * 0.95 / (2 * kPi), length);
      c.isPin.assign(c.mesh.vertexCount(), 0);
      for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
      {
        const Vector3 p = c.mesh.position[c.mesh.origin[h]];
        const double at = (std::atan2(p.y(), p.x()) / (2 * kPi) + 1) * pins;
        c.isPin[c.mesh.origin[h]] |=
          c.mesh.isBoundary(h) && std::abs(at - std::round(at)) < 1e-6 ? 1 : 0;
      }
      // Edges over a third or a quarter of the way round leave the tube: without moves off it, which a run makes, a
      // quad is flat.
      const double least = pins < 5 ? -0.02 : 0;
      EXPECT_GT(checkFill(c, 1).worst, least) << pins << " pins, length " << length;
    }
  }
}

TEST(FaceFilling, Fillet)
{
  for (const double radius : { 0.2, 0.6, 1.5 })
  {
    const FillCase c = bent(refined(rectangle(20, radius * kRightAngle, 1, 3), 1),
      [&](const Vector3& p) {
        return Vector3(p.x(), radius * std::sin(p.y() / radius), radius * std::cos(p.y() / radius));
      });
    EXPECT_GT(checkFill(c, 1).worst, 0);
  }
}

TEST(FaceFilling, TorusWithOneLoop)
{
  const Mesh mesh = torus(40, 20, 4, 2);
  const FillCase c = partOf(
    mesh,
    [&](Index f)
    {
      const Vector3 p = mesh.middleOfFace(f);
      return p.x() < 0 || std::abs(p.y()) > 2.4 || p.z() < 0.3;
    },
    2);
  const Shapes shapes = checkFill(c, 1);
  EXPECT_GE(shapes.mean, 0.75);
}

TEST(FaceFilling, FineFace)
{
  const FillCase c = refined(rectangle(25, 20), 4);
  ASSERT_GT(c.mesh.faceCount(), 20000u);
  expectGood(c, 1);
}

// Whatever the size that is asked for: the pins are 0.7 to 1.6 apart, the quads' edges should be 0.33 to 3.
TEST(FaceFilling, RandomFaces)
{
  std::mt19937 random(3);
  const auto uniform = [&](double from, double to)
  { return from + (to - from) * (random() / 4294967296.0); };
  int turnedOver = 0;
  for (int i = 0; i < 60; ++i)
  {
    const double radius = uniform(1.5, 6), wave = uniform(0, 0.35), phase = uniform(0, 6);
    const int waves = static_cast<int>(random() % 5), holes = static_cast<int>(random() % 4);
    const int between = static_cast<int>(random() % 4);
    PinLoop outer = circleLoop({ 0, 0 }, radius, static_cast<int>(uniform(4, 9) * radius), between);
    for (Vector2& p : outer.points)
    {
      p *= 1 + wave * std::cos(waves * std::atan2(p.y(), p.x()) + phase);
    }
    std::vector<PinLoop> loops{ outer };
    for (int k = 0; k < holes; ++k)
    {
      const double angle = 2 * kPi * k / holes + phase;
      loops.push_back(circleLoop(Vector2(std::cos(angle), std::sin(angle)) * radius * 0.35,
        radius * uniform(0.03, 0.2), 3 + static_cast<int>(random() % 8), between + 1, true));
    }
    std::ptrdiff_t pins = 0;
    for (const PinLoop& loop : loops)
    {
      pins += std::count(loop.isPin.begin(), loop.isPin.end(), 1);
    }
    if (pins % 2 == 1)
    {
      loops[0].isPin[1] = 1;
      if (between == 0)
      {
        continue;
      }
    }
    const int refinements = static_cast<int>(random() % 4);
    const double bend =
      refinements < 2 ? 0 : uniform(0, 0.2); // else the triangles would make ridges
    const FillCase c = bent(refined(planeCase(loops), refinements),
      [&](const Vector3& p)
      { return Vector3(p.x(), p.y(), bend * (p.x() * p.x() - p.x() * p.y())); });
    turnedOver += checkFill(c, std::pow(3, uniform(-1, 1))).worst > 0 ? 0 : 1;
  }
  EXPECT_LE(turnedOver, 1); // of 1700 faces there was one
}

// All vertices on the boundary, and triangles without area along two sides.
TEST(FaceFilling, FanFromACorner)
{
  const PinLoop loop = polygonLoop({ { 0, 0 }, { 6, 0 }, { 6, 4 }, { 0, 4 } }, 1, 1);
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  for (const Vector2& p : loop.points)
  {
    points.emplace_back(p.x(), p.y(), 0);
    const auto v = static_cast<Index>(points.size() - 1);
    if (v >= 2)
    {
      triangles.push_back({ 0, v - 1, v });
    }
  }
  expectGood({ makeMesh(points, triangles), loop.isPin }, 1);
}

TEST(FaceFilling, SphereWithASmallHole)
{
  const Mesh mesh = sphere(4);
  for (const double cut : { 0.99, 0.95, 0.8 })
  {
    for (const int step : { 1, 2, 3 })
    {
      FillCase c = partOf(
        mesh, [&](Index f) { return mesh.middleOfFace(f).normalized().z() < cut; }, step);
      if (std::count(c.isPin.begin(), c.isPin.end(), 1) % 2 == 0)
      {
        EXPECT_GE(checkFill(c, 0.2).mean, 0.75);
      }
    }
  }
}

TEST(FaceFilling, SizesCount)
{
  FillCase c = refined(rectangle(12, 12), 2);
  c.mesh =
    withSizes(c.mesh, [](const Vector3& p) { return 0.3 + 0.1 * (p - Vector3(6, 6, 0)).norm(); });
  const Shapes shapes = checkFill(c, 1);
  EXPECT_NEAR(static_cast<double>(shapes.quads), sizedArea(c.mesh), 0.3 * sizedArea(c.mesh));
  EXPECT_GE(shapes.mean, 0.75);
}

TEST(FaceFilling, IsTheSameEachTime)
{
  const FillCase c =
    planeCase({ circleLoop({ 0, 0 }, 4, 26, 3), circleLoop({ 0, 0 }, 0.3, 4, 7, true) });
  const auto first = fillFace(c.mesh, c.isPin, 1), second = fillFace(c.mesh, c.isPin, 1);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->quads, second->quads);
  EXPECT_EQ(first->points, second->points);
  EXPECT_EQ(first->sourceFace, second->sourceFace);
  EXPECT_EQ(first->sourceWeights, second->sourceWeights);
}

TEST(FaceFilling, NoneForOddOrTooFewPins)
{
  const FillCase odd = planeCase({ circleLoop({ 0, 0 }, 2, 11, 0) });
  EXPECT_FALSE(fillFace(odd.mesh, odd.isPin, 1));
  FillCase few = rectangle(1, 1);
  few.isPin = { 1, 0, 1, 0 };
  EXPECT_FALSE(fillFace(few.mesh, few.isPin, 1));
  const Mesh closed = sphere(1);
  EXPECT_FALSE(fillFace(closed, std::vector<std::uint8_t>(closed.vertexCount(), 0), 1));
}

} // namespace quadrille::test
