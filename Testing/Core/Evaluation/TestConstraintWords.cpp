// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the arrays of a surface ask for, and what the words say of a plane of unit quads.
#include "Base/Angles.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/ConstraintWords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

constexpr Index kSide = 10;

Index pointAt(Index x, Index y)
{
  return y * (kSide + 1) + x;
}

/// Unit quads in the plane, columns along x.
QuadMesh plane()
{
  QuadMesh mesh;
  for (Index y = 0; y <= kSide; ++y)
  {
    for (Index x = 0; x <= kSide; ++x)
    {
      const bool atX = x == 0 || x == kSide, atY = y == 0 || y == kSide;
      mesh.points.emplace_back(x, y, 0);
      mesh.valence.push_back(4 - (atX ? 1 : 0) - (atY ? 1 : 0));
      mesh.onBoundary.push_back(atX || atY ? 1 : 0);
    }
  }
  for (Index y = 0; y < kSide; ++y)
  {
    for (Index x = 0; x < kSide; ++x)
    {
      mesh.quads.push_back(
        { pointAt(x, y), pointAt(x + 1, y), pointAt(x + 1, y + 1), pointAt(x, y + 1) });
    }
  }
  return mesh;
}

/// The same polygons as a surface.
SurfaceInput surface()
{
  const QuadMesh mesh = plane();
  std::vector<Index> offsets{ 0 }, points;
  for (const auto& quad : mesh.quads)
  {
    points.insert(points.end(), quad.begin(), quad.end());
    offsets.push_back(static_cast<Index>(points.size()));
  }
  SurfaceInput input;
  input.points = mesh.points;
  input.polygonOffsets = offsets;
  input.polygonPoints = points;
  return input;
}

/// Guides in rows 1 and 2 along x, in row 7 along the diagonal.
SurfaceInput guided()
{
  SurfaceInput input = surface();
  input.guideDirections.assign(std::size_t{ kSide } * kSide, Vector3::Zero());
  for (const Index row : { 1, 2, 7 })
  {
    for (Index x = 2; x < 8; ++x)
    {
      input.guideDirections[row * kSide + x] = row == 7 ? Vector3(1, 1, 0) : Vector3(3, 0, 0);
    }
  }
  return input;
}

TEST(ArrayConstraints, GuidesThatTouchAreOneRegion)
{
  const ArrayConstraints asked =
    arrayConstraints(guided(), [](Index polygon) { return std::int64_t{ 1000 } + polygon; });
  ASSERT_EQ(asked.guides.size(), 2U);
  EXPECT_EQ(asked.guides[0].polygons.size(), 12U);
  EXPECT_EQ(asked.guides[0].firstCell, 1012);
  EXPECT_EQ(asked.guides[1].polygons.size(), 6U);
  EXPECT_TRUE(asked.curves.empty());
  EXPECT_TRUE(asked.valences.empty());
  EXPECT_FALSE(asked.sizes);
}

TEST(ArrayConstraints, EdgesThatMeetAreOneCurveAndUnusedPointsAreTold)
{
  SurfaceInput input = surface();
  input.points.push_back(Vector3(50, 50, 0)); // of no polygon
  input.featureEdges.assign(std::size_t{ kSide } * kSide, 0);
  for (Index x = 2; x < 5; ++x)
  {
    input.featureEdges[3 * kSide + x] = 1; // y = 3
  }
  input.featureEdges[8 * kSide + 6] = 2; // x = 7
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[pointAt(4, 4)] = 3;
  input.targetValences.back() = 5;
  const ArrayConstraints asked = arrayConstraints(input);
  ASSERT_EQ(asked.curves.size(), 2U);
  EXPECT_EQ(asked.curves[0].edges.size(), 3U);
  EXPECT_EQ(asked.curves[1].edges.size(), 1U);
  ASSERT_EQ(asked.valences.size(), 2U);
  EXPECT_TRUE(asked.valences[0].isUsed);
  EXPECT_FALSE(asked.valences[1].isUsed);
}

TEST(ConstraintWords, GuidesAlongTheQuadsAreMetAndThoseAcrossAreNot)
{
  AskedConstraints asked;
  asked.arrays = arrayConstraints(guided());
  const std::vector<ConstraintWord> words = judgeConstraints(asked, plane(), {});
  ASSERT_EQ(words.size(), 2U);
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_NEAR(words[0].deviation, 0, 1e-6);
  EXPECT_FALSE(words[1].isMet);
  EXPECT_NEAR(words[1].deviation, 45, 1e-3);
  EXPECT_FALSE(words[1].reason.empty());
}

TEST(ConstraintWords, ValencesAndCurvesAreReadOffTheQuads)
{
  AskedConstraints asked;
  asked.arrays.valences = { { 1, Vector3(4, 4, 0), 4, true }, { 2, Vector3(5, 5, 0), 3, true },
    { 3, Vector3(50, 50, 0), 5, false } };
  asked.arrays.curves = { { 0, { { Vector3(2, 3, 0), Vector3(6, 3, 0) } } } };
  const std::vector<ConstraintWord> words = judgeConstraints(asked, plane(), {});
  ASSERT_EQ(words.size(), 4U);
  EXPECT_STREQ(words[1].kind, "valence");
  EXPECT_TRUE(words[1].isMet) << words[1].reason;
  EXPECT_FALSE(words[2].isMet);
  EXPECT_EQ(words[2].source, 2);
  EXPECT_FALSE(words[3].isMet);
  EXPECT_EQ(words[3].reason, "no face uses the point");
}

TEST(ConstraintWords, SizesAreComparedAgainstEachOther)
{
  const QuadMesh mesh = plane();
  AskedConstraints asked;
  asked.arrays.sizes = true;
  std::vector<double> sizes(mesh.points.size(), 7); // all alike, whatever the unit
  EXPECT_TRUE(judgeConstraints(asked, mesh, sizes)[0].isMet);
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    sizes[i] = mesh.points[i].x() < 5 ? 1 : 4;
  }
  const ConstraintWord word = judgeConstraints(asked, mesh, sizes)[0];
  EXPECT_FALSE(word.isMet);
  EXPECT_GT(word.deviation, 1.5);
  EXPECT_NE(word.reason.find("factor"), std::string::npos);
}

/// A plane with one point of valence 3 and one of 5, as far as valences are concerned.
QuadMesh withIrregularPoints()
{
  QuadMesh mesh = plane();
  mesh.valence[pointAt(3, 3)] = 3;
  mesh.valence[pointAt(6, 6)] = 5;
  return mesh;
}

PlacedConstraint placedValence(const Vector3& place, int valence)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Valence;
  placed.given = placed.path = { place };
  placed.valence = valence;
  return placed;
}

TEST(ConstraintWords, ValencesAreAsFarAsTheNearestPointThatHasThem)
{
  const QuadMesh mesh = withIrregularPoints();
  AskedConstraints asked;
  asked.placed = { placedValence({ 3.29, 3, 0 }, 3), placedValence({ 3, 3.31, 0 }, 3),
    placedValence({ 3, 4, 0 }, 5), placedValence({ 6.2, 6, 0 }, 4), placedValence({ 8, 8, 0 }, 4),
    placedValence({ 8, 8, 0 }, 7) };
  const std::vector<ConstraintWord> words = judgeConstraints(asked, mesh, {});
  ASSERT_EQ(words.size(), 6U);
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_NEAR(words[0].deviation, 0.29, 1e-12);
  EXPECT_STREQ(words[0].unit, "edge lengths");
  EXPECT_FALSE(words[1].isMet);
  EXPECT_NE(words[1].reason.find("0.31 edge lengths away"), std::string::npos) << words[1].reason;
  EXPECT_FALSE(words[2].isMet);
  EXPECT_NEAR(words[2].deviation, std::hypot(3, 2), 1e-12);
  EXPECT_FALSE(words[3].isMet); // the nearest point is the one of valence 5
  EXPECT_TRUE(words[4].isMet);
  EXPECT_FALSE(words[5].isMet);
  EXPECT_TRUE(std::isnan(words[5].deviation));
  // What notices say is the same.
  EXPECT_EQ(unmetNotices(words, asked).size(), 4U);
}

TEST(ConstraintWords, AMoveIsMetWhereItsOldPlaceIsRegularToo)
{
  PlacedConstraint move = placedValence({ 0, 0, 0 }, 3);
  move.kind = ConstraintKind::Move;
  AskedConstraints asked;
  for (const Vector3& from : { Vector3(2, 8, 0), Vector3(6, 6, 0) })
  {
    move.path = { from, Vector3(3, 3, 0) };
    asked.placed.push_back(move);
  }
  const std::vector<ConstraintWord> words = judgeConstraints(asked, withIrregularPoints(), {});
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_FALSE(words[1].isMet);
}

// A 6 that two vertices have become, with a vertex beside it.
TEST(ConstraintWords, AMoveIsNotMetBesideAnIrregularVertexThatWasNotToBeThere)
{
  QuadMesh mesh = plane();
  mesh.valence[pointAt(3, 3)] = 6;
  mesh.valence[pointAt(4, 3)] = 5;
  PlacedConstraint move = placedValence({ 0, 0, 0 }, 6);
  move.kind = ConstraintKind::Move;
  move.path = { Vector3(2, 8, 0), Vector3(3, 3, 0) };
  AskedConstraints asked;
  using Expected = std::vector<ValencePlace>;
  for (const Expected& irregular :
    { Expected{ { { 3, 3, 0 }, 6 } }, Expected{ { { 3, 3, 0 }, 6 }, { { 5.9, 3, 0 }, 5 } },
      Expected{ { { 3, 3, 0 }, 6 }, { { 4, 3, 0 }, 3 } } })
  {
    move.irregular = std::make_shared<const Expected>(irregular);
    asked.placed.push_back(move);
  }
  const std::vector<ConstraintWord> words = judgeConstraints(asked, mesh, {});
  EXPECT_FALSE(words[0].isMet);
  EXPECT_EQ(words[0].place, Vector3(4, 3, 0));
  EXPECT_NE(words[0].reason.find("valence 5 is 1 edge lengths"), std::string::npos)
    << words[0].reason;
  EXPECT_TRUE(words[1].isMet) << words[1].reason; // smoothing has moved it less than two edges
  EXPECT_FALSE(words[2].isMet) << "it has another valence";
  // Where it was is one that was to be near, and one that was not.
  for (const Expected& irregular :
    { Expected{ { { 3, 3, 0 }, 6 }, { { 4, 3, 0 }, 5 } }, Expected{ { { 4, 3, 0 }, 5 } } })
  {
    move.valence = 5;
    move.path = { Vector3(3, 3, 0), Vector3(4, 3, 0) };
    move.irregular = std::make_shared<const Expected>(irregular);
    asked.placed = { move };
    EXPECT_EQ(judgeConstraints(asked, mesh, {})[0].isMet, irregular.size() == 2);
  }
}

PlacedConstraint placedLine(ConstraintKind kind, const std::vector<Vector3>& line)
{
  PlacedConstraint placed;
  placed.kind = kind;
  placed.given = placed.path = line;
  placed.curve = 0;
  return placed;
}

TEST(ConstraintWords, AConnectionIsMetWhereChainAndLineAreNearEachOtherBothWays)
{
  AskedConstraints asked;
  asked.curves.resize(1);
  // From the point of valence 3 to the boundary: along the chain there; beside it; by a detour that leaves it; and from
  // where nothing irregular is.
  for (const std::vector<Vector3>& line :
    { std::vector<Vector3>{ { 3, 3, 0 }, { 3, 0, 0 } }, { { 3.4, 3, 0 }, { 3.4, 0, 0 } },
      { { 3, 3, 0 }, { 9.5, 3, 0 }, { 3, 0, 0 } }, { { 3, 4.5, 0 }, { 3, 0, 0 } } })
  {
    asked.placed.push_back(placedLine(ConstraintKind::Connection, line));
  }
  const std::vector<ConstraintWord> words = judgeConstraints(asked, withIrregularPoints(), {});
  ASSERT_EQ(words.size(), 4U);
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_NEAR(words[0].deviation, 0, 1e-12);
  EXPECT_TRUE(words[1].isMet) << words[1].reason;
  EXPECT_NEAR(words[1].deviation, 0.4, 1e-12);
  EXPECT_FALSE(words[2].isMet);
  EXPECT_NE(words[2].reason.find("within 6 edge lengths"), std::string::npos) << words[2].reason;
  EXPECT_FALSE(words[3].isMet);
  EXPECT_NE(words[3].reason.find("1.5 edge lengths from an end"), std::string::npos)
    << words[3].reason;

  // Where the map tells why it has no line, a chain that is there without it says nothing.
  asked.curves[0].why = "an irregular vertex stands in the way";
  const std::vector<ConstraintWord> told = judgeConstraints(asked, withIrregularPoints(), {});
  EXPECT_TRUE(told[0].isMet) << told[0].reason;
  EXPECT_FALSE(told[3].isMet);
  EXPECT_EQ(told[3].reason, asked.curves[0].why);
}

/// Both sides of a wall that is a tenth of an edge thick.
QuadMesh thinWall()
{
  QuadMesh wall = plane();
  QuadMesh below = plane();
  const Index before = static_cast<Index>(wall.points.size());
  for (Vector3& p : below.points)
  {
    p.z() = -0.1;
  }
  wall.points.insert(wall.points.end(), below.points.begin(), below.points.end());
  wall.valence.insert(wall.valence.end(), below.valence.begin(), below.valence.end());
  wall.onBoundary.insert(wall.onBoundary.end(), below.onBoundary.begin(), below.onBoundary.end());
  for (const auto& [a, b, c, d] : below.quads)
  {
    wall.quads.push_back({ before + d, before + c, before + b, before + a });
  }
  return wall;
}

TEST(ConstraintWords, WhatLiesOnTheOtherSideOfAThinWallIsNotMeant)
{
  QuadMesh wall = thinWall();
  AskedConstraints asked;
  asked.curves.resize(1);
  asked.placed = { placedValence({ 3, 5, 0 }, 5), placedValence({ 3, 5, 0 }, 4),
    placedLine(ConstraintKind::Connection, { { 3, 5, 0 }, { 7, 5, 0 } }) };
  const Index below = (kSide + 1) * (kSide + 1);
  wall.valence[below + pointAt(3, 5)] = wall.valence[below + pointAt(7, 5)] = 5;
  std::vector<ConstraintWord> words = judgeConstraints(asked, wall, {});
  EXPECT_FALSE(words[0].isMet);
  EXPECT_TRUE(words[1].isMet) << words[1].reason;
  EXPECT_FALSE(words[2].isMet);
  wall.valence[pointAt(3, 5)] = wall.valence[pointAt(7, 5)] = 5;
  words = judgeConstraints(asked, wall, {});
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_FALSE(words[1].isMet);
  EXPECT_TRUE(words[2].isMet) << words[2].reason;
}

/// Unit quads round an axis, so many round and along.
QuadMesh tube(Index round, Index along)
{
  QuadMesh mesh;
  const double radius = 0.5 / std::sin(kPi / round);
  for (Index z = 0; z <= along; ++z)
  {
    for (Index i = 0; i < round; ++i)
    {
      const double angle = 2 * kPi * i / round;
      const bool isEnd = z == 0 || z == along;
      mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      mesh.valence.push_back(isEnd ? 3 : 4);
      mesh.onBoundary.push_back(isEnd ? 1 : 0);
    }
  }
  for (Index z = 0; z < along; ++z)
  {
    for (Index i = 0; i < round; ++i)
    {
      const Index next = (i + 1) % round;
      mesh.quads.push_back(
        { z * round + i, z * round + next, (z + 1) * round + next, (z + 1) * round + i });
    }
  }
  return mesh;
}

TEST(ConstraintWords, ACycleIsMetWhereAChainClosesAlongTheLine)
{
  constexpr Index kRound = 16, kAlong = 24;
  const QuadMesh mesh = tube(kRound, kAlong);
  AskedConstraints asked;
  std::vector<Vector3> ring, detour, told, far;
  for (Index i = 0; i <= kRound; ++i)
  {
    Vector3 p = mesh.points[10 * kRound + i % kRound];
    ring.emplace_back(p + Vector3(0, 0, 0.3));
    // Up to 13 edges away, so that each ring leaves some of it.
    p.z() += i == kRound / 2 ? 13 : 0;
    detour.push_back(p);
    // The ring half way up is two edges away from all of it, or four.
    p.z() -= i == kRound / 2 ? 9 : 0;
    told.push_back(p);
    p.z() += i == kRound / 2 ? 4 : 0;
    far.push_back(p);
  }
  for (const std::vector<Vector3>& line : { ring, detour, told, far })
  {
    asked.placed.push_back(placedLine(ConstraintKind::Cycle, line));
  }
  const std::vector<ConstraintWord> words = judgeConstraints(asked, mesh, {});
  ASSERT_EQ(words.size(), 4U);
  EXPECT_EQ(words[0].reason, "");
  EXPECT_EQ(words[0].remark, "");
  EXPECT_FALSE(words[2].isMet);
  EXPECT_NE(words[2].reason.find("up to 2 edge lengths away"), std::string::npos)
    << words[2].reason;
  EXPECT_FALSE(words[3].isMet);
  EXPECT_NE(words[3].reason.find("up to 4 edge lengths away"), std::string::npos)
    << words[3].reason;
  EXPECT_EQ(words[3].remark, "");
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_NEAR(words[0].deviation, 0.3, 1e-9);
  EXPECT_FALSE(words[1].isMet);
}

TEST(ConstraintMeasures, SizesAreThoseOfTheQuadsWithinTheRadius)
{
  const QuadMesh mesh = plane(); // of edge length 1
  ConstraintMeasures measures(mesh);
  std::vector<Index> quads;
  const ConstraintMeasure met = measures.size({ 5, 5, 0 }, 1, { 0.5, 2 }, &quads); // 0.5 of 2 is 1
  EXPECT_EQ(quads.size(), 4U);
  EXPECT_TRUE(met.isMet) << met.reason;
  EXPECT_NEAR(met.deviation, 1, 1e-12);
  quads.clear();
  const ConstraintMeasure missed = measures.size({ 5, 5, 0 }, 0, { 2, 1 }, &quads);
  EXPECT_EQ(quads.size(), 4U); // those round the point
  EXPECT_FALSE(missed.isMet);
  EXPECT_NEAR(missed.deviation, 2, 1e-12);
}

// 0.1 beside an edge of 0.2 whose quad has edges of 0.87 in the mean: a tenth of an edge length and not a half.
TEST(ConstraintMeasures, CurvesAreMeasuredInTheEdgeLengthOfTheQuadsThere)
{
  QuadMesh mesh;
  mesh.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0.2, 0 }, { 0, 1, 0 } };
  mesh.quads = { { 0, 1, 2, 3 } };
  mesh.lines = { { 1, 2, kInvalidIndex, true } };
  const double edges = (1 + 0.2 + std::hypot(1, 0.8) + 1) / 4;
  const ConstraintMeasure word =
    ConstraintMeasures(mesh).curve(std::vector<Vector3>{ { 1.1, 0, 0 }, { 1.1, 0.2, 0 } });
  EXPECT_NEAR(word.deviation, 0.1 / edges, 1e-12);
  EXPECT_TRUE(word.isMet);
}

// Other edges pass near every line: a diagonal is never farther from one than half an edge length.
TEST(ConstraintMeasures, CurvesAreMetByFeaturesAndNotByAnyEdges)
{
  QuadMesh mesh = plane();
  const std::vector<Vector3> along{ { 2, 3, 0 }, { 6, 3, 0 } };
  const ConstraintMeasure without = ConstraintMeasures(mesh).curve(along);
  EXPECT_FALSE(without.isMet);
  EXPECT_EQ(without.deviation, kInfinity);
  for (Index x = 2; x < 5; ++x)
  {
    mesh.lines.push_back({ pointAt(x, 3), pointAt(x + 1, 3), kInvalidIndex, false });
  }
  const ConstraintMeasure ending = ConstraintMeasures(mesh).curve(along);
  EXPECT_FALSE(ending.isMet);
  EXPECT_NEAR(ending.deviation, 1, 1e-12);
  EXPECT_EQ(ending.place, Vector3(6, 3, 0));
  mesh.lines.push_back({ pointAt(5, 3), pointAt(6, 3), kInvalidIndex, false });
  EXPECT_TRUE(ConstraintMeasures(mesh).curve(along).isMet);
}

// Over two parts of the surface, say.
TEST(ConstraintWords, AFeatureThatIsNotFollowedAllAlongIsNotMet)
{
  QuadMesh mesh = plane();
  mesh.lines = { { pointAt(2, 3), pointAt(3, 3), kInvalidIndex, false } };
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Feature;
  placed.given = placed.path = { { 2, 3, 0 }, { 3, 3, 0 } };
  AskedConstraints asked;
  asked.placed = { placed, placed };
  asked.placed[1].remark = "it is not followed there";
  const std::vector<ConstraintWord> words = judgeConstraints(asked, mesh, {});
  ASSERT_EQ(words.size(), 2U);
  EXPECT_TRUE(words[0].isMet) << words[0].reason;
  EXPECT_FALSE(words[1].isMet);
  EXPECT_EQ(words[1].reason, "it is not followed there");
}

// A quad that rises at 45 degrees from triangles in the plane z = 0, as at a bend of the surface.
TEST(ConstraintMeasures, GuidesAreMeasuredInThePlaneOfTheQuad)
{
  QuadMesh mesh;
  mesh.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 1 }, { 0, 1, 1 } };
  mesh.quads = { { 0, 1, 2, 3 } };
  mesh.valence = { 2, 2, 2, 2 };
  mesh.onBoundary = { 1, 1, 1, 1 };
  GuidedPlace asked;
  asked.place = { 0.5, 0.5, 0.5 };
  asked.normal = Vector3::UnitZ();
  asked.direction = Vector3(std::cos(radians(7)), std::sin(radians(7)), 0);
  asked.area = 1;
  const ConstraintMeasure word = ConstraintMeasures(mesh).guide({ asked }, 1);
  // Half of the way aside is along the quad, by 1 / sqrt(2) along its rising edges.
  EXPECT_NEAR(std::tan(radians(word.deviation)), std::tan(radians(7)) * std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(word.isMet);
}

TEST(ConstraintWords, WithoutQuadsNothingIsMetAndAPointOffTheSurfaceIsTold)
{
  AskedConstraints asked;
  PlacedConstraint valence;
  valence.kind = ConstraintKind::Valence;
  valence.source = 9;
  valence.given = { Vector3(4, 4, 8) };
  valence.path = { Vector3(4, 4, 0) };
  valence.valence = 3;
  asked.placed = { valence };
  const std::vector<ConstraintWord> words = judgeConstraints(asked, plane(), {});
  ASSERT_EQ(words.size(), 1U);
  EXPECT_TRUE(words[0].isOffSurface);
  EXPECT_EQ(offSurfaceNotices(words).size(), 1U);
  EXPECT_EQ(metOfDrawn(words, asked), std::vector<bool>{ false });
  EXPECT_EQ(unmetNotices(words, asked).size(), 1U);
  const std::vector<ConstraintWord> none = judgeConstraints(asked, QuadMesh{}, {});
  ASSERT_EQ(none.size(), 1U);
  EXPECT_FALSE(none[0].isMet);
  EXPECT_TRUE(unmetNotices(none, asked).empty());
}

} // namespace
} // namespace quadrille
