// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Pipeline.h"

#include "Base/Error.h"
#include "Evaluation/QuadQuality.h"
#include "Mesh/SurfaceParts.h"
#include "MeshInput.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SmallDetails.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{
namespace
{

RemeshResult remeshBy(const Mesh& mesh, std::size_t quads, SmallDetails decision)
{
  RemeshOptions options;
  options.quads = quads;
  options.smallDetails = decision;
  return remesh(test::toInput(mesh), options);
}

std::size_t count(const RemeshResult& result, DetailKind kind, DetailDecision decision)
{
  return static_cast<std::size_t>(std::count_if(result.details.begin(), result.details.end(),
    [&](const SmallDetail& detail) { return detail.kind == kind && detail.decision == decision; }));
}

bool tellsOf(const RemeshResult& result, const std::string& words)
{
  return std::any_of(result.notices.begin(), result.notices.end(),
    [&](const std::string& notice) { return notice.find(words) != std::string::npos; });
}

QuadQuality qualityOf(const RemeshResult& result)
{
  return evaluateQuads(result.quads.points, result.quads.quads);
}

/// 60 x 60 cells with four holes of one cell (4 long round) and one of 4 x 4 cells (16 long).
Mesh plate()
{
  return test::planeCells(60, 60,
    [](int x, int y)
    {
      const bool tiny = (x == 10 || x == 45) && (y == 12 || y == 48);
      return !tiny && !(x >= 28 && x < 32 && y >= 28 && y < 32);
    });
}

const Vector3 kHandlePlace = Vector3(1, 2, 3).normalized();

/// The number of quads with which a loop of this length on the unit sphere is so many edge lengths long.
std::size_t quadsFor(double length, double edgeLengths)
{
  return static_cast<std::size_t>(4 * test::kPi * std::pow(edgeLengths / length, 2));
}

TEST(SmallDetails, HandleBelowAnEdgeLengthIsClosed)
{
  const test::SphereWithHandle model = test::sphereWithHandle(5, kHandlePlace);
  const RemeshResult result =
    remeshBy(model.mesh, quadsFor(model.mouthLength, 0.8), SmallDetails::Automatic);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
  EXPECT_EQ(qualityOf(result).eulerCharacteristic, 2);
  EXPECT_EQ(qualityOf(result).nonPositiveJacobians, 0U);
  EXPECT_EQ(result.surface.repair.closedHandles, 1U);
  ASSERT_EQ(result.details.size(), 1U);
  const SmallDetail& handle = result.details.front();
  EXPECT_EQ(handle.kind, DetailKind::Handle);
  EXPECT_EQ(handle.decision, DetailDecision::Simplify);
  EXPECT_EQ(handle.result, "cut and closed");
  EXPECT_GT(handle.size, 0);
  EXPECT_LT(handle.size, 0.81);
  EXPECT_LT((handle.place - kHandlePlace).norm(), 0.2);
  EXPECT_TRUE(tellsOf(result, "1 handle was cut and closed, as quads of this size cannot show"));
  EXPECT_EQ(result.attempts, std::vector<std::string>{ "first" });
}

TEST(SmallDetails, LongerHandleIsResolved)
{
  const test::SphereWithHandle model = test::sphereWithHandle(5, kHandlePlace);
  const RemeshResult result =
    remeshBy(model.mesh, quadsFor(model.mouthLength, 2.5), SmallDetails::Automatic);
  EXPECT_EQ(count(result, DetailKind::Handle, DetailDecision::Resolve), 1U);
  EXPECT_EQ(result.details.size(), 1U);
  EXPECT_EQ(result.surface.repair.closedHandles, 0U);
  EXPECT_FALSE(tellsOf(result, "cut and closed"));
  EXPECT_TRUE(tellsOf(result, "quads are made smaller round 1 handles and holes"));
}

TEST(SmallDetails, HolesBelowAnEdgeLengthAreFilledAndLongerOnesResolved)
{
  // s = 6: 0.67 edge lengths round the tiny ones, 2.7 round the other.
  const RemeshResult result = remeshBy(plate(), 100, SmallDetails::Automatic);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).boundaryLoops, 2U);
  EXPECT_EQ(result.surface.repair.filledHoles, 4U);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Simplify), 4U);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Resolve), 1U);
  EXPECT_TRUE(tellsOf(result, "4 holes were filled, as quads of this size cannot show them"));
  for (const SmallDetail& detail : result.details)
  {
    const bool isTiny = detail.decision == DetailDecision::Simplify;
    // The edge length follows from the area without the holes.
    EXPECT_NEAR(detail.size * result.targetEdgeLength, isTiny ? 4 : 16, 1e-5);
    const Vector3 middle = isTiny
      ? Vector3(detail.place.x() < 30 ? 10.5 : 45.5, detail.place.y() < 30 ? 12.5 : 48.5, 0)
      : Vector3(30, 30, 0);
    EXPECT_LT((detail.place - middle).norm(), isTiny ? 0.8 : 2.9);
  }
  // What is filled lies under quads, whose sources are cells of the input.
  const std::size_t cells = test::toInput(plate()).polygonOffsets.size() - 1;
  for (const Index f : result.quads.quadSourceFace)
  {
    EXPECT_LT(result.surface.sourcePolygon[f], cells);
  }
}

TEST(SmallDetails, ResolveKeepsTheTopology)
{
  const RemeshResult result = remeshBy(plate(), 100, SmallDetails::Resolve);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).boundaryLoops, 6U);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Resolve), 5U);
  EXPECT_EQ(result.details.size(), 5U);
  EXPECT_EQ(result.surface.repair.filledHoles, 0U);
}

TEST(SmallDetails, ResolveTakesAsManyQuadsAsItNeeds)
{
  // Twenty-five holes a quarter of an edge length round: with four quads each there are many times the sixteen.
  const Mesh mesh = test::planeCells(40, 40, [](int x, int y) { return x % 8 != 4 || y % 8 != 4; });
  const RemeshResult result = remeshBy(mesh, 16, SmallDetails::Resolve);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Resolve), 25U);
  EXPECT_GT(result.targetQuads, 2 * 16U);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).boundaryLoops, 26U);
  // Automatic fills them instead.
  const RemeshResult filled = remeshBy(mesh, 16, SmallDetails::Automatic);
  ASSERT_TRUE(filled.status.ok()) << filled.status.message;
  EXPECT_EQ(filled.targetQuads, 16U);
  EXPECT_EQ(qualityOf(filled).boundaryLoops, 1U);
}

TEST(SmallDetails, AutomaticFillsLongerOnesWhereAllWouldTakeTooMany)
{
  // Loops of 1.28 edge lengths, so close to each other that there would be small quads everywhere.
  const Mesh mesh = test::planeCells(40, 40, [](int x, int y) { return x % 4 != 2 || y % 4 != 2; });
  const RemeshResult result = remeshBy(mesh, 150, SmallDetails::Automatic);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).boundaryLoops, 1U);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Simplify), 100U);
}

TEST(SmallDetails, SimplifyTakesAllOut)
{
  const RemeshResult result = remeshBy(plate(), 100, SmallDetails::Simplify);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).boundaryLoops, 1U);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Simplify), 5U);
  EXPECT_EQ(result.details.size(), 5U);
  EXPECT_EQ(result.attempts.size(), 1U);
}

TEST(SmallDetails, KeepLeavesSurfaceAndSizes)
{
  const RemeshResult result = remeshBy(plate(), 100, SmallDetails::Keep);
  EXPECT_EQ(count(result, DetailKind::BoundaryLoop, DetailDecision::Keep), 5U);
  EXPECT_EQ(result.details.size(), 5U);
  EXPECT_EQ(result.surface.repair.filledHoles, 0U);
  EXPECT_TRUE(result.surface.mesh.sizing.empty());
  EXPECT_FALSE(tellsOf(result, "quads are made smaller"));
}

/// A tube of a fortieth of its length round, 0.31, and with so many quads 0.9 edge lengths.
constexpr std::size_t kQuadsOfThinTorus = 16;
Mesh thinTorus()
{
  return test::torus(160, 10, 1, 0.05);
}

TEST(SmallDetails, KeepFailsWithTheReasonAndWithoutOtherSizes)
{
  const RemeshResult result = remeshBy(thinTorus(), kQuadsOfThinTorus, SmallDetails::Keep);
  ASSERT_FALSE(result.status.ok());
  EXPECT_NE(result.status.message.find("1 of 1 handles are shorter round than three quads"),
    std::string::npos);
  EXPECT_NE(result.status.message.find("Small Details"), std::string::npos);
  EXPECT_EQ(count(result, DetailKind::Handle, DetailDecision::Keep), 1U);
  for (const std::string& step : result.attempts)
  {
    EXPECT_NE(step, "more quads");
  }
}

TEST(SmallDetails, ThinTubeIsResolvedByAsManyQuadsAsItNeeds)
{
  const RemeshResult result = remeshBy(thinTorus(), kQuadsOfThinTorus, SmallDetails::Resolve);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).eulerCharacteristic, 0);
  EXPECT_EQ(count(result, DetailKind::Handle, DetailDecision::Resolve), 1U);
  const RemeshResult automatic = remeshBy(thinTorus(), kQuadsOfThinTorus, SmallDetails::Automatic);
  ASSERT_TRUE(automatic.status.ok()) << automatic.status.message;
  EXPECT_EQ(qualityOf(automatic).eulerCharacteristic, 2);
  EXPECT_LT(automatic.quads.quads.size(), result.quads.quads.size());
}

TEST(SmallDetails, SpecksAreLeftOutWhereTheirBlocksWouldSwampTheQuads)
{
  Mesh mesh = test::sphere(4);
  Mesh speck = test::sphere(0);
  for (Vector3& p : speck.position.editAll())
  {
    p *= 0.01;
  }
  for (int i = 0; i < 40; ++i)
  {
    mesh = test::disjointUnion(mesh, speck, Vector3(2 + 0.1 * i, 0, 0));
  }
  // 40 blocks of six quads are fewer than 500, and more than 200.
  const RemeshResult kept = remeshBy(mesh, 500, SmallDetails::Automatic);
  ASSERT_TRUE(kept.status.ok()) << kept.status.message;
  EXPECT_EQ(qualityOf(kept).components, 41U);
  EXPECT_EQ(count(kept, DetailKind::Component, DetailDecision::Simplify), 40U);
  EXPECT_EQ(kept.details.front().result, "made a block of about 6 quads");
  const RemeshResult without = remeshBy(mesh, 200, SmallDetails::Automatic);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  EXPECT_EQ(qualityOf(without).components, 1U);
  EXPECT_EQ(count(without, DetailKind::Component, DetailDecision::Simplify), 40U);
  EXPECT_EQ(without.details.front().result, "left out");
  for (const SmallDetail& detail : without.details)
  {
    // One of those 0.1 apart from 2 on.
    EXPECT_NEAR(std::remainder(detail.place.x(), 0.1), 0, 1e-6);
    EXPECT_GT(detail.place.x(), 1.9);
    EXPECT_LT(detail.place.tail<2>().norm(), 1e-6);
  }
  EXPECT_TRUE(tellsOf(without, "40 of 41 connected components have less area than a quad"));
  const RemeshResult resolved = remeshBy(mesh, 200, SmallDetails::Resolve);
  ASSERT_TRUE(resolved.status.ok()) << resolved.status.message;
  EXPECT_EQ(qualityOf(resolved).components, 41U);
}

TEST(SmallDetails, BoundaryOfSmallComponentsIsLeftToThem)
{
  // A flat chip with the area of half a quad beside the plate.
  Mesh chip = test::gridPlane(4, 4);
  const Mesh mesh = test::disjointUnion(test::gridPlane(60, 60), chip, Vector3(70, 0, 0));
  const RemeshResult result = remeshBy(mesh, 100, SmallDetails::Simplify);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).components, 2U);
  EXPECT_EQ(qualityOf(result).boundaryLoops, 2U);
  EXPECT_EQ(result.surface.repair.filledHoles, 0U);
}

TEST(SmallDetails, MoreHandlesThanQuadsCanGoRoundAreClosed)
{
  // A slab with 144 holes through it, of which 20 quads could go round one at most.
  const Mesh mesh = test::voxelSurface(
    { 25, 25, 1 }, 2, [](int x, int y, int) { return x % 2 == 0 || y % 2 == 0; });
  const RemeshResult result = remeshBy(mesh, 20, SmallDetails::Automatic);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(qualityOf(result).eulerCharacteristic, 2);
  EXPECT_EQ(count(result, DetailKind::Handle, DetailDecision::Simplify), 144U);
  EXPECT_TRUE(tellsOf(result, "144 handles were cut and closed"));
}

TEST(SmallDetails, SmallestDetailSetsWhatIsCut)
{
  const test::SphereWithHandle model = test::sphereWithHandle(5, kHandlePlace);
  RemeshOptions options;
  options.quads = quadsFor(model.mouthLength, 2.5);
  for (const auto& [smallest, isCut] :
    { std::pair(1.0, false), std::pair(1.5, false), std::pair(2.9, true), std::pair(4.0, true) })
  {
    options.smallestDetail = smallest;
    const RemeshResult result = remesh(test::toInput(model.mesh), options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    ASSERT_EQ(result.details.size(), 1U) << smallest;
    EXPECT_EQ(result.details.front().result == kCutAndClosed, isCut) << smallest;
  }
}

TEST(SmallDetails, ALargerSmallestDetailNeverBringsADetailBack)
{
  // Holes with loops of 4 and 16, and an island of 2 x 2 cells beside: quads of edge length 3.
  Mesh mesh = plate();
  Mesh island = test::planeCells(2, 2, [](int, int) { return true; });
  for (Vector3& p : island.position.editAll())
  {
    p.x() += 100;
  }
  appendMesh(island, mesh);
  RemeshOptions options;
  options.edgeLength = 3;
  std::vector<std::array<std::size_t, 2>> found;
  for (const double smallest : { 0.0, 1.0, 1.5, 2.0, 6.0 })
  {
    options.smallestDetail = smallest;
    const RemeshResult result = remesh(test::toInput(mesh), options);
    ASSERT_TRUE(result.status.ok()) << smallest << ": " << result.status.message;
    found.push_back({ result.surface.components, result.smallParts.boundary.loops });
  }
  // The island has the area of a quad of edge length 2, which is 0.67 over the edge length.
  const std::vector<std::array<std::size_t, 2>> expected{ { 2, 7 }, { 2, 7 }, { 1, 2 }, { 1, 2 },
    { 1, 1 } };
  EXPECT_EQ(found, expected);
}

TEST(SmallDetails, NothingToSimplifyChangesNothing)
{
  const Mesh mesh = test::torus(60, 30);
  const RemeshResult keep = remeshBy(mesh, 800, SmallDetails::Keep);
  ASSERT_TRUE(keep.status.ok()) << keep.status.message;
  EXPECT_TRUE(keep.details.empty());
  for (const SmallDetails decision :
    { SmallDetails::Automatic, SmallDetails::Resolve, SmallDetails::Simplify })
  {
    const RemeshResult result = remeshBy(mesh, 800, decision);
    EXPECT_EQ(result.quads.points, keep.quads.points);
    EXPECT_EQ(result.quads.quads, keep.quads.quads);
    EXPECT_EQ(result.notices, keep.notices);
    EXPECT_EQ(result.decimations, keep.decimations);
  }
}

TEST(SmallDetails, AreTheSameForAnyNumberOfThreadsAndWithAMemory)
{
  const Mesh mesh =
    test::disjointUnion(plate(), test::sphereWithHandle(4, kHandlePlace).mesh, Vector3(70, 0, 0));
  RemeshOptions options;
  options.quads = 110;
  options.threads = 1;
  const RemeshResult one = remesh(test::toInput(mesh), options);
  ASSERT_TRUE(one.status.ok()) << one.status.message;
  ASSERT_GE(one.details.size(), 4U);
  const auto expectAlike = [&](const RemeshResult& other)
  {
    EXPECT_EQ(other.quads.points, one.quads.points);
    EXPECT_EQ(other.quads.quads, one.quads.quads);
    EXPECT_EQ(other.surface.hash, one.surface.hash);
    EXPECT_EQ(other.notices, one.notices);
    ASSERT_EQ(other.details.size(), one.details.size());
    for (std::size_t i = 0; i < one.details.size(); ++i)
    {
      EXPECT_EQ(other.details[i].place, one.details[i].place);
      EXPECT_EQ(other.details[i].size, one.details[i].size);
      EXPECT_EQ(other.details[i].result, one.details[i].result);
    }
  };
  options.threads = 3;
  expectAlike(remesh(test::toInput(mesh), options));
  ResultStore memory;
  expectAlike(remesh(test::toInput(mesh), options, memory));
  const RemeshResult again = remesh(test::toInput(mesh), options, memory);
  expectAlike(again);
  EXPECT_EQ(again.decimations, 0);
  // Another decision and back.
  options.smallDetails = SmallDetails::Resolve;
  const RemeshResult resolved = remesh(test::toInput(mesh), options, memory);
  options.smallDetails = SmallDetails::Automatic;
  expectAlike(remesh(test::toInput(mesh), options, memory));
  EXPECT_EQ(resolved.surface.repair.filledHoles, 0U);
  // A guide, whose faces are numbered otherwise on the simplified surface.
  SurfaceInput guided = test::toInput(mesh);
  guided.guideDirections.assign(guided.polygonOffsets.size() - 1, Vector3::Zero());
  for (std::size_t f = 0; f < 600; ++f)
  {
    guided.guideDirections[f] = Vector3(1, 0.5, 0);
  }
  const RemeshResult warm = remesh(guided, options, memory);
  const RemeshResult cold = remesh(guided, options);
  EXPECT_EQ(warm.quads.points, cold.quads.points);
  EXPECT_NE(cold.quads.points, one.quads.points);
  // No request is a reason to take details out anew.
  EXPECT_EQ(warm.decimations, 0);
  SurfaceInput asked = test::toInput(mesh);
  asked.targetValences.assign(asked.points.size(), 0);
  const Vector3 top(70, 0, 1);
  const auto isNearer = [&](const Vector3& a, const Vector3& b)
  { return (a - top).norm() < (b - top).norm(); };
  const auto nearest = std::min_element(asked.points.begin(), asked.points.end(), isNearer);
  asked.targetValences[static_cast<std::size_t>(nearest - asked.points.begin())] = 5;
  const RemeshResult warmAsked = remesh(asked, options, memory);
  const RemeshResult coldAsked = remesh(asked, options);
  EXPECT_EQ(warmAsked.quads.points, coldAsked.quads.points);
  EXPECT_NE(coldAsked.quads.points, one.quads.points);
  EXPECT_EQ(warmAsked.decimations, 0);
}

TEST(SmallDetails, AreLeftToTheWholeWhereAMirrorHalvesIt)
{
  EXPECT_TRUE(maySimplify({}));
  RemeshOptions options;
  options.smallDetails = SmallDetails::Resolve;
  EXPECT_FALSE(maySimplify(options));
  options.smallDetails = SmallDetails::Automatic;
  options.coarsestIntegers = true;
  EXPECT_FALSE(maySimplify(options));
  options.smallDetails = SmallDetails::Simplify;
  EXPECT_TRUE(maySimplify(options));
}

} // namespace
} // namespace quadrille
