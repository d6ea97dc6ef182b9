// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connections and cycles from the input to the quads.
#include "Pipeline/Pipeline.h"
#include "Quads/QuadChains.h"

#include "MeshInput.h"
#include "NearestPoint.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

RemeshOptions curveOptions(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.featureAngle.reset();
  options.threads = 2;
  options.coarseVertices = 300;
  return options;
}

std::vector<Index> irregularPoints(const QuadMesh& quads)
{
  std::vector<Index> points;
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    if (quads.valence[p] != 4 && quads.onBoundary[p] == 0)
    {
      points.push_back(p);
    }
  }
  return points;
}

/// An ellipsoid with bumps: a surface whose irregular vertices are nowhere by symmetry.
Mesh bumpyEllipsoid()
{
  Mesh mesh = sphere(5);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.1 * std::sin(5 * p.x() + 1) * std::cos(4 * p.y()) + 0.06 * std::sin(6 * p.z() + 0.5);
    p.x() *= 1.5;
    p.z() *= 0.8;
  }
  return mesh;
}

/// Between pairs of irregular vertices that no chain joins yet: the shortest such distances first.
std::vector<std::pair<Index, Index>> pairsToJoin(const QuadMesh& quads, std::size_t count)
{
  const QuadChains chains(quads);
  const std::vector<Index> points = irregularPoints(quads);
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t j = i + 1; j < points.size(); ++j)
    {
      if (chains.between(points[i], points[j]).empty())
      {
        pairs.emplace_back(points[i], points[j]);
      }
    }
  }
  const auto length = [&](const std::pair<Index, Index>& pair)
  { return (quads.points[pair.first] - quads.points[pair.second]).norm(); };
  std::stable_sort(pairs.begin(), pairs.end(),
    [&](const auto& a, const auto& b) { return length(a) < length(b); });
  pairs.resize(std::min(count, pairs.size()));
  return pairs;
}

/// A sixth of an edge length.
constexpr double kNearPlace = 0.02;

TEST(Curves, AConnectionIsAStraightChainOfEdges)
{
  const RemeshOptions options = curveOptions(800);
  const SurfaceInput input = toInput(bumpyEllipsoid());
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  std::size_t met = 0;
  const auto pairs = pairsToJoin(without.quads, 6);
  ASSERT_GE(pairs.size(), 4U);
  for (const auto& [a, b] : pairs)
  {
    SurfaceInput asked = input;
    asked.curves.push_back(
      { CurveKind::Connection, { without.quads.points[a], without.quads.points[b] } });
    const RemeshResult result = remesh(asked, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.certificate.valid());
    ASSERT_EQ(result.curves.size(), 1U);
    const CurveOutcome& outcome = result.curves.front();
    EXPECT_EQ(outcome.met, outcome.why.empty());
    met += outcome.met ? 1 : 0;
    if (!outcome.met)
    {
      continue;
    }
    const std::array<Index, 2> ends{ nearestPoint(result.quads.points, without.quads.points[a]),
      nearestPoint(result.quads.points, without.quads.points[b]) };
    EXPECT_FALSE(QuadChains(result.quads).between(ends[0], ends[1]).empty());
    // Where they were seen, which need not be where the map has them.
    EXPECT_LT((result.quads.points[ends[0]] - without.quads.points[a]).norm(), kNearPlace);
    EXPECT_LT((result.quads.points[ends[1]] - without.quads.points[b]).norm(), kNearPlace);
  }
  EXPECT_GE(met, pairs.size() - 1);
}

/// Where many cross no map may be straight along all of them.
TEST(Curves, ManyThatCrossAtOnePlaceHaveQuads)
{
  SurfaceInput input = toInput(sphere(3));
  for (int k = 0; k < 6; ++k)
  {
    const double around = M_PI * k / 6;
    CurveRequest curve;
    for (int i = -4; i <= 4; ++i)
    {
      const Vector3 beside(std::cos(around), std::sin(around), 0);
      curve.points.push_back((Vector3(0, 0, 1) + 0.15 * i * beside).normalized());
    }
    input.curves.push_back(curve);
  }
  RemeshOptions options;
  options.quads = 100;
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.curves.size(), 6U);
  EXPECT_TRUE(std::any_of(result.curves.begin(), result.curves.end(),
    [](const CurveOutcome& curve) { return curve.met; }));
  for (const CurveOutcome& curve : result.curves)
  {
    EXPECT_EQ(curve.met, curve.why.empty()) << curve.why;
  }
}

TEST(Curves, MethodsThatRoundSayThatTheyMakeNone)
{
  RemeshOptions options = curveOptions(800);
  const SurfaceInput input = toInput(bumpyEllipsoid());
  options.method = MapMethod::MixedInteger;
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  const auto pairs = pairsToJoin(without.quads, 1);
  ASSERT_EQ(pairs.size(), 1U);
  SurfaceInput asked = input;
  asked.curves.push_back({ CurveKind::Connection,
    { without.quads.points[pairs[0].first], without.quads.points[pairs[0].second] } });
  const RemeshResult result = remesh(asked, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  // Nothing is done for it, and that is told.
  EXPECT_TRUE(result.quads.points == without.quads.points);
  ASSERT_EQ(result.curves.size(), 1U);
  EXPECT_FALSE(result.curves[0].met);
  EXPECT_NE(result.curves[0].why.find("scale aware"), std::string::npos) << result.curves[0].why;
}

TEST(Curves, ACycleIsAClosedLoopOfEdges)
{
  // Round a sphere loops exist; a slanted one has to be asked for.
  const RemeshOptions options = curveOptions(800);
  SurfaceInput input = toInput(bumpyEllipsoid());
  CurveRequest cycle{ CurveKind::Cycle, {} };
  for (int i = 0; i < 24; ++i)
  {
    const double t = 2 * kPi * i / 24;
    const Vector3 p = Vector3(0.5 * std::sin(t), std::cos(t), 0.8 * std::sin(t));
    cycle.points.push_back(p.normalized());
  }
  input.curves.push_back(cycle);
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.curves.size(), 1U);
  EXPECT_TRUE(result.curves.front().met) << result.curves.front().why;
  EXPECT_FALSE(QuadChains(result.quads).closedNear(cycle.points, 0.4).empty());
}

// Four sharp edges are crossed, where quads go straight on; at any angle, and at the height that was drawn.
TEST(Curves, ACycleGoesOnAcrossSharpEdges)
{
  RemeshOptions options = curveOptions(600);
  options.featureAngle = 40 * kPi / 180;
  for (const double slant : { 0.0, 0.4 })
  {
    SurfaceInput input = toInput(unitCube(12));
    input.curves.push_back({ CurveKind::Cycle, {} });
    for (const auto& [x, y] : { std::pair(0.0, 0.0), { 0.5, 0.0 }, { 1.0, 0.0 }, { 1.0, 0.5 },
           { 1.0, 1.0 }, { 0.5, 1.0 }, { 0.0, 1.0 }, { 0.0, 0.5 } })
    {
      input.curves[0].points.emplace_back(x, y, 0.37 + slant * x);
    }
    const RemeshResult result = remesh(input, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.certificate.valid());
    ASSERT_EQ(result.curves.size(), 1U);
    EXPECT_TRUE(result.curves[0].met) << result.curves[0].why;
    EXPECT_FALSE(QuadChains(result.quads).closedNear(input.curves[0].points, 1e-6).empty());
  }
}

TEST(Curves, ACycleRoundOneIrregularVertexBringsOthersInside)
{
  // On one side of a closed line 4 - valence sums up to 4, whatever the field would have there.
  const RemeshOptions options = curveOptions(800);
  const Mesh mesh = bumpyEllipsoid();
  const SurfaceInput input = toInput(mesh);
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  const std::vector<Index> irregular = irregularPoints(without.quads);
  ASSERT_GE(irregular.size(), 3U);
  constexpr double kRadius = 0.4; // about five quads
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Vector3 centre = without.quads.points[irregular[k * irregular.size() / 3]];
    const Vector3 x = centre.unitOrthogonal();
    const Vector3 y = centre.cross(x).normalized();
    SurfaceInput asked = input;
    asked.curves.push_back({ CurveKind::Cycle, {} });
    for (int i = 0; i < 24; ++i)
    {
      const double t = 2 * kPi * i / 24;
      asked.curves[0].points.push_back(centre + kRadius * (std::cos(t) * x + std::sin(t) * y));
    }
    const RemeshResult result = remesh(asked, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.certificate.valid());
    ASSERT_EQ(result.curves.size(), 1U);
    EXPECT_TRUE(result.curves[0].met) << result.curves[0].why;
    EXPECT_FALSE(QuadChains(result.quads).closedNear(asked.curves[0].points, 0.4).empty());
  }
}

} // namespace
} // namespace quadrille
