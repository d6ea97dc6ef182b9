// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadQuality.h"
#include "MeshInput.h"
#include "Symmetry/Symmetry.h"
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

using Corners = std::array<Index, 4>;

/// The same for quads that differ by the first corner only.
Corners lowestCornerFirst(Corners quad)
{
  std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  return quad;
}

RemeshOptions asking(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.threads = 2;
  options.coarseVertices = 300;
  return options;
}

SymmetryOptions ofOrder(int order)
{
  return { std::nullopt, RotationRequest{ order, std::nullopt } };
}

SymmetryOptions round(const Vector3& direction, int order, const Vector3& origin = Vector3::Zero())
{
  return { std::nullopt, RotationRequest{ order, RotationAxis{ origin, direction } } };
}

/// The permutation maps quads to quads, and is nothing n times in a row, but not before.
void expectTurnedConnectivity(const SymmetricResult& made)
{
  const QuadMesh& quads = made.remeshed.quads;
  const std::vector<Index>& image = made.rotatedPoint;
  ASSERT_EQ(image.size(), quads.points.size());
  EXPECT_TRUE(made.mirrorPoint.empty());
  for (Index p = 0; p < image.size(); ++p)
  {
    Index at = p;
    for (int k = 0; k < made.rotation->order; ++k)
    {
      ASSERT_LT(image[at], image.size());
      at = image[at];
      EXPECT_TRUE(image[p] == p || k + 1 == made.rotation->order || at != p);
    }
    EXPECT_EQ(at, p);
    EXPECT_EQ(quads.valence[image[p]], quads.valence[p]);
    EXPECT_EQ(quads.onBoundary[image[p]], quads.onBoundary[p]);
  }
  std::set<Corners> all;
  for (const Corners& quad : quads.quads)
  {
    EXPECT_TRUE(all.insert(lowestCornerFirst(quad)).second);
  }
  for (const Corners& quad : quads.quads)
  {
    const Corners turned{ image[quad[0]], image[quad[1]], image[quad[2]], image[quad[3]] };
    EXPECT_EQ(all.count(lowestCornerFirst(turned)), 1U);
  }
}

void expectExactTurns(const SymmetricResult& made)
{
  const std::vector<Vector3>& points = made.remeshed.quads.points;
  const Isometry rotation = Isometry::of(made.rotation->axis, made.rotation->order);
  double worst = 0;
  for (Index p = 0; p < points.size(); ++p)
  {
    const Vector3 image = rotation.image(points[p]);
    worst = std::max(worst, (image - points[made.rotatedPoint[p]]).norm());
  }
  EXPECT_LE(worst, 1e-12 * made.diagonal);
  EXPECT_EQ(made.movedPoints, 0U);
}

void expectPlaces(const SymmetricResult& made, const SurfaceInput& input, double tolerance = 1e-6)
{
  const QuadMesh& quads = made.remeshed.quads;
  ASSERT_EQ(made.pointSources.size(), quads.points.size());
  ASSERT_EQ(made.quadPolygons.size(), quads.quads.size());
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    const SourceLocation& source = made.pointSources[p];
    Vector3 place = Vector3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
    {
      place += source.weights[i] * input.points[source.points[i]];
    }
    EXPECT_LE((place - quads.points[p]).norm(), tolerance * made.diagonal);
  }
}

void expectWholeTurned(const SymmetricResult& made, long long euler, bool closed)
{
  const QuadQuality quality = evaluateQuads(made.remeshed.quads.points, made.remeshed.quads.quads);
  EXPECT_TRUE(quality.manifold);
  EXPECT_EQ(quality.closed, closed);
  EXPECT_EQ(quality.eulerCharacteristic, euler);
  EXPECT_EQ(quality.nonPositiveJacobians, 0U);
  EXPECT_TRUE(made.remeshed.certificate.valid()) << made.remeshed.certificate.text();
  EXPECT_EQ(validate(made.remeshed.surface.mesh), "");
  EXPECT_TRUE(made.isAlike);
}

void expectRotational(
  const SymmetricResult& made, const SurfaceInput& input, long long euler, bool closed)
{
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectTurnedConnectivity(made);
  expectExactTurns(made);
  expectPlaces(made, input);
  expectWholeTurned(made, euler, closed);
}

TEST(Rotation, TorusOfAnyOrder)
{
  const SurfaceInput input = toInput(torus(60, 30));
  for (const int order : { 2, 3, 5, 6, 12 })
  {
    SCOPED_TRACE(order);
    const SymmetricResult made =
      remeshSymmetric(input, asking(900), round(Vector3::UnitZ(), order));
    expectRotational(made, input, 0, true);
    EXPECT_NEAR(static_cast<double>(made.remeshed.quads.quads.size()), 900, 250);
    EXPECT_EQ(made.remeshed.smallParts.handles, 1U);
  }
}

/// A ring with n teeth, of four sides with sharp edges.
Mesh gear(int teeth)
{
  const auto side = [](double v) { return 4 * v - std::floor(4 * v); };
  return parametricGrid(16 * teeth, 16, true,
    [=](double u, double v)
    {
      const double phase = u * teeth - std::floor(u * teeth);
      const double ramp = std::clamp(8 * std::abs(phase - 0.5) - 1.5, 0.0, 1.0);
      const double outer = 1 + 0.25 * ramp, inner = 0.5;
      const int k = static_cast<int>(std::floor(4 * v + 1e-9)) % 4;
      const double t = std::abs(side(v + 1e-9 / 4)) < 1e-6 ? 0 : side(v);
      const std::array<double, 5> radius{ inner, inner, outer, outer, inner };
      const std::array<double, 5> height{ 0.3, 0, 0, 0.3, 0.3 };
      const double r = (1 - t) * radius[k] + t * radius[k + 1];
      const double z = (1 - t) * height[k] + t * height[k + 1];
      return Vector3(r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), z);
    });
}

/// Five bumps round an axis through two vertices, so that triangles are symmetric, too.
Mesh bumpySphere(int level)
{
  Mesh mesh = sphere(level);
  const Vector3 axis = mesh.position.front().normalized();
  const Vector3 start = RotationAxis{ Vector3::Zero(), axis }.radial(mesh.position[5]).normalized();
  for (Vector3& p : mesh.position.editAll())
  {
    const Vector3 arm = p - axis.dot(p) * axis;
    const double angle = std::atan2(axis.dot(start.cross(arm)), start.dot(arm));
    p *= 1 + 0.15 * arm.squaredNorm() * std::cos(5 * angle) + 0.1 * axis.dot(p);
  }
  return mesh;
}

TEST(Rotation, GearKeepsItsFeatures)
{
  const SurfaceInput input = toInput(gear(6));
  for (const int order : { 2, 3, 6 })
  {
    SCOPED_TRACE(order);
    const SymmetricResult made =
      remeshSymmetric(input, asking(2500), round(Vector3::UnitZ(), order));
    expectRotational(made, input, 0, true);
  }
}

TEST(Rotation, AxisThroughTheSurface)
{
  const Mesh mesh = bumpySphere(4);
  const SurfaceInput input = toInput(mesh);
  const SymmetricResult made =
    remeshSymmetric(input, asking(800), round(sphere(1).position.front(), 5));
  expectRotational(made, input, 2, true);
  std::size_t poles = 0;
  for (Index p = 0; p < made.rotatedPoint.size(); ++p)
  {
    if (made.rotatedPoint[p] == p)
    {
      ++poles;
      EXPECT_EQ(made.remeshed.quads.valence[p] % 5, 0);
      EXPECT_LE(made.rotation->axis.radial(made.remeshed.quads.points[p]).norm(), 1e-12);
    }
  }
  EXPECT_EQ(poles, 2U);
}

TEST(Rotation, OpenTube)
{
  const SurfaceInput input = toInput(openCylinder(48, 20));
  for (const int order : { 2, 4, 16 })
  {
    SCOPED_TRACE(order);
    expectRotational(
      remeshSymmetric(input, asking(500), round(Vector3::UnitZ(), order)), input, 0, false);
  }
}

TEST(Rotation, AxisIsFound)
{
  const SurfaceInput input = toInput(gear(5));
  const SymmetricResult made = remeshSymmetric(input, asking(2000), ofOrder(5));
  expectRotational(made, input, 0, true);
  // As accurate as the coordinates.
  EXPECT_LE(made.rotation->axis.direction.cross(Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_LE(made.rotation->axis.radial(Vector3::Zero()).norm(), 1e-12 * made.diagonal);
  EXPECT_LE(made.deviation.maximum, 1e-12 * made.diagonal);
}

TEST(Rotation, NearlySymmetricSurfaceIsFollowed)
{
  const double noise = 0.005;
  Mesh mesh = bumpySphere(4);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-noise, noise);
  for (Vector3& p : mesh.position.editAll())
  {
    p += Vector3(offset(random), offset(random), offset(random));
  }
  const SurfaceInput input = toInput(mesh);
  RemeshOptions options = asking(800);
  options.featureAngle.reset();
  const SymmetricResult made = remeshSymmetric(input, options, ofOrder(5));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectTurnedConnectivity(made);
  expectPlaces(made, input);
  EXPECT_GT(made.movedPoints, 0U);
  // Both wedges are off by the noise at most, in each of three coordinates.
  EXPECT_LE(made.farthestMoved, 2 * std::sqrt(3.0) * noise + 1e-3);
  EXPECT_LE(made.deviation.maximum, 2 * std::sqrt(3.0) * noise + 1e-3);
  expectWholeTurned(made, 2, true);
}

TEST(Rotation, SameForAnyThreadsAndWithAStore)
{
  const SurfaceInput input = toInput(bumpySphere(3));
  RemeshOptions options = asking(400);
  options.mergeCharts = true;
  const SymmetricResult first = remeshSymmetric(input, options, ofOrder(5));
  ResultStore store;
  remeshSymmetric(input, options, ofOrder(5), &store);
  options.threads = 1;
  const SymmetricResult again = remeshSymmetric(input, options, ofOrder(5), &store);
  ASSERT_TRUE(first.remeshed.status.ok());
  EXPECT_EQ(again.remeshed.quads.quads, first.remeshed.quads.quads);
  EXPECT_EQ(again.remeshed.quads.points, first.remeshed.quads.points);
  EXPECT_EQ(again.rotatedPoint, first.rotatedPoint);
  EXPECT_TRUE(again.remeshed.uv == first.remeshed.uv);
  const std::vector<std::string>& reused = again.remeshed.reused;
  for (const char* stage : { "whole", "axis", "phase1", "extract" })
  {
    EXPECT_NE(std::find(reused.begin(), reused.end(), stage), reused.end()) << stage;
  }
}

Index nearestTo(const std::vector<Vector3>& points, const Vector3& p)
{
  return static_cast<Index>(
    std::min_element(points.begin(), points.end(),
      [&](const Vector3& a, const Vector3& b) { return (a - p).norm() < (b - p).norm(); }) -
    points.begin());
}

bool isNoticed(const SymmetricResult& made, const std::string& text)
{
  const std::vector<std::string>& notices = made.remeshed.notices;
  return std::any_of(notices.begin(), notices.end(),
    [&](const std::string& notice) { return notice.find(text) != std::string::npos; });
}

TEST(Rotation, ValencesOfOneWedgeAreAskedOfAll)
{
  SurfaceInput input = toInput(bumpySphere(4));
  const Vector3 axis = sphere(1).position.front();
  const Index pole = nearestTo(input.points, 0.9 * axis);
  const Index other = nearestTo(input.points, -1.1 * axis);
  // Away from the axis, wherever the wedge is.
  Index aside = 0;
  while (std::abs(input.points[aside].dot(axis)) > 0.2)
  {
    ++aside;
  }
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[aside] = 3;
  input.targetValences[pole] = 5;
  input.targetValences[other] = 4;
  const SymmetricResult made = remeshSymmetric(input, asking(1500), round(axis, 5));
  expectRotational(made, input, 2, true);
  const QuadMesh& quads = made.remeshed.quads;
  EXPECT_EQ(quads.valence[nearestTo(quads.points, input.points[pole])], 5);
  EXPECT_TRUE(isNoticed(made, "multiples of 5"));
  for (int k = 0; k < 5; ++k)
  {
    const Vector3 place = Isometry::of(made.rotation->axis, 5).image(input.points[aside], k);
    const Index p = nearestTo(quads.points, place);
    EXPECT_LE((quads.points[p] - place).norm(), 1e-9);
    EXPECT_EQ(quads.valence[p], 3);
  }
}

TEST(Rotation, SizesOfOneWedgeAreAskedOfAll)
{
  // Smaller quads at one place beside the axis only.
  SurfaceInput input = toInput(torus(60, 30));
  const Vector3 place(1.4, 0, 0);
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back((p - place).norm() < 0.35 ? 0.4F : 1.0F);
  }
  const SymmetricResult made = remeshSymmetric(input, asking(1500), round(Vector3::UnitZ(), 3));
  expectRotational(made, input, 0, true);
  const QuadMesh& quads = made.remeshed.quads;
  const auto lengthNear = [&](double angle)
  {
    const Vector3 at(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0);
    double sum = 0, count = 0;
    for (const Corners& quad : quads.quads)
    {
      const bool isNear = (quads.points[quad[0]] - at).norm() < 0.25;
      sum += isNear ? (quads.points[quad[1]] - quads.points[quad[0]]).norm() : 0;
      count += isNear ? 1 : 0;
    }
    return sum / count;
  };
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_LT(lengthNear(2 * kPi / 3 * k), 0.75 * lengthNear(2 * kPi / 3 * (k + 0.5)));
  }
}

TEST(Rotation, CurvesInOneWedgeAreMet)
{
  SurfaceInput input = toInput(torus(60, 30));
  CurveRequest acrossTube{ CurveKind::Cycle, {} };
  CurveRequest around{ CurveKind::Cycle, {} };
  for (int i = 0; i < 24; ++i)
  {
    const double angle = i * kPi / 12;
    const double radius = 1 + 0.4 * std::cos(angle);
    // Not where the torus is cut: that is told by the wedge that is made first, near 2 degrees.
    acrossTube.points.emplace_back(
      radius * std::cos(2.6), radius * std::sin(2.6), 0.4 * std::sin(angle));
    around.points.emplace_back(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0);
  }
  input.curves = { around, acrossTube };
  const SymmetricResult made = remeshSymmetric(input, asking(900), round(Vector3::UnitZ(), 3));
  expectRotational(made, input, 0, true);
  ASSERT_EQ(made.remeshed.curves.size(), 2U);
  EXPECT_FALSE(made.remeshed.curves[0].met);
  EXPECT_NE(made.remeshed.curves[0].why.find("crosses a cut"), std::string::npos);
  EXPECT_TRUE(made.remeshed.curves[1].met) << made.remeshed.curves[1].why;
}

std::string refusalOf(const SurfaceInput& input, const SymmetryOptions& symmetry)
{
  try
  {
    remeshSymmetric(input, asking(200), symmetry);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return "";
}

TEST(Rotation, RefusesWhatIsNone)
{
  const SurfaceInput ball = toInput(sphere(3));
  const auto expectWords = [](const std::string& text, const char* words)
  { EXPECT_NE(text.find(words), std::string::npos) << text; };
  expectWords(refusalOf(ball, round(Vector3::UnitZ(), 1)), "2 to 64, not 1");
  expectWords(refusalOf(ball, round(Vector3::UnitZ(), 65)), "2 to 64, not 65");
  expectWords(refusalOf(ball, round(Vector3::Zero(), 3)), "direction");
  expectWords(refusalOf(ball, round(Vector3::UnitZ(), 3, Vector3(NAN, 0, 0))), "origin");
  expectWords(refusalOf(ball, round(Vector3::UnitZ(), 3, Vector3(1, 0, 0))), "not symmetric");
  expectWords(refusalOf(ball, round(Vector3::UnitZ(), 20)), "cut a hole round the axis");
  // Two balls of three.
  const SurfaceInput apart = toInput(disjointUnion(sphere(2), sphere(2), Vector3(2.2, 0, 0)));
  EXPECT_NE(refusalOf(apart, round(Vector3::UnitZ(), 3, Vector3(1.1, 0, 0))), "");
}

TEST(Rotation, PartsThatNoCutMeets)
{
  // Each wedge has one of the balls, whole.
  Mesh mesh = sphere(3);
  Mesh all;
  for (int k = 0; k < 3; ++k)
  {
    Mesh ball = mesh;
    const RotationAxis axis{ Vector3(-2, 0, 0), Vector3::UnitZ() };
    for (Vector3& p : ball.position.editAll())
    {
      p = Isometry::of(axis, 3).image(p, k);
    }
    all = k == 0 ? ball : disjointUnion(all, ball, Vector3::Zero());
  }
  const SurfaceInput input = toInput(all);
  const SymmetricResult made =
    remeshSymmetric(input, asking(600), round(Vector3::UnitZ(), 3, Vector3(-2, 0, 0)));
  expectRotational(made, input, 6, true);
}

TEST(Rotation, StopsOnRequest)
{
  RemeshOptions options = asking(300);
  options.progress = [](double fraction, const std::string&) { return fraction < 0.05; };
  const SymmetricResult made =
    remeshSymmetric(toInput(torus(40, 20)), options, round(Vector3::UnitZ(), 4));
  EXPECT_EQ(made.remeshed.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(made.remeshed.quads.quads.empty());
}

} // namespace
} // namespace quadrille
