// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/Fillets.h"

#include "Base/Error.h"
#include "SurfaceInputs.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace quadrille
{
namespace
{

constexpr double kAngle = 40 * test::kPi / 180;
constexpr int kRows = 8;

/// A sheet along y, kRows wide, over a curve in the plane of x and z: one column for each of its edges.
Mesh alongCurve(const std::vector<Vector2>& curve)
{
  const int columns = static_cast<int>(curve.size()) - 1;
  Mesh mesh = test::gridPlane(columns, kRows);
  for (Vector3& p : mesh.position.editAll())
  {
    const Vector2& at = curve[static_cast<std::size_t>(std::lround(p.x()))];
    p = Vector3(at.x(), p.y(), at.y());
  }
  return mesh;
}

/// From each point on by `length` in a direction that turns by `turn` (radians) in equal bends, one more than there are
/// facets; straight for `straight` before and behind.
std::vector<Vector2> bentCurve(int facets, double turn, double width, double straight)
{
  std::vector<Vector2> curve{ { 0, 0 }, { straight, 0 } };
  double angle = 0;
  for (int i = 0; i <= facets; ++i)
  {
    angle -= turn / (facets + 1);
    const double length = i < facets ? width / facets : straight;
    curve.push_back(curve.back() + length * Vector2(std::cos(angle), std::sin(angle)));
  }
  return curve;
}

/// The places in x and z of the marked edges, each of which leads along y.
std::multiset<std::pair<double, double>> placesOf(const Mesh& mesh, const std::vector<Index>& edges)
{
  std::multiset<std::pair<double, double>> places;
  for (const Index h : edges)
  {
    EXPECT_TRUE(mesh.isFeature(h) && mesh.isFeature(mesh.twin[h]));
    const Vector3 way = mesh.edgeVector(h);
    EXPECT_NEAR(std::abs(way.y()), 1, 1e-12);
    EXPECT_NEAR(std::hypot(way.x(), way.z()), 0, 1e-12);
    const Vector3& p = mesh.position[mesh.origin[h]];
    places.insert({ p.x(), p.z() });
  }
  return places;
}

TEST(Fillets, TheLineInTheMiddleOfANarrowOneIsMarked)
{
  for (const int facets : { 2, 4, 16 })
  {
    for (const double sense : { 1.0, -1.0 })
    {
      const std::vector<Vector2> curve = bentCurve(facets, sense * test::kPi / 2, 0.5, 3);
      Mesh mesh = alongCurve(curve);
      const auto places = placesOf(mesh, markFillets(mesh, kAngle, 1, 1));
      const Vector2& middle = curve[1 + static_cast<std::size_t>(facets) / 2];
      EXPECT_EQ(places.size(), kRows) << facets;
      EXPECT_EQ(places.count({ middle.x(), middle.y() }), kRows) << facets;
      EXPECT_EQ(test::featureHalfEdges(mesh), 2 * kRows) << facets;
    }
  }
}

TEST(Fillets, OfTwoLinesBesideTheMiddleOneIsMarked)
{
  const std::vector<Vector2> curve = bentCurve(5, test::kPi / 2, 0.5, 3);
  Mesh mesh = alongCurve(curve);
  const auto places = placesOf(mesh, markFillets(mesh, kAngle, 1, 1));
  ASSERT_EQ(places.size(), kRows);
  EXPECT_EQ(places.count(*places.begin()), kRows);
  const double x = places.begin()->first;
  EXPECT_TRUE(x == curve[3].x() || x == curve[4].x());
}

TEST(Fillets, WideOnesAndBluntOnesAreRound)
{
  for (const auto& [turn, width] : { std::pair{ 90.0, 1.5 }, { 30.0, 0.5 } })
  {
    Mesh mesh = alongCurve(bentCurve(8, turn * test::kPi / 180, width, 3));
    EXPECT_TRUE(markFillets(mesh, kAngle, 1, 1).empty()) << turn;
  }
}

TEST(Fillets, SmallQuadsSeeThemRound)
{
  Mesh mesh = alongCurve(bentCurve(8, test::kPi / 2, 0.5, 3));
  EXPECT_TRUE(markFillets(mesh, kAngle, 0.2, 1).empty());
}

TEST(Fillets, AThinRodIsNone)
{
  // Twice round, so that its normal turns on wherever one looks.
  for (const double radius : { 0.1, 0.3, 0.6 })
  {
    std::vector<Vector2> curve;
    for (int i = 0; i <= 48; ++i)
    {
      const double angle = 4 * test::kPi * i / 48;
      curve.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    Mesh mesh = alongCurve(curve);
    EXPECT_TRUE(markFillets(mesh, kAngle, 1, 1).empty()) << radius;
  }
}

TEST(Fillets, FeaturesAsNearAsTheFilletIsWideAreLeftAlone)
{
  Mesh mesh = alongCurve(bentCurve(4, test::kPi / 2, 0.5, 0.05));
  EXPECT_TRUE(markFillets(mesh, kAngle, 1, 1).empty());
}

TEST(Fillets, TheSameWithAnyNumberOfThreads)
{
  const Mesh mesh = alongCurve(bentCurve(7, test::kPi / 2, 0.5, 3));
  Mesh one = mesh, four = mesh;
  EXPECT_EQ(markFillets(one, kAngle, 1, 1), markFillets(four, kAngle, 1, 4));
  EXPECT_EQ(one.flags, four.flags);
}

TEST(Fillets, TellsOfThoseThatAreFeatures)
{
  Mesh mesh = alongCurve(bentCurve(4, test::kPi / 2, 0.5, 3));
  const std::vector<Index> edges = markFillets(mesh, kAngle, 0.8, 1);
  EXPECT_NE(filletNotice(mesh, edges, 0.8).find("10 edge lengths"), std::string::npos)
    << filletNotice(mesh, edges, 0.8);
  for (std::uint8_t& flags : mesh.flags.editAll())
  {
    flags = 0;
  }
  EXPECT_EQ(filletNotice(mesh, edges, 0.8), "");
}

TEST(Fillets, RefusesLengthsAndAnglesThatAreNone)
{
  Mesh mesh = alongCurve(bentCurve(4, test::kPi / 2, 0.5, 3));
  EXPECT_THROW(markFillets(mesh, kAngle, 0, 1), InvalidInput);
  EXPECT_THROW(markFillets(mesh, 0, 1, 1), InvalidInput);
}

} // namespace
} // namespace quadrille
