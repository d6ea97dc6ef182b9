// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run tells of sharp edges that its quads do not follow.
#include "Pipeline/FaceDivision.h"
#include "Pipeline/Pipeline.h"
#include "Prepare/Prepare.h"

#include "Base/Angles.h"
#include "MeshInput.h"
#include "StaggeredTube.h"
#include "TestMeshes.h"

#include "Mesh/Topology.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// A block with a groove of one voxel, a step of one and a bump of one voxel in its top: for s = 3 voxels the bump is too
/// small.
Mesh groovedBlock(double scale)
{
  Mesh mesh = test::voxelSurface({ 24, 16, 12 }, 1,
    [](int i, int j, int k) {
      return k < 11 || (i > 12 && j != 8) || (k == 11 && i == 4) || (k == 11 && i == 8 && j == 6);
    });
  for (Vector3& p : mesh.position.editAll())
  {
    p *= scale;
  }
  return mesh;
}

RemeshOptions quadsOfLength(double edgeLength)
{
  RemeshOptions options;
  options.edgeLength = edgeLength;
  options.threads = 1;
  return options;
}

double lengthOfFeatures(const Mesh& mesh)
{
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool isOne = mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h];
    length += isOne ? mesh.edgeVector(h).norm() : 0;
  }
  return length;
}

double givenUpLength(const RemeshResult& result)
{
  double length = 0;
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    length += curve.length;
  }
  return length;
}

TEST(GivenUpFeatures, WithThoseThatStayTheyAreAllThereWere)
{
  PrepareOptions prepare;
  prepare.featureAngle = radians(40);
  const Mesh block = groovedBlock(1);
  const PreparedSurface before = prepareSurface(test::toInput(block), prepare);
  RemeshOptions options = quadsOfLength(3);
  options.featureAngle = radians(40);
  const RemeshResult result = remesh(test::toInput(block), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_FALSE(result.givenUpFeatures.empty());
  // Lengths of the input, to the rounding of the frame's grid.
  EXPECT_NEAR(givenUpLength(result) + lengthOfFeatures(result.surface.mesh),
    lengthOfFeatures(before.mesh), 1e-4);
  EXPECT_TRUE(std::any_of(result.givenUpFeatures.begin(), result.givenUpFeatures.end(),
    [](const GivenUpCurve& curve) { return curve.reason == FeatureLoss::Unresolved; }));
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    EXPECT_NEAR(curve.lengthInQuads, curve.length / result.targetEdgeLength, 1e-6);
    EXPECT_TRUE((curve.place.array() >= -1e-4).all() && curve.place.x() < 24.0001 &&
      curve.place.y() < 16.0001 && curve.place.z() < 12.0001);
  }
}

TEST(GivenUpFeatures, ThreadsAndScaleChangeNothing)
{
  RemeshOptions options = quadsOfLength(3);
  const RemeshResult one = remesh(test::toInput(groovedBlock(1)), options);
  options.threads = 3;
  ResultStore store;
  for (int again = 0; again < 2; ++again) // the second time from the store
  {
    const RemeshResult other = remesh(test::toInput(groovedBlock(1)), options, store);
    ASSERT_EQ(one.givenUpFeatures.size(), other.givenUpFeatures.size());
    for (std::size_t i = 0; i < one.givenUpFeatures.size(); ++i)
    {
      EXPECT_EQ(one.givenUpFeatures[i].place, other.givenUpFeatures[i].place);
      EXPECT_EQ(one.givenUpFeatures[i].length, other.givenUpFeatures[i].length);
    }
    EXPECT_EQ(one.quads.points, other.quads.points);
  }
  // A power of two changes no bit but the exponent's.
  const RemeshResult large = remesh(test::toInput(groovedBlock(1024)), quadsOfLength(3 * 1024));
  ASSERT_EQ(one.givenUpFeatures.size(), large.givenUpFeatures.size());
  for (std::size_t i = 0; i < one.givenUpFeatures.size(); ++i)
  {
    EXPECT_EQ(1024 * one.givenUpFeatures[i].place, large.givenUpFeatures[i].place);
    EXPECT_EQ(1024 * one.givenUpFeatures[i].length, large.givenUpFeatures[i].length);
    EXPECT_EQ(one.givenUpFeatures[i].lengthInQuads, large.givenUpFeatures[i].lengthInQuads);
  }
}

/// Four patches that no map has with all their borders, see there: where these yield, or are edges of a design, all
/// stay, and faces are filled.
TEST(GivenUpFeatures, FacesBetweenBordersAreFilled)
{
  const test::PatchedMesh tube = test::staggeredTube(0.02);
  const Mesh& mesh = tube.mesh;
  std::vector<std::uint8_t> borders(mesh.faceCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool isBorder =
      !mesh.isBoundary(h) && tube.patch[Mesh::face(h)] != tube.patch[Mesh::face(mesh.twin[h])];
    borders[Mesh::face(h)] |= static_cast<std::uint8_t>(isBorder ? 1U << h % 3 : 0U);
  }
  for (const auto& [isDesign, yields] :
    { std::pair(false, false), { false, true }, { true, true } })
  {
    SurfaceInput input = test::toInput(mesh);
    RemeshOptions options;
    options.quads = 300;
    options.threads = 1;
    if (isDesign)
    {
      input.featureEdges = borders;
      input.featuresYield = yields;
      options.featureAngle.reset();
    }
    else
    {
      input.patchIds = tube.patch;
      input.patchesYield = yields;
    }
    const RemeshResult result = remesh(input, options);
    if (!yields)
    {
      EXPECT_FALSE(result.status.ok()); // what was marked stays
      continue;
    }
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(std::any_of(result.notices.begin(), result.notices.end(),
      [](const std::string& text)
      { return text.find("between sharp edges") != std::string::npos; }));
    EXPECT_EQ(result.tries.led[static_cast<std::size_t>(Try::FilledFaces)], 1U);
    EXPECT_TRUE(result.givenUpFeatures.empty());
    EXPECT_GT(result.certificate.withoutMap, 0U);
    EXPECT_EQ(result.certificate.withoutMap + result.certificate.triangles,
      result.surface.mesh.faceCount());
    EXPECT_EQ(result.uv.size(), result.surface.mesh.halfEdgeCount());
    EXPECT_EQ(validate(result.surface.mesh), "");
    const QuadTopology topology = analyzeQuads(result.quads.quads, result.quads.points.size());
    EXPECT_TRUE(topology.manifold()) << topology.text();
    EXPECT_EQ(topology.boundaryLoops, countBoundaryLoops(mesh, boundaryHalfEdges(mesh)));
    options.threads = 2;
    const RemeshResult again = remesh(input, options);
    EXPECT_EQ(again.quads.points, result.quads.points);
    EXPECT_EQ(again.quads.quads, result.quads.quads);
  }
}

/// With a gap that quads fit into nothing gives way, and the result is the one without the permission.
TEST(GivenUpFeatures, BordersWithRoomStay)
{
  const test::PatchedMesh wide = test::staggeredTube(0.3);
  SurfaceInput input = test::toInput(wide.mesh);
  input.patchIds = wide.patch;
  RemeshOptions options;
  options.quads = 1500;
  options.threads = 1;
  const RemeshResult asked = remesh(input, options);
  input.patchesYield = true;
  const RemeshResult yielding = remesh(input, options);
  ASSERT_TRUE(asked.status.ok()) << asked.status.message;
  EXPECT_EQ(asked.certificate.withoutMap, 0U);
  EXPECT_EQ(yielding.quads.points, asked.quads.points);
}

/// The left half of a plate is cut out. Quads of the right half have no points at the ends of the line between them,
/// but near them on the outer boundary, which is none of the left half.
TEST(FaceDivision, PointsBesideTheEndsOfTheCutAreLedThere)
{
  const Mesh mesh = test::gridPlane(8, 4);
  const auto isOnLine = [&](Index h)
  { return mesh.position[mesh.origin[h]].x() == 4 && mesh.position[mesh.target(h)].x() == 4; };
  SurfaceInput input = test::toInput(mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    std::uint8_t bits = 0;
    for (Index i = 0; i < 3; ++i)
    {
      bits = static_cast<std::uint8_t>(bits | (isOnLine(3 * f + i) ? 1U << i : 0U));
    }
    input.featureEdges.push_back(bits);
  }
  PreparedSurface prepared = prepareSurface(input, {});
  std::vector<Index> left;
  for (Index f = 0; f < prepared.mesh.faceCount(); ++f)
  {
    if (prepared.mesh.middleOfFace(f).x() < 4)
    {
      left.push_back(f);
    }
  }
  SizedSurface whole;
  whole.surface = std::make_shared<const PreparedSurface>(std::move(prepared));
  whole.edgeLength = 1;
  whole.targetQuads = 32;
  const CutFaces cut = cutFaces(whole, { left, {} }, 1);
  ASSERT_TRUE(cut.rest);
  QuadMesh quads;
  quads.points = { Vector3(4.1, 0, 0), Vector3(8, 0, 0), Vector3(8, 1.4, 0), Vector3(4, 1.4, 0),
    Vector3(8, 2.7, 0), Vector3(4, 2.7, 0), Vector3(8, 4, 0), Vector3(4.2, 4, 0) };
  quads.quads = { { 0, 1, 2, 3 }, { 3, 2, 4, 5 }, { 5, 4, 6, 7 } };
  const Mesh& restMesh = cut.rest->sized.surface->mesh;
  const FilledPart filled = fillCutFaces(cut, &restMesh, &quads, 1);
  EXPECT_TRUE(filled.failedAt.empty());
  ASSERT_EQ(filled.points, std::vector<Index>({ 0, 3, 5, 7 }));
  EXPECT_EQ(filled.quads.points[0], Vector3(4, 0, 0));
  EXPECT_LT((filled.quads.points[1] - quads.points[3]).norm(), 1e-9);
  EXPECT_LT((filled.quads.points[2] - quads.points[5]).norm(), 1e-9);
  EXPECT_EQ(filled.quads.points[3], Vector3(4, 4, 0));
}

} // namespace
} // namespace quadrille
