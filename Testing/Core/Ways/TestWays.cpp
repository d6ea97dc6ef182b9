// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ways/Ways.h"

#include "Base/Error.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Fine enough to be thinned out: 1,048,576 triangles.
SurfaceInput fineTorus()
{
  return toInput(torus(1024, 512, 2, 0.8));
}

/// Two triangles of a torus that follow each other are a square cut in two.
SurfaceInput squaresOf(const SurfaceInput& triangles)
{
  SurfaceInput squares;
  squares.points = triangles.points;
  squares.polygonOffsets.push_back(0);
  for (std::size_t t = 0; t + 6 <= triangles.polygonPoints.size(); t += 6)
  {
    const Index* const p = triangles.polygonPoints.data() + t;
    std::vector<Index> corners(p, p + 3);
    for (std::size_t i = 0; i < 3 && corners.size() == 3; ++i)
    {
      const auto at = std::find(p + 3, p + 6, p[i]);
      const auto next = std::find(p + 3, p + 6, p[(i + 1) % 3]);
      if (at != p + 6 && next != p + 6)
      {
        corners.insert(
          corners.begin() + static_cast<std::ptrdiff_t>(i) + 1, p[3] + p[4] + p[5] - *at - *next);
      }
    }
    EXPECT_EQ(corners.size(), 4U);
    for (const Index corner : corners)
    {
      squares.polygonPoints.push_back(corner);
    }
    squares.polygonOffsets.push_back(static_cast<Index>(squares.polygonPoints.size()));
  }
  return squares;
}

QuadProblem problemOf(SurfaceInput& input, std::size_t quads = 200)
{
  QuadProblem problem;
  problem.surface = given(input);
  problem.options.quads = quads;
  problem.options.threads = 2;
  return problem;
}

/// Points lie where their sources say.
void expectPlaces(const QuadsMade& made, const SurfaceInput& input)
{
  const QuadMesh& quads = made.remeshed.quads;
  const std::vector<SourceLocation> sources = made.pointSources(2);
  ASSERT_EQ(sources.size(), quads.points.size());
  for (std::size_t p = 0; p < sources.size(); ++p)
  {
    Vector3 place = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      place += sources[p].weights[k] * input.points[sources[p].points[k]];
    }
    EXPECT_LT((place - quads.points[p]).norm(), 1e-9);
  }
  const std::vector<Index> polygons = made.quadPolygons(sources);
  ASSERT_EQ(polygons.size(), quads.quads.size());
  for (const Index polygon : polygons)
  {
    EXPECT_LT(polygon, input.polygonOffsets.size() - 1);
  }
}

QuadsMade expectWay(const SurfaceInput& surface, Way way, const QuadProblem& asked)
{
  SurfaceInput input = surface;
  QuadProblem problem = asked;
  problem.surface = given(input);
  QuadsMade made = remesh(problem);
  EXPECT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_EQ(made.way, way) << made.whyNotThinned;
  if (!problem.options.preview)
  {
    expectPlaces(made, surface);
  }
  return made;
}

TEST(Ways, AFineSurfaceIsThinnedOut)
{
  const SurfaceInput surface = fineTorus();
  SurfaceInput input;
  QuadProblem problem = problemOf(input);
  const QuadsMade made = expectWay(surface, Way::Thinned, problem);
  EXPECT_TRUE(made.whyNotThinned.empty());
  ASSERT_TRUE(made.thinning);
  EXPECT_NE(made.thinning->text().find("thinned out to"), std::string::npos);
  // As many quads by the length of their edges.
  problem.options.quads.reset();
  problem.options.edgeLength = made.remeshed.targetEdgeLength;
  const QuadsMade byLength = expectWay(surface, Way::Thinned, problem);
  EXPECT_EQ(byLength.remeshed.quads.quads.size(), made.remeshed.quads.quads.size());
  problem.options.preview = true;
  const QuadsMade preview = expectWay(surface, Way::Thinned, problem);
  EXPECT_EQ(preview.remeshed.quads.quads.size(), made.remeshed.quads.quads.size());
}

TEST(Ways, SoIsOneOfOtherPolygons)
{
  SurfaceInput none;
  expectWay(squaresOf(fineTorus()), Way::Thinned, problemOf(none));
}

/// On thinned triangles, too, what cannot be met together with what comes before it is left out: where the valence at
/// the corner has no map.
TEST(Ways, WhatHasNoQuadsOnThinnedTrianglesIsLeftOut)
{
  constexpr int side = 720;
  constexpr double length = side;
  SurfaceInput surface = toInput(gridPlane(side, side));
  surface.drawn.valences = { { { 0.8 * length, 0.8 * length, 0 }, 5 },
    { { 0.999 * length, 0.999 * length, 0 }, 8 }, { { 0.2 * length, 0.2 * length, 0 }, 3 } };
  std::vector<PlacedConstraint> placed(surface.drawn.valences.size());
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    placed[i].kind = ConstraintKind::Valence;
    placed[i].source = static_cast<std::int64_t>(i);
    placed[i].path = { surface.drawn.valences[i].place };
    placed[i].valence = surface.drawn.valences[i].valence;
  }
  SurfaceInput none;
  QuadProblem problem = problemOf(none, 40);
  problem.placed = &placed;
  const QuadsMade made = expectWay(surface, Way::Thinned, problem);
  EXPECT_TRUE(made.thinning);
  EXPECT_EQ(placed[0].whyNot, "");
  EXPECT_EQ(placed[1].whyNot.find("it cannot be met together with valence 0: "), 0U)
    << placed[1].whyNot;
  EXPECT_EQ(placed[2].whyNot, "");
  ASSERT_EQ(made.warnings.size(), 1U);
  EXPECT_EQ(made.warnings[0], "valence 1 is left out: " + placed[1].whyNot);
}

/// The reasons that keep a surface whole, each with its words.
TEST(Ways, WhatNeedsTheWholeSurface)
{
  const SurfaceInput surface = toInput(torus(60, 30, 2, 0.8));
  const auto reason = [&](const auto& change, Way way = Way::Whole)
  {
    SurfaceInput none;
    QuadProblem problem = problemOf(none);
    change(problem);
    return expectWay(surface, way, problem).whyNotThinned;
  };
  const auto has = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(reason([](QuadProblem&) {}), "few triangles"));
  EXPECT_TRUE(has(reason([](QuadProblem& p) { p.options.mergeCharts = true; }), "mapped surface"));
  EXPECT_TRUE(
    has(reason([](QuadProblem& p) { p.options.method = MapMethod::Seamless; }), "'seamless'"));
  EXPECT_TRUE(has(reason([](QuadProblem& p) { p.cellsByArea = true; }), "by area"));
  EXPECT_TRUE(has(
    reason([](QuadProblem& p) { p.options.finalQuality = FinalQuality::Input; }), "final quality"));
  EXPECT_TRUE(
    has(reason([](QuadProblem& p) { p.symmetry.emplace(); }, Way::Symmetric), "symmetric quads"));
  SurfaceInput guided = surface;
  guided.guideDirections.assign(guided.polygonOffsets.size() - 1, Vector3::UnitX());
  SurfaceInput none;
  EXPECT_TRUE(
    has(expectWay(guided, Way::Whole, problemOf(none)).whyNotThinned, "directions of guides"));
  ResultStore store(std::size_t{ 1 } << 28);
  EXPECT_TRUE(has(reason([&](QuadProblem& p) { p.store = &store; }), "kept for the next edit"));
  EXPECT_TRUE(has(reason([](QuadProblem& p) { p.thinning = Thinning::Never; }), "whole"));
}

namespace
{

PlacedConstraint moveOnSphere(const Vector3& from)
{
  PlacedConstraint move;
  move.kind = ConstraintKind::Move;
  move.path = { from, (from + 0.15 * from.unitOrthogonal()).normalized() };
  return move;
}

} // namespace

/// A move is made on the whole surface, from the quads that it has without.
TEST(Ways, MovesHoldIrregularVerticesOnTheWholeSurface)
{
  const SurfaceInput surface = toInput(sphere(4));
  SurfaceInput none;
  QuadProblem problem = problemOf(none);
  const QuadsMade before = expectWay(surface, Way::Whole, problem);
  const std::vector<int>& valence = before.remeshed.quads.valence;
  const auto irregular = std::find_if(
    valence.begin(), valence.end(), [](int edges) { return edges != kRegularValence; });
  ASSERT_NE(irregular, valence.end());
  const Vector3 from =
    before.remeshed.quads.points[static_cast<std::size_t>(irregular - valence.begin())];
  std::vector<PlacedConstraint> placed{ moveOnSphere(from) };
  problem.placed = &placed;
  const QuadsMade made = expectWay(surface, Way::Whole, problem);
  EXPECT_EQ(made.whyNotThinned, "irregular vertices are held where they are on the whole surface");
  EXPECT_EQ(placed.front().whyNot, "");
  EXPECT_EQ(placed.front().valence, *irregular);
}

/// Of the quads without moves an earlier run may have left all that is needed, if nothing else has changed.
TEST(Ways, MovesAreTheSameWithAStore)
{
  SurfaceInput surface = toInput(sphere(4));
  SurfaceInput none;
  QuadProblem problem = problemOf(none);
  const QuadsMade before = expectWay(surface, Way::Whole, problem);
  const std::vector<int>& valence = before.remeshed.quads.valence;
  const auto irregular = std::find_if(
    valence.begin(), valence.end(), [](int edges) { return edges != kRegularValence; });
  ASSERT_NE(irregular, valence.end());
  const Vector3 from =
    before.remeshed.quads.points[static_cast<std::size_t>(irregular - valence.begin())];
  ResultStore store(std::size_t{ 1 } << 28);
  const auto expectSame = [&](double share)
  {
    std::vector<Vector3> points[2];
    for (ResultStore* with : { &store, static_cast<ResultStore*>(nullptr) })
    {
      std::vector<PlacedConstraint> placed{ moveOnSphere(from) };
      placed.front().path[1] = (from + share * from.unitOrthogonal()).normalized();
      problem.placed = &placed;
      problem.store = with;
      points[with == nullptr ? 1 : 0] =
        expectWay(surface, Way::Whole, problem).remeshed.quads.points;
      EXPECT_EQ(placed.front().whyNot, "");
    }
    EXPECT_EQ(points[0], points[1]);
    return points[0];
  };
  const std::vector<Vector3> first = expectSame(0.15);
  EXPECT_NE(expectSame(0.25), first);
  problem.options.quads = 300;
  EXPECT_NE(expectSame(0.15).size(), first.size());
  problem.options.quads = 200;
  surface.drawn.sizes = { { -from, 0.3, 0.5, 0 } };
  EXPECT_NE(expectSame(0.15).size(), first.size());
  surface.drawn.sizes.clear();
  EXPECT_EQ(expectSame(0.15), first);
}

TEST(Ways, MovesHaveAnImageToo)
{
  const SurfaceInput surface = toInput(sphere(4));
  SurfaceInput none;
  QuadProblem problem = problemOf(none);
  problem.symmetry.emplace().plane = MirrorPlane{ Vector3::Zero(), Vector3::UnitX() };
  const QuadsMade before = expectWay(surface, Way::Symmetric, problem);
  const QuadMesh& quads = before.remeshed.quads;
  std::size_t irregular = 0;
  while (quads.valence[irregular] == kRegularValence || quads.points[irregular].x() < 0.3)
  {
    ++irregular;
    ASSERT_LT(irregular, quads.points.size());
  }
  const Vector3 from = quads.points[irregular];
  std::vector<PlacedConstraint> placed{ moveOnSphere(from) };
  problem.placed = &placed;
  const QuadsMade made = expectWay(surface, Way::Symmetric, problem);
  EXPECT_EQ(placed.front().whyNot, "");
  for (const double side : { 1.0, -1.0 })
  {
    const Vector3 to(
      side * placed.front().path[1].x(), placed.front().path[1].y(), placed.front().path[1].z());
    const QuadMesh& moved = made.remeshed.quads;
    double nearest = 1;
    for (std::size_t p = 0; p < moved.points.size(); ++p)
    {
      nearest = moved.valence[p] == quads.valence[irregular]
        ? std::min(nearest, (moved.points[p] - to).norm())
        : nearest;
    }
    EXPECT_LT(nearest, 0.3 * made.remeshed.targetEdgeLength);
  }
}

TEST(Ways, PiecesAreCutWhereTheyAreAskedFor)
{
  const SurfaceInput surface = toInput(torus(160, 80, 2, 0.8));
  SurfaceInput input = surface;
  QuadProblem problem = problemOf(input);
  problem.thinning = Thinning::Always;
  const QuadsMade made = expectWay(surface, Way::Pieces, problem);
  EXPECT_EQ(made.thinning->pieces, 1U);
  problem.options.preview = true;
  const QuadsMade preview = expectWay(surface, Way::Pieces, problem);
  EXPECT_EQ(preview.remeshed.quads.quads.size(), made.remeshed.quads.quads.size());
  problem.options.preview = false;
  SurfaceInput sized = surface;
  sized.sizing.assign(sized.points.size(), 1);
  problem.surface = given(sized);
  EXPECT_THROW(remesh(problem), InvalidInput);
  problem.surface = given(input);
  problem.cellsByArea = true;
  EXPECT_THROW(remesh(problem), InvalidInput);
}

TEST(Ways, WhatCannotBeTogetherIsRefusedBeforeAnyWork)
{
  QuadProblem problem;
  problem.surface.whole = []() -> SurfaceInput
  { throw std::logic_error("the surface was asked for"); };
  problem.options.preview = true;
  problem.symmetry.emplace();
  EXPECT_THROW(remesh(problem), InvalidInput);
  EXPECT_EQ(whyNotSpread(problem), "symmetric quads need the whole surface");
  problem.symmetry.reset();
  EXPECT_EQ(whyNotSpread(problem), "a preview has no quads on the surface");
  problem.options.method = MapMethod::Seamless;
  EXPECT_THROW(remesh(problem), InvalidInput);
  EXPECT_EQ(whyNotSpread({}), "");
}

TEST(Ways, ASymmetryIsOneOfAnyPolygons)
{
  const SurfaceInput triangles = toInput(torus(60, 30, 2, 0.8));
  SurfaceInput none;
  QuadProblem problem = problemOf(none);
  problem.symmetry.emplace().plane = MirrorPlane{ Vector3::Zero(), Vector3::UnitX() };
  problem.options.finalQuality = FinalQuality::Input;
  problem.options.mergeCharts = true;
  for (const SurfaceInput& surface : { triangles, squaresOf(triangles) })
  {
    const QuadsMade made = expectWay(surface, Way::Symmetric, problem);
    ASSERT_TRUE(made.symmetry);
    EXPECT_EQ(made.symmetry->mirrorPoint.size(), made.remeshed.quads.points.size());
    EXPECT_GT(made.remeshed.charts.charts, 0U);
  }
}

} // namespace
} // namespace quadrille
