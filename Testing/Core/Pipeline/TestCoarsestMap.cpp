// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The coarsest layouts of quads.
#include "Pipeline/Pipeline.h"

#include "Evaluation/QuadQuality.h"
#include "Mesh/Topology.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

namespace quadrille
{
namespace
{

RemeshResult coarsest(const Mesh& mesh, std::size_t quads, bool smallest = true)
{
  RemeshOptions options;
  options.quads = quads;
  options.coarsestIntegers = smallest;
  options.coarseVertices = 400;
  options.threads = 2;
  RemeshResult result = remesh(test::toInput(mesh), options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.coarseCertificate.valid()) << result.coarseCertificate.text();
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
  EXPECT_EQ(evaluateQuads(result.quads.points, result.quads.quads).eulerCharacteristic,
    summarizeTopology(mesh).eulerCharacteristic);
  return result;
}

TEST(CoarsestMap, BoxHasOneQuadASide)
{
  const Mesh box = test::voxelSurface({ 3, 2, 1 }, 4, [](int, int, int) { return true; });
  EXPECT_EQ(coarsest(box, 500).quads.quads.size(), 6U);
  EXPECT_GT(coarsest(box, 500, false).quads.quads.size(), 400U);
}

TEST(CoarsestMap, TorusAndCylinderHaveTheFewestThatAreSound)
{
  // With fewer than three quads round a loop they would touch themselves.
  const std::size_t ring = coarsest(test::torus(60, 30), 800).quads.quads.size();
  EXPECT_GE(ring, 9U);
  EXPECT_LE(ring, 100U);
  const std::size_t tube = coarsest(test::openCylinder(60, 30), 700).quads.quads.size();
  EXPECT_GE(tube, 3U);
  EXPECT_LE(tube, 50U);
}

TEST(CoarsestMap, SphereHasFewQuads)
{
  EXPECT_LE(coarsest(test::sphere(4), 600).quads.quads.size(), 30U);
}

TEST(CoarsestMap, GenusTwoKeepsItsHandles)
{
  EXPECT_LE(coarsest(test::doubleTorus(4), 1500).quads.quads.size(), 300U);
}

TEST(CoarsestMap, NeedsTheScaleAwareMethod)
{
  RemeshOptions options;
  options.quads = 100;
  options.coarsestIntegers = true;
  options.method = MapMethod::QuadCover;
  EXPECT_THROW(remesh(test::toInput(test::torus(20, 10)), options), InvalidInput);
}

} // namespace
} // namespace quadrille
