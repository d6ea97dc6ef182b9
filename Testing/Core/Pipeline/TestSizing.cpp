// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes from the input to the quads.
#include "Pipeline/Pipeline.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

using SizeNear = std::function<double(const Vector3&)>;

SurfaceInput withSizes(const Mesh& mesh, const SizeNear& size)
{
  SurfaceInput input = toInput(mesh);
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back(static_cast<float>(size(p)));
  }
  return input;
}

/// The root of the mean area of the quads whose middle is wanted: their size, whatever their shape.
double meanSize(const QuadMesh& quads, const std::function<bool(const Vector3&)>& wants)
{
  double area = 0;
  std::size_t count = 0;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    const Vector3 middle = (quads.points[quad[0]] + quads.points[quad[1]] + quads.points[quad[2]] +
                             quads.points[quad[3]]) /
      4;
    if (wants(middle))
    {
      area += (quads.points[quad[2]] - quads.points[quad[0]])
                .cross(quads.points[quad[3]] - quads.points[quad[1]])
                .norm() /
        2;
      ++count;
    }
  }
  EXPECT_GT(count, 0U);
  return std::sqrt(area / static_cast<double>(count));
}

/// Mean length of the quads' edges whose middle is wanted.
double meanEdge(const QuadMesh& quads, const std::function<bool(const Vector3&)>& wants)
{
  double sum = 0;
  std::size_t count = 0;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Vector3& a = quads.points[quad[i]];
      const Vector3& b = quads.points[quad[(i + 1) % 4]];
      if (wants((a + b) / 2))
      {
        sum += (b - a).norm();
        ++count;
      }
    }
  }
  EXPECT_GT(count, 0U);
  return sum / static_cast<double>(count);
}

RemeshResult remeshWith(const SurfaceInput& input, std::size_t quads, int threads = 2)
{
  RemeshOptions options;
  options.quads = quads;
  options.threads = threads;
  RemeshResult result = remesh(input, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
  EXPECT_NEAR(static_cast<double>(result.quads.quads.size()), static_cast<double>(quads),
    0.15 * static_cast<double>(quads));
  return result;
}

/// Half of the surface, beyond `z`, asks for edges half as long. Away from where sizes grow the ratio of mean lengths
/// is 2 up to 15 %.
void expectHalves(const Mesh& mesh, std::size_t quads, double middle, double away)
{
  const auto fine = [=](const Vector3& p) { return p.x() > middle + away / 4; };
  const auto coarse = [=](const Vector3& p) { return p.x() < middle - away; };
  const RemeshResult result = remeshWith(
    withSizes(mesh, [=](const Vector3& p) { return p.x() > middle ? 0.5 : 1.0; }), quads);
  const double edges = meanEdge(result.quads, coarse) / meanEdge(result.quads, fine);
  EXPECT_NEAR(edges, 2, 0.3);
  const double sizes = meanSize(result.quads, coarse) / meanSize(result.quads, fine);
  EXPECT_NEAR(sizes, 2, 0.3);
}

TEST(Sizing, HalfASphereHasQuadsHalfAsLong)
{
  expectHalves(sphere(5), 3000, 0, 0.3);
}

TEST(Sizing, HalfATorusHasQuadsHalfAsLong)
{
  expectHalves(torus(160, 80), 3000, 0, 0.4);
}

TEST(Sizing, HalfAPlateHasQuadsHalfAsLong)
{
  expectHalves(gridPlane(60, 60), 2000, 30, 8);
}

TEST(Sizing, HalfACubeHasQuadsHalfAsLong)
{
  expectHalves(unitCube(20), 3000, 0.5, 0.15);
}

/// From 0.5 to 1.5 over a length of 20.
SurfaceInput growingCylinder()
{
  return withSizes(openCylinder(60, 200, 2, 20), [](const Vector3& p) { return 0.5 + p.z() / 20; });
}

TEST(Sizing, SizesMayGrowAlongASurface)
{
  const RemeshResult result = remeshWith(growingCylinder(), 3000);
  for (const double z : { 2.0, 6.0, 10.0, 14.0, 18.0 })
  {
    const auto near = [=](const Vector3& p) { return std::abs(p.z() - z) < 2; };
    const double wanted = 0.5 + z / 20;
    EXPECT_NEAR(meanSize(result.quads, near) / result.targetEdgeLength, wanted, 0.15 * wanted);
  }
}

TEST(Sizing, EdgeLengthIsFollowedWhereItIsAskedFor)
{
  RemeshOptions options;
  options.edgeLength = 0.4;
  options.threads = 2;
  const RemeshResult result = remesh(growingCylinder(), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  // The integral of 2 pi 2 / (0.4 (0.5 + z / 20))^2 over 20.
  const double expected = 4 * kPi / 0.16 * 20 * (1 / 0.5 - 1 / 1.5);
  EXPECT_NEAR(static_cast<double>(result.targetQuads), expected, 0.02 * expected);
  EXPECT_NEAR(static_cast<double>(result.quads.quads.size()), expected, 0.15 * expected);
  EXPECT_EQ(result.targetEdgeLength, 0.4);
}

TEST(Sizing, LevelsFollowTheSizes)
{
  const RemeshResult result = remeshWith(growingCylinder(), 3000);
  ASSERT_EQ(result.coarse.mesh.sizing.size(), result.coarse.mesh.position.size());
  for (Index v = 0; v < result.coarse.mesh.vertexCount(); ++v)
  {
    EXPECT_EQ(
      result.coarse.mesh.sizing[v], result.surface.mesh.sizing[result.coarse.fineVertex[v]]);
  }
}

TEST(Sizing, StepsAreSmoothedAndTold)
{
  const RemeshResult result = remeshWith(
    withSizes(torus(160, 80), [](const Vector3& p) { return p.x() > 0 ? 0.3 : 1.0; }), 3000);
  EXPECT_TRUE(std::any_of(result.notices.begin(), result.notices.end(),
    [](const std::string& text) { return text.find("grow gradually") != std::string::npos; }));
}

/// An ellipsoid with the half axes 3, 1, 1: the curvature is 3 at its tips, and at most 1 round its middle.
Mesh ellipsoid()
{
  Mesh mesh = sphere(5);
  for (Vector3& p : mesh.position.editAll())
  {
    p.x() *= 3;
  }
  return mesh;
}

TEST(Sizing, TheChordErrorDistributesTheQuads)
{
  RemeshOptions options;
  options.quads = 2500;
  options.threads = 2;
  options.featureAngle.reset();
  options.sizes.chordError = 0.0015;
  options.sizes.smallest = 0.1;
  const RemeshResult result = remesh(toInput(ellipsoid()), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_NEAR(static_cast<double>(result.quads.quads.size()), 2500, 0.12 * 2500);
  const auto nearTip = [](const Vector3& p) { return std::abs(p.x()) > 2.9; };
  const auto middle = [](const Vector3& p) { return std::abs(p.x()) < 0.5; };
  // sqrt(3), less what growth and irregular vertices take.
  EXPECT_GT(meanSize(result.quads, middle) / meanSize(result.quads, nearTip), 1.4);
  EXPECT_TRUE(std::any_of(result.notices.begin(), result.notices.end(),
    [](const std::string& text)
    { return text.find("quads get sizes from") != std::string::npos; }));
}

TEST(Sizing, TheChordErrorIsMetWhereAnEdgeLengthIsAskedFor)
{
  RemeshOptions options;
  options.edgeLength = 0.5;
  options.threads = 2;
  options.featureAngle.reset();
  options.sizes.chordError = 0.005;
  const RemeshResult result = remesh(toInput(sphere(5)), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.targetEdgeLength, 0.5);
  const auto everywhere = [](const Vector3&) { return true; };
  const double wanted = std::sqrt(8 * 0.005);
  EXPECT_NEAR(meanEdge(result.quads, everywhere), wanted, 0.1 * wanted);
  double error = 0;
  std::size_t count = 0;
  for (const std::array<Index, 4>& quad : result.quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i, ++count)
    {
      error +=
        1 - ((result.quads.points[quad[i]] + result.quads.points[quad[(i + 1) % 4]]) / 2).norm();
    }
  }
  EXPECT_NEAR(error / static_cast<double>(count), 0.005, 0.001);
}

TEST(Sizing, ThinPartsGetAsManyQuadsAsAskedFor)
{
  Mesh mesh = unitCube(12);
  for (Vector3& p : mesh.position.editAll())
  {
    p = Vector3(2 * p.x(), p.y(), 0.15 * p.z());
  }
  RemeshOptions options;
  options.edgeLength = 0.15;
  options.threads = 2;
  options.sizes.gapQuads = 3;
  const RemeshResult result = remesh(toInput(mesh), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_NEAR(meanEdge(result.quads, [](const Vector3&) { return true; }), 0.05, 0.01);
}

TEST(Sizing, AdaptiveSizesDoNotDependOnThreadsOrMemory)
{
  const SurfaceInput input = toInput(ellipsoid());
  RemeshOptions options;
  options.quads = 800;
  options.threads = 1;
  options.sizes.chordError = 0.01;
  const RemeshResult one = remesh(input, options);
  ASSERT_TRUE(one.status.ok()) << one.status.message;
  ResultStore store(1'000'000'000);
  options.threads = 3;
  for (int run = 0; run < 2; ++run)
  {
    const RemeshResult other = remesh(input, options, store);
    EXPECT_EQ(other.quads.points, one.quads.points);
    EXPECT_EQ(other.targetEdgeLength, one.targetEdgeLength);
  }
  options.sizes.chordError = 0.002;
  const RemeshResult finer = remesh(input, options, store);
  ASSERT_TRUE(finer.status.ok()) << finer.status.message;
  EXPECT_NE(finer.quads.points, one.quads.points);
  options.sizes = {};
  EXPECT_EQ(remesh(input, options, store).quads.points, remesh(input, options).quads.points);
}

TEST(Sizing, SameResultForAnyNumberOfThreads)
{
  const SurfaceInput input =
    withSizes(torus(160, 80), [](const Vector3& p) { return p.x() > 0 ? 0.5 : 1.0; });
  const RemeshResult one = remeshWith(input, 2000, 1);
  for (const int threads : { 2, 4 })
  {
    const RemeshResult other = remeshWith(input, 2000, threads);
    EXPECT_EQ(other.quads.quads, one.quads.quads);
    EXPECT_EQ(other.quads.points, one.quads.points);
  }
}

TEST(Sizing, OneSizeEverywhereIsAnotherEdgeLength)
{
  const Mesh mesh = torus(100, 50);
  RemeshOptions options;
  options.edgeLength = 0.2;
  const RemeshResult sized = remesh(withSizes(mesh, [](const Vector3&) { return 0.5; }), options);
  options.edgeLength = 0.1;
  const RemeshResult plain = remesh(toInput(mesh), options);
  ASSERT_TRUE(sized.status.ok()) << sized.status.message;
  EXPECT_EQ(sized.targetQuads, plain.targetQuads);
  EXPECT_NEAR(static_cast<double>(sized.quads.quads.size()),
    static_cast<double>(plain.quads.quads.size()),
    0.1 * static_cast<double>(plain.quads.quads.size()));
}

TEST(Sizing, WrongSizesAreRefused)
{
  SurfaceInput input = withSizes(torus(20, 10), [](const Vector3&) { return 1; });
  input.sizing[7] = 0;
  RemeshOptions options;
  options.quads = 100;
  EXPECT_THROW(remesh(input, options), InvalidInput);
}

} // namespace
} // namespace quadrille
