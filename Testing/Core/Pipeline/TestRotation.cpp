// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadQuality.h"
#include "MeshInput.h"
#include "Pipeline/Symmetry.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

using Corners = std::array<Index, 4>;

/// The same for quads that differ by the first corner only.
Corners sorted(Corners quad)
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
    EXPECT_TRUE(all.insert(sorted(quad)).second);
  }
  for (const Corners& quad : quads.quads)
  {
    const Corners turned{ image[quad[0]], image[quad[1]], image[quad[2]], image[quad[3]] };
    EXPECT_EQ(all.count(sorted(turned)), 1U);
  }
}

void expectExactTurns(const SymmetricResult& made)
{
  const std::vector<Vector3>& points = made.remeshed.quads.points;
  double worst = 0;
  for (Index p = 0; p < points.size(); ++p)
  {
    const Vector3 image = made.rotation->axis.image(points[p], 1, made.rotation->order);
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
  for (Vector3& p : mesh.position)
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
  expectRotational(remeshSymmetric(input, asking(2000), ofOrder(5)), input, 0, true);
}

} // namespace
} // namespace quadrille
