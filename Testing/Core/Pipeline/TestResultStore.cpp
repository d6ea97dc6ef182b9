// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is remembered from run to run leads to the same bytes, and from the right stage.
#include "Pipeline/Pipeline.h"

#include "MeshInput.h"
#include "SphereWithoutRoom.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace quadrille
{
namespace
{

using Names = std::vector<std::string>;

/// Sorted.
Names sorted(Names names)
{
  std::sort(names.begin(), names.end());
  return names;
}
Names with(Names names, const Names& more)
{
  names.insert(names.end(), more.begin(), more.end());
  return sorted(names);
}

const Names kPrepared = sorted({ "repair", "order", "connectivity" });
const Names kRefined = with(kPrepared, { "refine" });
const Names kDecimated = with(kRefined, { "handles", "phase1" });
const Names kMapped =
  with(kDecimated, { "phase2", "field", "seamless", "quantize", "embed", "replay", "certify" });
const Names kAll = with(kMapped, { "extract" });

/// A dented sphere: irregular vertices, nothing to refine.
SurfaceInput dentedSphere()
{
  Mesh mesh = test::sphere(5);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.15 * std::sin(4 * p.x()) * std::cos(3 * p.y() + p.z());
  }
  return test::toInput(mesh);
}

RemeshOptions optionsFor(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.coarseVertices = 300;
  return options;
}

void guideTop(SurfaceInput& input, const Vector3& direction)
{
  input.guideDirections.assign(input.polygonOffsets.size() - 1, Vector3::Zero());
  for (std::size_t f = 0; f < input.guideDirections.size(); ++f)
  {
    if (input.points[input.polygonPoints[input.polygonOffsets[f]]].z() > 0.8)
    {
      input.guideDirections[f] = direction;
    }
  }
}

Index topmost(const SurfaceInput& input)
{
  const auto lower = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
  return static_cast<Index>(
    std::max_element(input.points.begin(), input.points.end(), lower) - input.points.begin());
}

void askForValence(SurfaceInput& input, Index point, int valence)
{
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[point] = valence;
}

void expectSame(const RemeshResult& a, const RemeshResult& b)
{
  ASSERT_EQ(a.status.ok(), b.status.ok()) << a.status.message << b.status.message;
  EXPECT_TRUE(a.surface.mesh.origin == b.surface.mesh.origin);
  EXPECT_TRUE(a.surface.mesh.flags == b.surface.mesh.flags);
  EXPECT_EQ(a.surface.hash, b.surface.hash);
  EXPECT_TRUE(a.uv == b.uv);
  EXPECT_TRUE(a.quads.points == b.quads.points);
  EXPECT_TRUE(a.quads.quads == b.quads.quads);
  EXPECT_EQ(a.notices, b.notices);
  EXPECT_EQ(a.surface.repair.text(), b.surface.repair.text());
}

/// A run with the store is byte for byte one without it, and has reused these stages and computed none of them.
void expectCold(
  const SurfaceInput& input, const RemeshOptions& options, ResultStore& store, const Names& reused)
{
  const RemeshResult stored = remesh(input, options, store);
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  expectSame(stored, without);
  EXPECT_EQ(sorted(stored.reused), reused);
  for (const StageRecord& stage : stored.stages)
  {
    EXPECT_EQ(std::count(reused.begin(), reused.end(), stage.stage), 0) << stage.stage;
  }
  EXPECT_EQ(stored.decimations == 0, std::count(reused.begin(), reused.end(), "phase1") > 0);
}

TEST(ResultStore, TheSameBytesFromTheStageThatIsAsked)
{
  SurfaceInput input = dentedSphere();
  RemeshOptions options = optionsFor(500);
  ResultStore store;
  expectCold(input, options, store, {});
  expectCold(input, options, store, kAll);
  guideTop(input, Vector3(1, 0, 0));
  expectCold(input, options, store, with(kDecimated, { "phase2" }));
  guideTop(input, Vector3(1, 1, 0));
  expectCold(input, options, store, with(kDecimated, { "phase2" }));
  guideTop(input, Vector3(1, 0, 0));
  expectCold(input, options, store, kAll); // as it was before
  options.smoothingSteps = 2;
  expectCold(input, options, store, kMapped);
  options.threads = 1;
  options.maximumNumberOfQuads = 5000;
  expectCold(input, options, store, kAll);
  askForValence(input, topmost(input), 5);
  expectCold(input, options, store, kDecimated);
  askForValence(input, topmost(input), 3);
  expectCold(input, options, store, with(kDecimated, { "phase2" }));
  options.coarseVertices = 200;
  expectCold(input, options, store, kDecimated);
  options.distortionMetric = true;
  expectCold(input, options, store, with(kDecimated, { "phase2" }));
  options.quads = 700;
  expectCold(input, options, store, kPrepared);
  options.quads = 500;
  expectCold(input, options, store, with(kAll, { "metric" }));
  options.featureCriterion = FeatureCriterion::Angle;
  expectCold(input, options, store, kPrepared);
  options.featureAngle = 0.5;
  expectCold(input, options, store, {});
  input.points.edit()[7] *= 1.001;
  expectCold(input, options, store, {});
}

TEST(ResultStore, WhatIsUsedLeastGoesFirstAndNothingThatIsHeld)
{
  ResultStore store(100);
  const auto put = [&](ResultKey key, std::size_t bytes)
  {
    auto value = std::make_shared<int>(static_cast<int>(key));
    store.put(key, value, bytes);
  };
  put(1, 40);
  put(2, 40);
  EXPECT_TRUE(store.find<int>(1)); // so that 2 is the one that was not used for longest
  put(3, 40);
  EXPECT_TRUE(store.find<int>(1));
  EXPECT_FALSE(store.find<int>(2));
  EXPECT_TRUE(store.find<int>(3));
  EXPECT_FALSE(store.find<double>(3)); // another type
  EXPECT_EQ(store.bytes(), 80U);
  const std::shared_ptr<int> held = store.find<int>(1);
  put(4, 70);
  EXPECT_TRUE(store.find<int>(1));
  EXPECT_FALSE(store.find<int>(3));
  EXPECT_TRUE(
    store.find<int>(4) == nullptr || store.bytes() > 100U); // too much beside what is held
  put(1, 10);                                               // in place of the one before
  EXPECT_EQ(*store.find<int>(1), 1);
  EXPECT_LE(store.bytes(), 100U);
  store.clear();
  EXPECT_EQ(store.bytes(), 0U);
}

TEST(ResultStore, RefinedSurfacesAndFeaturesAreRemembered)
{
  SurfaceInput input = test::toInput(test::markFeatures(test::unitCube(3), 0.6));
  RemeshOptions options = optionsFor(600);
  ResultStore memory;
  expectCold(input, options, memory, {});
  ASSERT_GT(remesh(input, options).surface.repair.refinedFaces, 0U);
  askForValence(input, 0, 3); // a corner
  expectCold(input, options, memory, kDecimated);
  options.quads = 900;
  expectCold(input, options, memory, kPrepared);
  input.targetValences.clear(); // those of the run that filled the memory are not held
  expectCold(input, options, memory, kDecimated);
  options.quads = 60;
  expectCold(input, options, memory, kPrepared);
}

TEST(ResultStore, FeaturesThatOneSizeCannotResolveComeBackForAnother)
{
  SurfaceInput input = dentedSphere();
  input.points.edit()[topmost(input)] *= 1.08; // a spike with sharp edges
  RemeshOptions options = optionsFor(300);
  ResultStore memory;
  const auto features = [](const RemeshResult& result)
  {
    const std::vector<std::uint8_t>& flags = result.surface.mesh.flags;
    return std::count_if(
      flags.begin(), flags.end(), [](std::uint8_t f) { return (f & kFeatureEdge) != 0; });
  };
  const RemeshResult large = remesh(input, options, memory);
  ASSERT_TRUE(large.status.ok()) << large.status.message;
  ASSERT_EQ(features(large), 0);
  ASSERT_EQ(large.surface.repair.refinedFaces, 0U);
  options.quads = 5000;
  const RemeshResult small = remesh(input, options);
  const RemeshResult after = remesh(input, options, memory);
  ASSERT_GT(features(small), 0);
  expectSame(after, small);
  EXPECT_EQ(sorted(after.reused), kPrepared);
}

TEST(ResultStore, SizesAreRemembered)
{
  SurfaceInput input = dentedSphere();
  for (const Vector3& p : input.points)
  {
    input.sizing.push_back(p.x() > 0.6 ? 0.4 : 1.5); // grows too fast, so that it is limited
  }
  RemeshOptions options = optionsFor(500);
  ResultStore memory;
  expectCold(input, options, memory, {});
  guideTop(input, Vector3(1, 0, 0));
  expectCold(input, options, memory, with(kDecimated, { "phase2" }));
  options.quads = 800;
  expectCold(input, options, memory, kPrepared);
  options.quads.reset();
  options.edgeLength = 0.15;
  expectCold(input, options, memory, kPrepared);
  expectCold(input, options, memory, kAll);
  input.sizing[3] *= 0.9;
  expectCold(input, options, memory, {});
}

TEST(ResultStore, ClosedHandlesAreRemembered)
{
  const test::SphereWithHandle model = test::sphereWithHandle(5, Vector3(1, 2, 3).normalized());
  SurfaceInput input = test::toInput(model.mesh);
  RemeshOptions options = optionsFor(300);
  options.smallestDetail = 3;
  ResultStore memory;
  const RemeshResult without = remesh(input, options);
  ASSERT_EQ(without.surface.repair.closedHandles, 1U);
  expectSame(remesh(input, options, memory), without);
  const RemeshResult again = remesh(input, options, memory);
  expectSame(again, without);
  EXPECT_EQ(again.reused.size(), kAll.size() + 1); // "simplify"
  options.quads = 350;
  expectSame(remesh(input, options, memory), remesh(input, options));
}

TEST(ResultStore, WhatARetryFoundIsRememberedForTheNextEdit)
{
  const SurfaceInput input = test::sphereWithoutRoom();
  RemeshOptions options = optionsFor(100);
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok());
  ASSERT_GT(without.replays, 1); // of the second map, too
  ResultStore memory;
  expectSame(remesh(input, options, memory), without);
  const RemeshResult again = remesh(input, options, memory);
  expectSame(again, without);
  EXPECT_EQ(sorted(again.reused), kAll);
  EXPECT_EQ(again.decimations, 0);
  // The attempts come again, none of them is computed.
  options.smoothingSteps = 2;
  const RemeshResult smoother = remesh(input, options, memory);
  expectSame(smoother, remesh(input, options));
  EXPECT_EQ(sorted(smoother.reused), kMapped);
}

/// A vertex that phase 1 has removed comes back without another phase 1, as it does in a run from the start.
TEST(ResultStore, AValenceAtARemovedVertexKeepsPhase1)
{
  SurfaceInput input = dentedSphere();
  const RemeshOptions options = optionsFor(500);
  ResultStore memory;
  const RemeshResult first = remesh(input, options, memory);
  const std::vector<Index>& coarse = first.coarse.fineVertex;
  const Mesh& mesh = first.surface.mesh;
  for (const Index h : { mesh.halfEdgeCount() / 5, mesh.halfEdgeCount() / 2 })
  {
    ASSERT_FALSE(std::binary_search(coarse.begin(), coarse.end(), mesh.origin[h]));
    SurfaceInput asked = input;
    askForValence(asked, first.surface.sourcePoints[Mesh::face(h)][h % 3], 5);
    const RemeshResult result = remesh(asked, options, memory);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.turns[mesh.origin[h]], 5);
    EXPECT_EQ(result.decimations, 0);
    EXPECT_EQ(std::count(result.reused.begin(), result.reused.end(), "phase1"), 1);
    expectSame(result, remesh(asked, options));
  }
}

TEST(ResultStore, AWarmStartTakesTheLastMap)
{
  SurfaceInput input = dentedSphere();
  RemeshOptions options = optionsFor(500);
  options.warmStart = true;
  ResultStore memory;
  EXPECT_TRUE(remesh(input, options, memory).reused.empty());
  const auto has = [](const RemeshResult& result, const std::string& stage)
  { return std::count(result.reused.begin(), result.reused.end(), stage) == 1; };
  guideTop(input, Vector3(1, 0.2, 0));
  RemeshResult warm = remesh(input, options, memory);
  ASSERT_TRUE(warm.status.ok()) << warm.status.message;
  EXPECT_TRUE(warm.certificate.valid()) << warm.certificate.text();
  EXPECT_TRUE(has(warm, "phase1"));
  EXPECT_TRUE(has(warm, "seamless"));
  // The vertex is on the intermediate level, so phase 1 need not be run for it.
  const Level& coarse = warm.coarse;
  const Index fine = coarse.fineVertex[coarse.mesh.vertexCount() / 2];
  const Mesh& mesh = warm.surface.mesh;
  const Index h = static_cast<Index>(
    std::find(mesh.origin.begin(), mesh.origin.end(), fine) - mesh.origin.begin());
  askForValence(input, warm.surface.sourcePoints[Mesh::face(h)][h % 3], 5);
  warm = remesh(input, options, memory);
  ASSERT_TRUE(warm.status.ok()) << warm.status.message;
  EXPECT_TRUE(has(warm, "phase1"));
  EXPECT_EQ(warm.decimations, 0);
  EXPECT_EQ(warm.turns[fine], 5);
  // Where the size changes, the ids of the last map mean nothing.
  options.quads = 650;
  const RemeshResult resized = remesh(input, options, memory);
  EXPECT_EQ(sorted(resized.reused), kPrepared);
  expectSame(resized, remesh(input, options));
}

TEST(ResultStore, AMapWithAnotherAnisotropyLimitIsNoStart)
{
  const SurfaceInput input = dentedSphere();
  for (const bool warm : { true, false })
  {
    RemeshOptions options = optionsFor(600);
    options.warmStart = warm;
    ResultStore memory;
    const RemeshResult off = remesh(input, options, memory);
    options.anisotropyLimit = 1.1;
    const RemeshResult limited = remesh(input, options, memory);
    ASSERT_TRUE(limited.status.ok()) << limited.status.message;
    const auto has = [&](const std::string& stage)
    { return std::count(limited.reused.begin(), limited.reused.end(), stage) == 1; };
    EXPECT_TRUE(has("phase1"));
    EXPECT_FALSE(has("seamless") || has("quantize") || has("embed"));
    expectSame(limited, remesh(input, options));
    EXPECT_GT(limited.beyondAnisotropyLimit, 0);
    EXPECT_NE(limited.coarseUv, off.coarseUv);
    options.anisotropyLimit = 0;
    expectSame(remesh(input, options, memory), off);
  }
}

TEST(ResultStore, AWarmStartTakesNoMapOfAnotherMetric)
{
  const SurfaceInput input = dentedSphere();
  RemeshOptions options = optionsFor(500);
  options.warmStart = true;
  ResultStore memory;
  for (const bool metric : { false, true })
  {
    options.distortionMetric = metric;
    const RemeshResult other = remesh(input, options, memory);
    EXPECT_EQ(std::count(other.reused.begin(), other.reused.end(), "seamless"), 0);
    expectSame(other, remesh(input, options));
    const RemeshResult again = remesh(input, options, memory);
    EXPECT_EQ(std::count(again.reused.begin(), again.reused.end(), "seamless"), 1);
  }
}

TEST(ResultStore, SameBytesForAnyNumberOfThreads)
{
  std::optional<RemeshResult> first;
  for (const int threads : { 1, 2, 4 })
  {
    SurfaceInput input = dentedSphere();
    RemeshOptions options = optionsFor(500);
    options.warmStart = true;
    options.threads = threads;
    ResultStore memory;
    remesh(input, options, memory);
    guideTop(input, Vector3(1, 0.2, 0));
    RemeshResult warm = remesh(input, options, memory);
    ASSERT_EQ(std::count(warm.reused.begin(), warm.reused.end(), "seamless"), 1);
    if (first)
    {
      expectSame(warm, *first);
      EXPECT_EQ(warm.reused, first->reused);
    }
    first = std::move(warm);
  }
}

TEST(ResultStore, IsWholeAfterEveryStop)
{
  SurfaceInput input = dentedSphere();
  RemeshOptions options = optionsFor(500);
  const RemeshResult expected = remesh(input, options);
  int total = 0;
  options.progress = [&](double, const std::string&) { return ++total > 0; };
  ASSERT_TRUE(remesh(input, options).status.ok());
  ASSERT_GT(total, 20);
  ResultStore memory;
  RemeshOptions plain = optionsFor(500);
  int stopped = 0;
  for (int stop = 1; stop < total; stop += 1 + total / 12)
  {
    int calls = 0;
    options.progress = [&](double, const std::string&) { return ++calls < stop; };
    const StatusCode code = remesh(input, options, memory).status.code;
    // What an earlier run has left makes this one shorter.
    EXPECT_TRUE(code == StatusCode::Cancelled || stop > 1) << stop;
    stopped += code == StatusCode::Cancelled ? 1 : 0;
    if (stopped % 2 == 0)
    {
      memory.clear();
    }
  }
  EXPECT_GT(stopped, 4);
  expectSame(remesh(input, plain, memory), expected);
  // A change that is stopped, too, is forgotten.
  for (int stop = 1; stop < 40; stop += 3)
  {
    int calls = 0;
    options.quads = 700;
    options.progress = [&](double, const std::string&) { return ++calls < stop; };
    remesh(input, options, memory);
    expectSame(remesh(input, plain, memory), expected);
  }
}

TEST(ResultStore, IsWholeAfterBadInput)
{
  SurfaceInput input = dentedSphere();
  RemeshOptions options = optionsFor(500);
  ResultStore memory;
  const RemeshResult expected = remesh(input, options, memory);
  SurfaceInput bad = input;
  guideTop(bad, Vector3(1, 0, 0));
  bad.guideDirections[0].x() = std::nan("");
  EXPECT_THROW(remesh(bad, options, memory), InvalidInput);
  bad = input;
  askForValence(bad, 0, 77);
  EXPECT_THROW(remesh(bad, options, memory), InvalidInput);
  const RemeshResult after = remesh(input, options, memory);
  expectSame(after, expected);
  EXPECT_EQ(sorted(after.reused), kAll);
  bad = input;
  bad.points.edit()[3].y() = std::nan("");
  EXPECT_THROW(remesh(bad, options, memory), InvalidInput);
  expectSame(remesh(input, options, memory), expected);
}

TEST(ResultStore, KeepsToItsBoundAndLetsGoWhereThereIsNoRoom)
{
  const SurfaceInput input = dentedSphere();
  const double triangles = static_cast<double>(input.polygonOffsets.size() - 1);
  RemeshOptions options = optionsFor(500);
  ResultStore large;
  EXPECT_EQ(large.bytes(), 0U);
  const RemeshResult first = remesh(input, options, large);
  const std::size_t held = large.bytes();
  EXPECT_GT(static_cast<double>(held), 60 * triangles);
  // For one surface there is room, not for two.
  ResultStore memory(held * 11 / 10);
  remesh(input, options, memory);
  SurfaceInput other = input;
  other.points.edit()[0] *= 1.01;
  remesh(other, options, memory);
  EXPECT_LT(static_cast<double>(memory.bytes()), 1.2 * static_cast<double>(held));
  options.memoryLimit = first.estimate.bytes + 100 * triangles;
  const RemeshResult tight = remesh(other, options, memory);
  EXPECT_TRUE(tight.status.ok()) << tight.status.message;
  // What it holds counts as there, so nothing has to go.
  EXPECT_FALSE(tight.reused.empty());
  memory.clear();
  EXPECT_EQ(memory.bytes(), 0U);
  const RemeshResult without = remesh(input, options, memory);
  EXPECT_TRUE(without.status.ok()) << without.status.message;
  EXPECT_EQ(memory.bytes(), 0U);
  EXPECT_TRUE(std::any_of(without.notices.begin(), without.notices.end(),
    [](const std::string& text) { return text.find("are not remembered") != std::string::npos; }));
}

} // namespace
} // namespace quadrille
