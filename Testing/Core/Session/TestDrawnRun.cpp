// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/DrawnRun.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

PlacedConstraint at(ConstraintKind kind, std::int64_t source, const Vector3& place, int valence = 0)
{
  PlacedConstraint placed;
  placed.kind = kind;
  placed.source = source;
  placed.path = { place };
  placed.valence = valence;
  return placed;
}

/// A surface with two features, two valences at three points, a size, a cleared feature and three curves.
struct Drawn
{
  SurfaceInput input = test::toInput(test::sphere(2));
  std::vector<PlacedConstraint> placed;

  Drawn()
  {
    const Vector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    DrawnRequests& drawn = input.drawn;
    drawn.features = { { { x, y } }, { { y, z } } };
    drawn.valences = { { x, 5 }, { y, 3 } };
    drawn.sizes = { { z, 0.5, 0.4, 0 } };
    drawn.cleared = { -x };
    input.curves = { { CurveKind::Connection, { x, z } }, { CurveKind::Cycle, { x, y, z } },
      { CurveKind::Connection, { y, z } } };
    placed = { at(ConstraintKind::Feature, 0, x), at(ConstraintKind::Feature, 1, y),
      at(ConstraintKind::Valence, 0, x, 5), at(ConstraintKind::Valence, 1, y, 3),
      at(ConstraintKind::Valence, 2, y, 3), at(ConstraintKind::Size, 0, z),
      at(ConstraintKind::Cleared, 0, -x), at(ConstraintKind::Connection, 0, x),
      at(ConstraintKind::Cycle, 1, x), at(ConstraintKind::Connection, 2, y) };
    for (std::size_t i = 7; i < placed.size(); ++i)
    {
      placed[i].curve = i - 7;
    }
  }
};

/// Runs that are only counted; they fail where `fails` says so.
class Runs
{
public:
  explicit Runs(std::function<bool(const SurfaceInput&)> fails) : fails_(std::move(fails)) {}

  int count = 0;
  SurfaceInput last;

  RemeshRun run()
  {
    return [this](SurfaceInput input, const RemeshOptions&)
    {
      ++count;
      UncutResult made;
      if (fails_(input))
      {
        made.remeshed.status = { StatusCode::Infeasible, "there is no map" };
      }
      last = std::move(input);
      return made;
    };
  }

private:
  std::function<bool(const SurfaceInput&)> fails_;
};

TEST(DrawnRun, WhatIsMetIsRunOnce)
{
  Drawn drawn;
  Runs runs([](const SurfaceInput&) { return false; });
  std::vector<std::string> notices;
  const UncutResult made = remeshWithDrawn(drawn.input, {}, runs.run(), {}, drawn.placed, notices);
  EXPECT_TRUE(made.remeshed.status.ok());
  EXPECT_EQ(runs.count, 1);
  EXPECT_TRUE(notices.empty());
  EXPECT_EQ(runs.last.drawn.valences.size(), 2U);
  EXPECT_EQ(runs.last.curves.size(), 3U);
}

TEST(DrawnRun, TheLaterOneOfTwoThatFailTogetherGoes)
{
  Drawn drawn;
  Runs runs([](const SurfaceInput& input)
    { return !input.drawn.features.empty() && input.drawn.valences.size() == 2; });
  std::vector<std::string> notices;
  const UncutResult made = remeshWithDrawn(drawn.input, {}, runs.run(), {}, drawn.placed, notices);
  EXPECT_TRUE(made.remeshed.status.ok());
  // Two of the valences are one request, which goes with the second of them.
  EXPECT_EQ(drawn.placed[3].whyNot,
    "it cannot be met together with feature curve 0, feature curve 1, valence 0: there is no map");
  EXPECT_EQ(drawn.placed[4].whyNot,
    "it cannot be met together with feature curve 0, feature curve 1, valence 0: there is no map");
  for (const std::size_t i : { 0, 1, 2, 5, 6, 7, 8, 9 })
  {
    EXPECT_EQ(drawn.placed[i].whyNot, "") << i;
  }
  ASSERT_EQ(notices.size(), 2U);
  EXPECT_EQ(notices[0], "valence 1 is left out: " + drawn.placed[3].whyNot);
  EXPECT_EQ(runs.last.drawn.features.size(), 2U);
  ASSERT_EQ(runs.last.drawn.valences.size(), 1U);
  EXPECT_EQ(runs.last.drawn.valences[0].valence, 5);
}

TEST(DrawnRun, CurvesKeepTheirPlaces)
{
  Drawn drawn;
  Runs runs(
    [](const SurfaceInput& input)
    {
      for (const CurveRequest& curve : input.curves)
      {
        if (curve.kind == CurveKind::Cycle)
        {
          return true;
        }
      }
      return false;
    });
  std::vector<std::string> notices;
  remeshWithDrawn(drawn.input, {}, runs.run(), {}, drawn.placed, notices);
  EXPECT_NE(drawn.placed[8].whyNot, "");
  ASSERT_EQ(runs.last.curves.size(), 2U);
  EXPECT_EQ(drawn.placed[7].curve, 0U);
  EXPECT_EQ(drawn.placed[9].curve, 1U);
  EXPECT_EQ(runs.last.curves[1].points[0], Vector3(0, 1, 0));
  EXPECT_EQ(runs.last.drawn.sizes.size(), 1U);
  EXPECT_EQ(runs.last.drawn.cleared.size(), 1U);
}

TEST(DrawnRun, WhereTheSurfaceItselfFailsNothingGoes)
{
  Drawn drawn;
  Runs runs([](const SurfaceInput&) { return true; });
  std::vector<std::string> notices;
  const UncutResult made = remeshWithDrawn(drawn.input, {}, runs.run(), {}, drawn.placed, notices);
  EXPECT_EQ(made.remeshed.status.message, "there is no map");
  EXPECT_EQ(runs.count, 2);
  EXPECT_TRUE(notices.empty());
  EXPECT_EQ(drawn.placed[3].whyNot, "");
}

/// Runs that have quads, but for so many of three components.
RemeshRun runsWithout(std::function<std::size_t(const SurfaceInput&)> failed, int& count)
{
  return [failed, &count](const SurfaceInput& input, const RemeshOptions&)
  {
    ++count;
    UncutResult made;
    made.remeshed.failed.components = failed(input);
    made.remeshed.failed.ofComponents = 3;
    made.remeshed.failed.why = "there is no map";
    return made;
  };
}

TEST(DrawnRun, WhatLosesAComponentGoes)
{
  Drawn drawn;
  int count = 0;
  const RemeshRun run = runsWithout(
    [](const SurfaceInput& input) { return input.drawn.valences.size() == 2 ? 2U : 1U; }, count);
  std::vector<std::string> notices;
  const UncutResult made = remeshWithDrawn(drawn.input, {}, run, {}, drawn.placed, notices);
  EXPECT_EQ(made.remeshed.failed.components, 1U);
  EXPECT_EQ(drawn.placed[2].whyNot, "");
  EXPECT_NE(drawn.placed[3].whyNot.find("with it 2 of 3 connected components"), std::string::npos)
    << drawn.placed[3].whyNot;
}

TEST(DrawnRun, ComponentsThatFailWithoutWhatIsDrawnAreNoReason)
{
  Drawn drawn;
  int count = 0;
  ResultStore store(1 << 20);
  const RemeshRun run = runsWithout([](const SurfaceInput&) { return 1U; }, count);
  std::vector<std::string> notices;
  for (const int runs : { 2, 3 }) // how many components do is remembered
  {
    remeshWithDrawn(drawn.input, {}, run, { &store, nullptr }, drawn.placed, notices);
    EXPECT_EQ(count, runs);
    EXPECT_TRUE(notices.empty());
  }
}

TEST(DrawnRun, AStopEndsAll)
{
  Drawn drawn;
  int count = 0;
  const RemeshRun run = [&](SurfaceInput input, const RemeshOptions&)
  {
    UncutResult made;
    made.remeshed.status = { ++count == 4 ? StatusCode::Cancelled : StatusCode::Infeasible, "" };
    made.remeshed.status =
      input.drawn.empty() && input.curves.empty() ? Status{} : made.remeshed.status;
    return made;
  };
  std::vector<std::string> notices;
  const UncutResult made = remeshWithDrawn(drawn.input, {}, run, {}, drawn.placed, notices);
  EXPECT_EQ(made.remeshed.status.code, StatusCode::Cancelled);
  EXPECT_EQ(count, 4);
}

} // namespace
} // namespace quadrille
