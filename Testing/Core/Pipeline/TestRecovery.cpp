// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What each recovery strategy makes of hand-made attempts, and when it has nothing to offer.
#include "Pipeline/FirstPlan.h"
#include "Pipeline/Recovery.h"
#include "Prepare/Prepare.h"
#include "Requests/Guides.h"

#include "HandMadeAttempts.h"
#include "Mesh/Sizing.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille
{
namespace
{

using test::carriedMap;
using test::failedMap;
using test::failedQuads;
using test::planOf;
using test::quadsWith;

constexpr std::size_t kTarget = 1000;

/// A run on a small surface, without a store. s: edge length of the quads.
struct TestRun
{
  TestRun(const SurfaceInput& input, double s, std::optional<double> featureAngle = std::nullopt)
    : context{ {}, s, kTarget,
        withoutPlan(
          std::make_shared<PreparedSurface>(prepareSurface(input, { featureAngle, 1, {} })), 1),
        nullptr, Levels(nullptr) }
  {
    options.threads = 1;
  }
  TestRun(const Mesh& mesh, double s, std::optional<double> featureAngle = std::nullopt)
    : TestRun(test::toInput(mesh), s, featureAngle)
  {
  }

  const Mesh& mesh() const { return context.surface->mesh; }
  PlannedSurface planned(const Plan& plan) const { return withPlan(context.surface, plan); }
  const Hierarchy& levels(const Plan& plan)
  {
    return context.levels.make(planned(plan), levelOptions(context, plan));
  }
  /// Those that were made last.
  const Hierarchy& levels() const { return context.levels.hierarchy(); }
  Index vertexAt(const Vector3& p) const
  {
    const auto found = std::find(mesh().position.begin(), mesh().position.end(), p);
    EXPECT_NE(found, mesh().position.end());
    return static_cast<Index>(found - mesh().position.begin());
  }
  Plan first() { return firstPlan(context); }
  /// After a round of this map only, and its quads.
  std::optional<Plan> nextAfter(const Plan& plan, const std::shared_ptr<MapAttempt>& map,
    std::shared_ptr<const QuadAttempt> quads = nullptr, bool isLast = false)
  {
    History history;
    history.addMap(plan, map);
    history.addQuads(std::move(quads));
    return nextPlan(context, history, isLast);
  }

  RunContext context;
  RemeshOptions& options = context.options;
};

/// Without any plan the test ends here.
void expectStep(const std::optional<Plan>& plan, const char* step)
{
  EXPECT_TRUE(plan) << "instead of " << step;
  EXPECT_STREQ(plan.value().step, step);
}

std::vector<Index> vertices(Index count)
{
  std::vector<Index> all(count);
  std::iota(all.begin(), all.end(), Index{ 0 });
  return all;
}

/// Vertices of the level (ids on the surface) within two edges of those given.
std::vector<Index> twoRings(const Level& level, const std::vector<Index>& centres)
{
  std::vector<Index> near = centres;
  for (int ring = 0; ring < 2; ++ring)
  {
    const std::vector<Index> inner = near;
    for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
    {
      const Index from = level.fineVertex[level.mesh.origin[h]];
      if (std::find(inner.begin(), inner.end(), from) != inner.end())
      {
        near.push_back(level.fineVertex[level.mesh.target(h)]);
      }
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

// The plan that a run begins with.

TEST(Recovery, FirstPlanTakesBudgetAndNumberFromTheOptions)
{
  TestRun run(test::gridPlane(4, 4), 1);
  run.options.coarseVertices = 123;
  const Plan plan = run.first();
  EXPECT_STREQ(plan.step, "first");
  EXPECT_EQ(plan.levels.coarseVertices, 123U);
  EXPECT_EQ(plan.quads, double{ kTarget });
  EXPECT_EQ(plan.sizes, nullptr);
  EXPECT_TRUE(plan.notices.empty());
}

/// A loop of this length at the vertex in the middle of a plane.
void addShortLoop(TestRun& run, const Vector3& place, double length)
{
  run.context.shortLoops.loops.push_back({ { run.vertexAt(place) }, length });
}

TEST(Recovery, FirstPlanLetsFourQuadsFitRoundShortLoops)
{
  TestRun run(test::gridPlane(20, 20), 1);
  const Vector3 middle(10, 10, 0), corner(2, 2, 0);
  addShortLoop(run, middle, 2);    // four quads of half the size
  addShortLoop(run, corner, 0.01); // would take quads that are too small
  const Plan plan = run.first();
  ASSERT_TRUE(plan.sizes);
  EXPECT_EQ((*plan.sizes)[run.vertexAt(middle)], 0.5F);
  EXPECT_EQ((*plan.sizes)[run.vertexAt(corner)], 0.1F);
  EXPECT_EQ((*plan.sizes)[run.vertexAt({ 20, 20, 0 })], 1.0F);
  EXPECT_EQ(plan.quads, double{ kTarget });
  ASSERT_EQ(plan.notices.size(), 1U);
  EXPECT_NE(plan.notices[0].find("round 2 handles"), std::string::npos) << plan.notices[0];
  EXPECT_NE(plan.notices[0].find("(10, 10, 0)"), std::string::npos) << plan.notices[0];
  EXPECT_TRUE(run.mesh().sizing.empty()); // a plan is not on the surface yet
}

TEST(Recovery, FirstPlanKeepsSizesWhereSmallerQuadsWouldBeTooMany)
{
  TestRun run(test::gridPlane(4, 4), 1);
  addShortLoop(run, { 2, 2, 0 }, 0.1);
  EXPECT_EQ(run.first().sizes, nullptr);
}

TEST(Recovery, FirstPlanKeepsSizesForOtherMapsThanScaleAwareOnes)
{
  TestRun run(test::gridPlane(20, 20), 1);
  addShortLoop(run, { 10, 10, 0 }, 2);
  ASSERT_TRUE(run.first().sizes);
  run.options.coarsestIntegers = true;
  EXPECT_EQ(run.first().sizes, nullptr);
  run.options.coarsestIntegers = false;
  run.options.method = MapMethod::Seamless;
  EXPECT_EQ(run.first().sizes, nullptr);
}

// More freedom for the coarse map.

/// A sphere whose intermediate level has fewer vertices than it, and more than the coarse one.
struct SphereRun : TestRun
{
  SphereRun() : TestRun(test::sphere(4), 0.3) { options.coarseVertices = 100; }
};

TEST(Recovery, MoreFreedomKeepsTheRingsRoundFailuresAndRaisesTheBudget)
{
  SphereRun run;
  Plan plan = run.first();
  const Hierarchy& levels = run.levels(plan);
  ASSERT_LT(levels.intermediate.mesh.vertexCount(), run.mesh().vertexCount());
  const std::vector<Index> failed{ levels.coarse.fineVertex[7], levels.coarse.fineVertex[80] };
  const std::vector<Index> rings = twoRings(levels.intermediate, failed);
  const Index coarse = levels.coarse.mesh.vertexCount();
  ASSERT_EQ(coarse, 100U);
  ASSERT_GT(rings.size(), 25U);
  History history;
  history.addMap(plan, failedMap(failed));
  std::optional<Plan> next = nextMapPlan(run.context, history);
  expectStep(next, "more freedom");
  EXPECT_EQ(next->levels.keptVertices, rings);
  EXPECT_EQ(next->levels.coarseVertices, coarse + rings.size());
  EXPECT_EQ(next->levels.edgeLength, 1);
  // What was kept before stays, and counts only once.
  history = {};
  plan.levels.keptVertices = { rings[0] };
  history.addMap(plan, failedMap(failed));
  next = nextMapPlan(run.context, history);
  expectStep(next, "more freedom");
  const std::vector<Index>& onLevel = run.levels().coarse.fineVertex;
  for (const Index v : { rings[0], failed[0], failed[1] })
  {
    EXPECT_TRUE(
      std::binary_search(next->levels.keptVertices.begin(), next->levels.keptVertices.end(), v));
  }
  EXPECT_TRUE(std::is_sorted(next->levels.keptVertices.begin(), next->levels.keptVertices.end()));
  EXPECT_EQ(next->levels.coarseVertices, onLevel.size() + next->levels.keptVertices.size() - 1);
}

TEST(Recovery, MoreFreedomRaisesTheBudgetByAQuarterAtLeast)
{
  SphereRun run;
  Plan plan = run.first();
  const Hierarchy& levels = run.levels(plan);
  const std::vector<Index> failed{ levels.coarse.fineVertex[7] };
  plan.levels.keptVertices = twoRings(levels.intermediate, failed); // so none is added
  History history;
  history.addMap(plan, failedMap(failed));
  const std::optional<Plan> next = nextMapPlan(run.context, history);
  expectStep(next, "more freedom");
  EXPECT_EQ(next->levels.keptVertices, plan.levels.keptVertices);
  EXPECT_EQ(next->levels.coarseVertices, 125U);
}

TEST(Recovery, MoreFreedomTakesFinerLevelsWhereTheCoarseOneIsTheIntermediateOne)
{
  SphereRun run;
  run.options.coarseVertices = 100000;
  const Plan plan = run.first();
  History history;
  history.addMap(plan, failedMap({ 0, 1 }));
  const std::optional<Plan> next = nextMapPlan(run.context, history);
  expectStep(next, "more freedom");
  const Index coarse = run.levels().coarse.mesh.vertexCount();
  EXPECT_EQ(coarse, run.levels().intermediate.mesh.vertexCount());
  EXPECT_EQ(next->levels.coarseVertices, 2 * coarse);
  EXPECT_DOUBLE_EQ(next->levels.edgeLength, std::sqrt(0.5));
  EXPECT_TRUE(next->levels.keptVertices.empty());
  EXPECT_GT(run.levels(*next).coarse.mesh.vertexCount(), coarse);
}

TEST(Recovery, MoreFreedomComesTwiceInARound)
{
  SphereRun run;
  Plan plan = run.first();
  History history;
  history.addMap(plan, failedMap());
  EXPECT_TRUE(nextMapPlan(run.context, history));
  plan.step = "more freedom";
  history.addMap(plan, failedMap(vertices(300)));
  EXPECT_TRUE(nextMapPlan(run.context, history));
  history.addMap(plan, failedMap({ 1 }));
  EXPECT_FALSE(nextMapPlan(run.context, history));
}

TEST(Recovery, MoreFreedomIsForCoarseFailuresThatCanBeMended)
{
  SphereRun run;
  const auto hopeless = failedMap();
  hopeless->hopeless = true;
  for (const auto& map : { hopeless, carriedMap(0) })
  {
    History history;
    history.addMap(run.first(), map);
    EXPECT_FALSE(nextMapPlan(run.context, history));
  }
}

TEST(Recovery, DefectsOnTheSurfaceAskForNoOtherMap)
{
  TestRun run(test::gridPlane(12, 12), 1);
  const auto map = carriedMap(1);
  map->coarse.mesh.position.assign(100, Vector3::Zero());
  map->transfer.defectVertices = { 1 };
  History history;
  history.addMap(run.first(), map);
  EXPECT_FALSE(nextMapPlan(run.context, history));
}

/// A unit cube whose edges are features. Near the middle of one an irregular vertex was asked for.
struct CubeRun : TestRun
{
  explicit CubeRun(bool isAsked = true) : TestRun(input(isAsked), 0.05, 0.7) {}
  static SurfaceInput input(bool isAsked)
  {
    SurfaceInput input = test::toInput(test::unitCube(20));
    input.targetValences.assign(input.points.size(), 0);
    for (std::size_t p = 0; p < input.points.size(); ++p)
    {
      const bool isThere = (input.points[p] - Vector3(0.5, 0.2, 0)).norm() < 1e-6;
      input.targetValences[p] = isAsked && isThere ? 3 : 0;
    }
    return input;
  }
  /// On the edge of the cube, in its middle.
  Index onEdge() const { return vertexAt({ 0.5, 0, 0 }); }
};

/// A coarse map that fails on an edge of the cube.
std::shared_ptr<MapAttempt> failedAtEdge()
{
  auto failed = failedMap();
  failed->failedPlaces = { Vector3(0.5, 0, 0) };
  return failed;
}

TEST(Recovery, WhereFacesCanBeFilledMoreFreedomComesOnceForFewVertices)
{
  CubeRun run;
  Plan plan = run.first();
  const auto goesOn = [&](Index failed)
  {
    History history;
    history.addMap(plan, failedMap(vertices(failed)));
    return nextMapPlan(run.context, history).has_value();
  };
  EXPECT_TRUE(goesOn(0)); // integers fail at no place in particular
  EXPECT_TRUE(goesOn(10));
  EXPECT_FALSE(goesOn(11));
  History history;
  history.addMap(plan, failedMap({ 1 }));
  plan.step = "more freedom";
  history.addMap(plan, failedMap({ 1 }));
  EXPECT_FALSE(nextMapPlan(run.context, history));
}

TEST(Recovery, AnotherRoundKeepsTheLevels)
{
  CubeRun run;
  Plan plan = run.first();
  plan.levels.keptVertices = { 4, 7 };
  plan.levels.coarseVertices = 321;
  plan.levels.edgeLength = 0.25;
  const std::optional<Plan> next = run.nextAfter(plan, failedAtEdge());
  expectStep(next, "counterparts");
  std::vector<Index> kept = { 4, 7 };
  for (const ValenceRequest& request : *next->counterparts)
  {
    kept.push_back(request.vertex);
  }
  std::sort(kept.begin(), kept.end());
  EXPECT_EQ(next->levels.keptVertices, kept);
  EXPECT_EQ(next->levels.coarseVertices, 321U);
  EXPECT_EQ(next->levels.edgeLength, 0.25);
}

TEST(Recovery, CounterpartsAreForIrregularVerticesNearTheFailureOnce)
{
  CubeRun free(false);
  EXPECT_FALSE(free.nextAfter(free.first(), failedAtEdge()));
  CubeRun run;
  const std::optional<Plan> next = run.nextAfter(run.first(), failedAtEdge());
  expectStep(next, "counterparts");
  EXPECT_EQ(next->why, "no valid map of the coarse level");
  ASSERT_EQ(next->notices.size(), 1U);
  EXPECT_NE(next->notices[0].find("3 others were put beside"), std::string::npos)
    << next->notices[0];
  EXPECT_EQ(run.planned(*next)->valenceRequests.size(), 4U);
  EXPECT_FALSE(run.nextAfter(*next, failedAtEdge()));
  const auto far = failedMap();
  far->failedPlaces = { Vector3(0.5, 1, 1) };
  EXPECT_FALSE(run.nextAfter(run.first(), far));
  const auto tooLarge = failedAtEdge();
  tooLarge->status.code = StatusCode::TooLarge;
  EXPECT_FALSE(run.nextAfter(run.first(), tooLarge));
}

// More quads everywhere.

TEST(Recovery, MoreQuadsGoThreeTimesRoundTheShortestLoopThatIsToBeResolved)
{
  TestRun run(test::gridPlane(12, 12), 1);
  run.options.smallDetails = SmallDetails::Resolve;
  const auto next = [&](const Plan& plan)
  { return run.nextAfter(plan, carriedMap(1), failedQuads(), true); };
  EXPECT_FALSE(next(run.first())); // there is no loop
  addShortLoop(run, { 6, 6, 0 }, 2.5);
  addShortLoop(run, { 2, 2, 0 }, 1.5);
  Plan first = run.first();
  first.quads = kTarget;
  run.context.targetQuads = kTarget;
  EXPECT_FALSE(run.nextAfter(first, carriedMap(1), quadsWith(2), true));   // no reason
  EXPECT_FALSE(run.nextAfter(first, carriedMap(1), failedQuads(), false)); // others come before
  const std::optional<Plan> more = next(first);
  expectStep(more, "more quads");
  EXPECT_DOUBLE_EQ(more->quads, 4.0 * kTarget);
  EXPECT_EQ(more->sizes, first.sizes);
  EXPECT_NE(more->notices.back().find(": made for 4000 quads"), std::string::npos);
  EXPECT_FALSE(next(*more)); // once
  run.options.smallDetails = SmallDetails::Automatic;
  EXPECT_FALSE(next(first)); // the number counts
  run.options.smallDetails = SmallDetails::Resolve;
  addShortLoop(run, { 3, 3, 0 }, 0.2); // edges of a fifteenth
  EXPECT_FALSE(next(first));
}

TEST(Recovery, MoreQuadsDoubleThemWhereTheyTouchThemselves)
{
  TestRun run(test::gridPlane(12, 12), 1);
  const auto touching = failedQuads();
  touching->failedFaces = { 0 };
  Plan plan = run.first();
  for (int times = 1; times <= 3; ++times)
  {
    EXPECT_FALSE(run.nextAfter(plan, failedMap(), nullptr, true)); // only of a valid map
    const std::optional<Plan> next = run.nextAfter(plan, carriedMap(0), touching, true);
    expectStep(next, "more quads");
    plan = *next;
    EXPECT_EQ(plan.quads, std::pow(2.0, times) * kTarget);
    ASSERT_EQ(plan.notices.size(), 1U);
    EXPECT_NE(plan.notices[0].find("made for " + std::to_string(std::llround(plan.quads))),
      std::string::npos);
  }
  EXPECT_FALSE(run.nextAfter(plan, carriedMap(0), touching, true));
}

// Features that nobody asked for.

/// A unit cube whose edges are features, with edges of 1/8 and quads of twice that; not known as designed.
struct ScanRun : TestRun
{
  explicit ScanRun(const SurfaceInput& input = test::toInput(test::unitCube(8)))
    : TestRun(input, 0.25, 0.7)
  {
    setDesigned(false);
  }
  void setDesigned(bool isDesigned)
  {
    const_cast<PreparedSurface&>(*context.surface.surface).facets.isDesigned = isDesigned;
  }
  /// Features whose middles are so are those that were asked for.
  template <typename IsAsked>
  void askFor(const IsAsked& isAsked)
  {
    Mesh& mesh = const_cast<PreparedSurface&>(*context.surface.surface).mesh;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const bool is = mesh.isFeature(h) &&
        isAsked((mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2);
      mesh.flags.edit()[h] |= is ? kRequestedFeature : 0;
    }
  }
  /// On an edge of the cube, in its middle.
  Index onEdge() const { return vertexAt({ 0.5, 0, 0 }); }
  Index inFace() const { return vertexAt({ 0.5, 0.5, 0 }); }
};

/// A failure of the quads of a map with defects at these vertices.
std::shared_ptr<MapAttempt> mapWithFoldsAt(std::vector<Index> vertices)
{
  auto map = carriedMap(1);
  map->transfer.defectVertices = std::move(vertices);
  return map;
}

/// The middles of the features that a plan gives up, by their x.
std::vector<double> givenUpAt(const TestRun& run, const Plan& plan)
{
  EXPECT_TRUE(plan.featuresGivenUp);
  if (!plan.featuresGivenUp)
  {
    return {};
  }
  std::vector<double> middles;
  for (const Index h : *plan.featuresGivenUp)
  {
    const Vector3 p =
      (run.mesh().position[run.mesh().origin[h]] + run.mesh().position[run.mesh().target(h)]) / 2;
    EXPECT_EQ(p.y(), 0);
    EXPECT_EQ(p.z(), 0);
    middles.push_back(p.x());
  }
  std::sort(middles.begin(), middles.end());
  return middles;
}

TEST(Recovery, FewerFeaturesGivesThemUpNearThePlacesFurtherEachTime)
{
  ScanRun run;
  const auto map = mapWithFoldsAt({ run.onEdge() });
  const std::optional<Plan> first = run.nextAfter(run.first(), map, failedQuads());
  expectStep(first, "fewer features");
  EXPECT_EQ(givenUpAt(run, *first), std::vector<double>({ 0.4375, 0.5625 }));
  EXPECT_EQ(first->featureDrops, 1);
  ASSERT_EQ(first->notices.size(), 1U);
  EXPECT_EQ(first->notices[0].find("2 sharp edges near (0.5, 0, 0) "), 0U) << first->notices[0];
  const std::optional<Plan> second = run.nextAfter(*first, map, failedQuads());
  expectStep(second, "fewer features");
  EXPECT_EQ(givenUpAt(run, *second), std::vector<double>({ 0.3125, 0.4375, 0.5625, 0.6875 }));
  EXPECT_EQ(second->featureDrops, 2);
  EXPECT_EQ(second->notices.size(), 2U);
  // On the surface they are features no more, and are again for a plan that gives up none.
  const Index h = second->featuresGivenUp->front();
  const auto isFeature = [&](const Mesh& mesh)
  { return std::pair(mesh.isFeature(h), mesh.isFeature(mesh.twin[h])); };
  EXPECT_EQ(isFeature(run.planned(*second)->mesh), std::pair(false, false));
  EXPECT_EQ(isFeature(run.planned(run.first())->mesh), std::pair(true, true));
}

TEST(Recovery, FewerFeaturesAreForThePlacesOfACoarseFailureToo)
{
  ScanRun run;
  const auto failed = failedMap();
  failed->hopeless = true;
  EXPECT_FALSE(run.nextAfter(run.first(), failed));
  failed->failedPlaces = { Vector3(0.5, 0, 0) };
  const std::optional<Plan> next = run.nextAfter(run.first(), failed);
  expectStep(next, "fewer features");
  EXPECT_EQ(givenUpAt(run, *next), std::vector<double>({ 0.4375, 0.5625 }));
}

TEST(Recovery, FewerFeaturesBeginAnewAtAnotherPlace)
{
  ScanRun run;
  const Vector3 other(1, 1, 0.5);
  Plan plan = run.first();
  for (int i = 0; i < 2; ++i)
  {
    plan = *run.nextAfter(plan, mapWithFoldsAt({ run.onEdge() }), failedQuads());
  }
  ASSERT_EQ(plan.dropped.size(), 2U);
  EXPECT_EQ(plan.dropped[1].radius, 2 * plan.dropped[0].radius);
  const std::size_t before = plan.featuresGivenUp->size();
  plan = *run.nextAfter(plan, mapWithFoldsAt({ run.vertexAt(other) }), failedQuads());
  ASSERT_EQ(plan.dropped.size(), 3U);
  EXPECT_EQ(plan.dropped[2].place, other);
  EXPECT_EQ(plan.dropped[2].radius, plan.dropped[0].radius);
  EXPECT_EQ(plan.featuresGivenUp->size(), before + 2);
}

TEST(Recovery, FewerFeaturesReachUntilThereIsOne)
{
  ScanRun run;
  const auto map = mapWithFoldsAt({ run.inFace() });
  const std::optional<Plan> failed = run.nextAfter(run.first(), map, failedQuads());
  expectStep(failed, "fewer features");
  // The edges of one side are half its width away.
  EXPECT_GT(failed->dropped[0].radius, 0.5);
  EXPECT_FALSE(run.nextAfter(run.first(), map, quadsWith(1)));
}

TEST(Recovery, FewerFeaturesForQuadsAtFoldsEndAfterFourTimes)
{
  ScanRun run;
  const auto map = mapWithFoldsAt({ run.onEdge() });
  Plan plan = run.first();
  plan.featureDrops = 3;
  EXPECT_TRUE(run.nextAfter(plan, map, quadsWith(1)));
  plan.featureDrops = 4;
  EXPECT_FALSE(run.nextAfter(plan, map, quadsWith(1)));
  EXPECT_TRUE(run.nextAfter(plan, map, failedQuads()));
}

TEST(Recovery, FewerFeaturesAreNoHelpAgainstALimitOfQuads)
{
  ScanRun run;
  const auto map = mapWithFoldsAt({ run.onEdge() });
  EXPECT_FALSE(run.nextAfter(run.first(), map, failedQuads(StatusCode::TooLarge)));
  const auto failed = failedMap();
  failed->failedPlaces = { Vector3(0.5, 0, 0) };
  EXPECT_TRUE(run.nextAfter(run.first(), failed));
  failed->status.code = StatusCode::TooLarge;
  EXPECT_FALSE(run.nextAfter(run.first(), failed));
}

TEST(Recovery, FeaturesOfADesignAndThoseThatWereAskedForStay)
{
  ScanRun run;
  const auto map = mapWithFoldsAt({ run.onEdge() });
  EXPECT_TRUE(run.nextAfter(run.first(), map, failedQuads()));
  run.setDesigned(true);
  EXPECT_FALSE(run.nextAfter(run.first(), map, failedQuads()));
  ScanRun asked;
  asked.askFor([](const Vector3&) { return true; });
  EXPECT_FALSE(asked.nextAfter(asked.first(), map, failedQuads()));
}

// A line that is drawn somewhere says nothing of features that were found by their angle.
TEST(Recovery, OnlyFeaturesThatWereAskedForStayOnAScan)
{
  ScanRun run;
  run.askFor([](const Vector3& middle) { return middle.x() > 0.5; });
  const auto map = mapWithFoldsAt({ run.onEdge() });
  const std::optional<Plan> next = run.nextAfter(run.first(), map, failedQuads());
  expectStep(next, "fewer features");
  EXPECT_EQ(givenUpAt(run, *next), std::vector<double>({ 0.4375 }));
}

// Of all of them.

TEST(Recovery, GoodQuadsNeedNothing)
{
  CubeRun run;
  const auto map = carriedMap(1);
  map->transfer.defectVertices = { run.onEdge() };
  EXPECT_FALSE(run.nextAfter(run.first(), map, quadsWith(0)));
  const auto elsewhere = quadsWith(5);
  elsewhere->invertedAtFolds = false;
  EXPECT_FALSE(run.nextAfter(run.first(), map, elsewhere));
}

TEST(Recovery, NothingIsTriedOnceTheWorkIsSpent)
{
  CubeRun run;
  WorkBound bound;
  bound.work = 1000;
  for (const std::size_t work : { 666U, 667U })
  {
    const auto map = mapWithFoldsAt({ run.onEdge() });
    map->work = work;
    History history(bound);
    history.addMap(run.first(), map);
    history.addQuads(quadsWith(1));
    EXPECT_EQ(nextPlan(run.context, history).has_value(), work + work / 2 < 1000);
  }
}

TEST(Recovery, WithoutQuadsTheLastResortIsTriedWhateverTheWork)
{
  TestRun run(test::gridPlane(12, 12), 1);
  WorkBound bound;
  bound.work = 1000;
  const auto map = carriedMap(0);
  map->work = 1000;
  const auto touching = failedQuads();
  touching->failedFaces = { 0 };
  History history(bound);
  Plan first = run.first();
  first.levels.keptVertices = { 5 };
  first.levels.coarseVertices = 7;
  history.addMap(first, map);
  EXPECT_FALSE(nextMapPlan(run.context, history));
  history.addQuads(touching);
  EXPECT_FALSE(nextPlan(run.context, history, false)); // something else follows
  const std::optional<Plan> next = nextPlan(run.context, history);
  expectStep(next, "more quads");
  EXPECT_EQ(next->why, "no valid quads");
  EXPECT_EQ(next->levels.keptVertices, run.first().levels.keptVertices);
  EXPECT_EQ(next->levels.coarseVertices, run.first().levels.coarseVertices);
}

TEST(Recovery, TheLastResortIsNoHelpAgainstALimitOfQuads)
{
  TestRun run(test::gridPlane(12, 12), 1);
  for (const StatusCode code : { StatusCode::Infeasible, StatusCode::TooLarge })
  {
    const auto touching = failedQuads(code);
    touching->failedFaces = { 0 };
    EXPECT_EQ(run.nextAfter(run.first(), carriedMap(0), touching, true).has_value(),
      code == StatusCode::Infeasible);
  }
}

TEST(Recovery, NothingIsTriedForMethodsThatRoundOnceTheyHaveAMap)
{
  CubeRun run;
  const auto map = mapWithFoldsAt({ run.onEdge() });
  for (const MapMethod method : { MapMethod::MixedInteger, MapMethod::QuadCover })
  {
    run.options.method = method;
    EXPECT_FALSE(run.nextAfter(run.first(), map, failedQuads()));
    EXPECT_FALSE(run.nextAfter(run.first(), map, quadsWith(4)));
    EXPECT_TRUE(run.nextAfter(run.first(), failedAtEdge()));
  }
  run.options.method = MapMethod::ScaleAware;
  EXPECT_TRUE(run.nextAfter(run.first(), map, failedQuads()));
}

} // namespace
} // namespace quadrille
