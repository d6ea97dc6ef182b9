// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which of hand-made attempts counts, and what is told of all of them.
#include "Pipeline/History.h"

#include "HandMadeAttempts.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

namespace quadrille
{
namespace
{

using test::carriedMap;
using test::failedMap;
using test::failedQuads;
using test::planOf;
using test::quadsWith;

using Texts = std::vector<std::string>;

/// A round of one map.
void addRound(History& history, const Plan& plan, const std::shared_ptr<MapAttempt>& map,
  std::shared_ptr<const QuadAttempt> quads)
{
  history.addMap(plan, map);
  history.addQuads(std::move(quads));
}

/// The one record of a stage.
StageRecord recordOf(const StageRecords& stages, const std::string& name)
{
  StageRecord found;
  for (const StageRecord& record : stages.all())
  {
    if (record.stage == name)
    {
      EXPECT_TRUE(found.stage.empty()) << name;
      found = record;
    }
  }
  EXPECT_EQ(found.stage, name);
  return found;
}

TEST(History, TheLastMapOfARoundCounts)
{
  History history;
  const auto failed = failedMap(), carried = carriedMap(5);
  history.addMap(planOf("first"), failed);
  EXPECT_FALSE(history.hasMap());
  EXPECT_EQ(history.last().map, failed);
  history.addMap(planOf("more freedom"), carried);
  EXPECT_TRUE(history.hasMap());
  EXPECT_EQ(history.last().map, carried);
}

TEST(History, QuadsBelongToTheLastMapAndEndTheRound)
{
  History history;
  const auto first = carriedMap(1), other = carriedMap(9);
  const auto quads = quadsWith(1);
  history.addMap(planOf("first"), first);
  history.addQuads(quads);
  EXPECT_EQ(history.last().map, first);
  EXPECT_STREQ(history.last().plan.step, "first");
  EXPECT_EQ(history.last().quads, quads);
  EXPECT_EQ(history.result().map, first);
  history.addMap(planOf("counterparts"), other);
  EXPECT_EQ(history.last().map, other);
  EXPECT_EQ(history.last().quads, nullptr);
  EXPECT_EQ(history.result().map, first);
}

TEST(History, ARoundWithoutMapHasNoneAtItsEndEither)
{
  History history;
  const auto failed = failedMap();
  addRound(history, planOf("first"), failed, nullptr);
  EXPECT_FALSE(history.hasMap());
  EXPECT_FALSE(history.hasResult());
  EXPECT_EQ(history.last().map, failed);
  EXPECT_EQ(history.result().map, failed);
}

TEST(History, LaterQuadsCountWithAtMostHalfAsManyInverted)
{
  History history;
  const auto add = [&](std::size_t inverted)
  {
    addRound(history, planOf("counterparts"), carriedMap(1), quadsWith(inverted));
    EXPECT_EQ(history.last().quads->invertedQuads, inverted);
    return history.result().quads->invertedQuads;
  };
  EXPECT_EQ(add(10), 10U);
  EXPECT_EQ(add(6), 10U);
  EXPECT_EQ(add(5), 5U);
  EXPECT_EQ(add(3), 5U);
  EXPECT_EQ(add(2), 2U);
}

TEST(History, FailuresAfterAGoodAttemptDoNotHideIt)
{
  History history;
  addRound(history, planOf("first"), carriedMap(2), failedQuads());
  EXPECT_FALSE(history.hasResult());
  const auto good = carriedMap(3);
  addRound(history, planOf("more quads"), good, quadsWith(4));
  addRound(history, planOf("counterparts"), carriedMap(0), failedQuads());
  EXPECT_EQ(history.result().map, good);
  const auto failed = failedMap();
  addRound(history, planOf("counterparts"), failed, nullptr);
  EXPECT_TRUE(history.hasResult());
  EXPECT_EQ(history.result().map, good);
  EXPECT_STREQ(history.result().plan.step, "more quads");
  EXPECT_EQ(history.last().map, failed);
}

TEST(History, WithoutQuadsTheLastRoundIsTheResult)
{
  History history;
  addRound(history, planOf("first"), carriedMap(2), failedQuads());
  const auto later = carriedMap(7);
  const auto quads = failedQuads();
  addRound(history, planOf("more quads"), later, quads);
  EXPECT_EQ(history.result().map, later);
  EXPECT_EQ(history.result().quads, quads);
}

TEST(History, StepsAreThoseOfTheRound)
{
  History history;
  history.addMap(planOf("more freedom"), failedMap({ 1, 2, 3 }));
  history.addMap(planOf("more freedom"), carriedMap(1));
  history.addMap(planOf("counterparts"), failedMap());
  EXPECT_EQ(history.inRound("more freedom"), 2U);
  EXPECT_EQ(history.inRound("counterparts"), 1U);
  EXPECT_EQ(history.inRound("first"), 0U);
  history.addQuads(quadsWith(1));
  history.addMap(planOf("more freedom"), failedMap());
  EXPECT_EQ(history.inRound("more freedom"), 1U);
  EXPECT_EQ(history.inRound("counterparts"), 0U);
}

WorkBound boundOf(std::size_t work)
{
  WorkBound bound;
  bound.work = work;
  bound.ofMap = 2 * work;
  bound.ofAttempt = 10;
  bound.attempts = 8;
  bound.attemptsOfLastResort = 4;
  bound.workOfLastResort = 500;
  return bound;
}

std::shared_ptr<MapAttempt> ofWork(std::shared_ptr<MapAttempt> map, std::size_t work)
{
  map->work = work;
  return map;
}

TEST(History, IsSpentByTheWorkOfAllRounds)
{
  History history(boundOf(1000));
  addRound(history, planOf("first"), ofWork(failedMap(), 489), nullptr);
  EXPECT_FALSE(history.isSpent());
  addRound(history, planOf("counterparts"), ofWork(failedMap(), 490), nullptr);
  EXPECT_EQ(history.work(), 999U); // with what attempts take beside their maps
  EXPECT_FALSE(history.isSpent());
  addRound(history, planOf("counterparts"), ofWork(failedMap(), 0), nullptr);
  EXPECT_TRUE(history.isSpent());
}

TEST(History, WithQuadsAnotherAttemptHasToFit)
{
  for (const std::size_t work : { 656U, 657U })
  {
    History history(boundOf(1000));
    addRound(history, planOf("first"), ofWork(carriedMap(1), work), quadsWith(1));
    EXPECT_EQ(history.isSpent(), work == 657U); // which makes 667, and half of it 333
    EXPECT_EQ(history.allowance(), 1000 - work - 10);
    // Those before count, too.
    EXPECT_TRUE(History(boundOf(1000), 1000).isSpent());
    EXPECT_EQ(History(boundOf(1000), 600).allowance(), 2000U);
  }
}

TEST(History, AMapThatQuadsCanBeMadeOfCountsAsQuads)
{
  History history(boundOf(1000));
  EXPECT_EQ(history.allowance(), 2000U);
  history.addMap(planOf("first"), ofWork(failedMap(), 690));
  EXPECT_EQ(history.allowance(), 2000U);
  EXPECT_FALSE(history.isSpent());
  history.addMap(planOf("more freedom"), ofWork(carriedMap(1), 190));
  EXPECT_EQ(history.allowance(), 100U);
  EXPECT_TRUE(history.isSpent()); // half of another one like it would take 100
}

TEST(History, IsSpentByTheNumberOfAttempts)
{
  History history(boundOf(1000), 0, 2);
  EXPECT_EQ(history.attempts(), 2U);
  addRound(history, planOf("first"), failedMap(), nullptr);
  EXPECT_FALSE(history.isSpent());
  addRound(history, planOf("counterparts"), failedMap(), nullptr);
  // Four are left for the last resort.
  EXPECT_EQ(history.attempts(), 4U);
  EXPECT_TRUE(history.isSpent());
  history.beginLastResort();
  EXPECT_FALSE(history.isSpent());
}

TEST(History, TheLastResortHasWorkOfItsOwn)
{
  History history(boundOf(1000), 2000);
  EXPECT_TRUE(history.isSpent());
  history.beginLastResort();
  addRound(history, planOf("no features"), ofWork(failedMap(), 240), nullptr);
  EXPECT_FALSE(history.isSpent());
  addRound(history, planOf("more quads"), ofWork(failedMap(), 240), nullptr);
  EXPECT_TRUE(history.isSpent());
}

TEST(History, StagesHaveTheResultsSizesAndTheSecondsOfAll)
{
  History history;
  const auto good = carriedMap(1), undone = carriedMap(8);
  good->stages.add("phase1", 1, 100, 50);
  good->stages.add("replay", 2, 20, 100);
  const auto quads = quadsWith(2), others = failedQuads();
  quads->stages.add("extract", 4, 100, 30);
  addRound(history, planOf("first"), good, quads);
  EXPECT_FALSE(history.stages().has("retries"));

  undone->stages.add("phase1", 8, 200, 70);
  undone->stages.add("metric", 16, 7, 7);
  undone->stages.add("replay", 32, 40, 200);
  others->stages.add("extract", 64, 200, 0);
  others->stages.add("optimize", 128, 9, 9);
  addRound(history, planOf("counterparts"), undone, others);
  const StageRecords stages = history.stages();
  Texts names;
  for (const StageRecord& record : stages.all())
  {
    names.push_back(record.stage);
  }
  EXPECT_EQ(names, Texts({ "phase1", "replay", "extract", "retries" }));
  const StageRecord phase1 = recordOf(stages, "phase1");
  EXPECT_EQ(phase1.seconds, 9);
  EXPECT_EQ(phase1.elementsIn, 100U);
  EXPECT_EQ(phase1.elementsOut, 50U);
  EXPECT_EQ(recordOf(stages, "replay").seconds, 34);
  const StageRecord extract = recordOf(stages, "extract");
  EXPECT_EQ(extract.seconds, 68);
  EXPECT_EQ(extract.elementsOut, 30U);
  EXPECT_EQ(recordOf(stages, "retries").seconds, 144);
  EXPECT_EQ(history.replays(), 2);
}

TEST(History, ReusedStagesAreThoseOfAllStartedOnesThoseOfTheResult)
{
  History history;
  const auto good = carriedMap(1), undone = carriedMap(0);
  const auto quads = quadsWith(2), others = failedQuads();
  good->reused = { "phase1" };
  good->started = { "seamless" };
  quads->reused = { "extract" };
  undone->reused = { "phase2" };
  undone->started = { "embed" };
  others->reused = { "optimize" };
  EXPECT_EQ(history.started(), Texts());
  addRound(history, planOf("first"), good, quads);
  addRound(history, planOf("counterparts"), undone, others);
  EXPECT_EQ(history.reused(), Texts({ "phase1", "extract", "phase2", "optimize" }));
  EXPECT_EQ(history.started(), Texts({ "seamless" }));
}

TEST(History, NoticesOfAnAttemptThatIsUndoneAreNotTheResults)
{
  History history;
  const auto good = carriedMap(1), undone = carriedMap(0);
  const auto quads = quadsWith(4), others = quadsWith(3);
  Plan plan = planOf("first");
  plan.notices = { "of the plan" };
  good->notices = { "of the map" };
  quads->notices = { "of the quads" };
  addRound(history, plan, good, quads);
  plan = planOf("counterparts");
  plan.notices = { "of the plan", "sharp edges were not used" };
  undone->notices = { "of a map that is undone" };
  others->notices = { "of quads that are undone" };
  addRound(history, plan, undone, others);
  const Attempt& result = history.result();
  EXPECT_EQ(result.plan.notices, Texts({ "of the plan" }));
  EXPECT_EQ(result.map->notices, Texts({ "of the map" }));
  EXPECT_EQ(result.quads->notices, Texts({ "of the quads" }));
}

/// uv with another value at each corner of a vertex where x is 1, as along a cut.
std::vector<FixedVec2> cutMap(const Mesh& mesh, std::int64_t offset)
{
  std::vector<FixedVec2> uv;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const std::int64_t v = std::int64_t{ mesh.origin[h] } + offset;
    uv.push_back({ v, mesh.position[mesh.origin[h]].x() == 1 ? std::int64_t{ h } : -v });
  }
  return uv;
}

TEST(History, PackedMapsKeepTheirUv)
{
  const Mesh mesh = test::gridPlane(3, 2);
  History history;
  const auto ofResult = carriedMap(4), last = carriedMap(2);
  ofResult->uv = cutMap(mesh, 10);
  last->uv = cutMap(mesh, 20);
  addRound(history, planOf("first"), ofResult, quadsWith(2));
  history.addMap(planOf("counterparts"), last);
  EXPECT_EQ(last->uv.size(), mesh.halfEdgeCount()); // its quads may come next
  history.packMaps(mesh);
  history.packMaps(mesh);
  for (const auto& map : { ofResult, last })
  {
    EXPECT_TRUE(map->uv.empty());
    EXPECT_GT(map->packed.bytes(), 0U);
    map->unpack(mesh);
    EXPECT_EQ(map->packed.bytes(), 0U);
    map->unpack(mesh);
  }
  EXPECT_EQ(ofResult->uv, cutMap(mesh, 10));
  EXPECT_EQ(last->uv, cutMap(mesh, 20));
}

} // namespace
} // namespace quadrille
