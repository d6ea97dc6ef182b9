// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MidLine.h"

#include "MeshInput.h"
#include "SymmetricQuads.h"
#include "Symmetry/PartRequests.h"

#include <gtest/gtest.h>

#include <map>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

SymmetryOptions midLineAbout(const Vector3& origin, const Vector3& normal)
{
  SymmetryOptions symmetry = about(origin, normal);
  symmetry.planeCurve = PlaneCurve::MidLine;
  return symmetry;
}

/// The quads that are their own image, each with two corners in front and two behind that are images of each other.
std::vector<Quad> quadsAcross(const SymmetricResult& made)
{
  std::vector<Quad> across;
  for (const Quad& quad : made.remeshed.quads.quads)
  {
    const auto image = [&](std::size_t i) { return made.mirrorPoint[quad[i % 4]]; };
    for (std::size_t i = 0; i < 4; ++i)
    {
      if (image(i) == quad[(i + 3) % 4] && image(i + 1) == quad[(i + 2) % 4])
      {
        const Quad from{ quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4], quad[(i + 3) % 4] };
        if (made.plane.height(made.remeshed.quads.points[from[0]]) > 0)
        {
          across.push_back(from);
        }
      }
    }
  }
  return across;
}

/// No point in the plane, no edge across it but between a point and its image, and the quads across it are strips from
/// boundary to boundary, or closed.
void expectPlaneInQuads(
  const SymmetricResult& made, std::size_t closedStrips, std::size_t openStrips)
{
  const QuadMesh& quads = made.remeshed.quads;
  const auto isFront = [&](Index p) { return made.plane.height(quads.points[p]) > 0; };
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    EXPECT_NE(made.mirrorPoint[p], p);
    EXPECT_NE(isFront(p), isFront(made.mirrorPoint[p]));
  }
  const std::vector<Quad> across = quadsAcross(made);
  std::size_t onBothSides = 0;
  for (const Quad& quad : quads.quads)
  {
    const auto front = std::count_if(quad.begin(), quad.end(), isFront);
    onBothSides += front != 0 && front != 4 ? 1 : 0;
  }
  EXPECT_EQ(onBothSides, across.size());
  // Each edge across the plane is that of two quads, or lies on the boundary.
  std::map<Index, std::vector<std::size_t>> quadsAt;
  for (std::size_t q = 0; q < across.size(); ++q)
  {
    quadsAt[across[q][0]].push_back(q);
    quadsAt[across[q][1]].push_back(q);
  }
  std::size_t ends = 0;
  for (const auto& [p, at] : quadsAt)
  {
    EXPECT_EQ(at.size(), quads.onBoundary[p] != 0 ? 1U : 2U);
    ends += quads.onBoundary[p];
  }
  EXPECT_EQ(ends, 2 * openStrips);
  std::vector<std::uint8_t> seen(across.size(), 0);
  std::size_t strips = 0;
  for (std::size_t first = 0; first < across.size(); ++first)
  {
    strips += seen[first] == 0 ? 1 : 0;
    std::vector<std::size_t> open{ first };
    while (!open.empty())
    {
      const std::size_t q = open.back();
      open.pop_back();
      if (seen[q] != 0)
      {
        continue;
      }
      seen[q] = 1;
      for (const Index p : { across[q][0], across[q][1] })
      {
        open.insert(open.end(), quadsAt[p].begin(), quadsAt[p].end());
      }
    }
  }
  EXPECT_EQ(strips, closedStrips + openStrips);
}

/// The quads are those of the mapped surface's map: it has a unit for each, and the plane's curve at half numbers.
void expectMapOfTheQuads(const SymmetricResult& made)
{
  const RemeshResult& result = made.remeshed;
  EXPECT_NEAR(result.certificate.area, static_cast<double>(result.quads.quads.size()), 1e-6);
  const Mesh& mesh = result.surface.mesh;
  const double tolerance = kRoundingOfSingle * made.diagonal;
  std::size_t inPlane = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const auto isInPlane = [&](Index v)
    { return std::abs(made.plane.height(mesh.position[v])) <= tolerance; };
    if (!mesh.isBoundary(h) && isInPlane(mesh.origin[h]) && isInPlane(mesh.target(h)) &&
      made.plane.height(mesh.position[mesh.target(Mesh::next(h))]) > tolerance)
    {
      const FixedVec2 a = result.uv[h], b = result.uv[Mesh::next(h)];
      ASSERT_TRUE((a.u == b.u) != (a.v == b.v));
      const std::int64_t across = a.u == b.u ? a.u : a.v;
      EXPECT_EQ(across & (kOne - 1), kOne / 2);
      ++inPlane;
    }
  }
  EXPECT_GT(inPlane, 0U);
}

/// The median width of the quads across the plane over the mean edge length of all quads.
double widthAcross(const SymmetricResult& made)
{
  const std::vector<Vector3>& points = made.remeshed.quads.points;
  std::vector<double> widths;
  for (const Quad& quad : quadsAcross(made))
  {
    widths.push_back((points[quad[0]] - points[quad[3]]).norm());
  }
  double sum = 0, count = 0;
  for (const Quad& quad : made.remeshed.quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      sum += (points[quad[i]] - points[quad[(i + 1) % 4]]).norm();
      count += 1;
    }
  }
  std::nth_element(
    widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
  return widths[widths.size() / 2] * count / sum;
}

void expectMidLine(const SymmetricResult& made, const SurfaceInput& input, long long euler,
  std::size_t closedStrips, std::size_t openStrips)
{
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneInQuads(made, closedStrips, openStrips);
  expectExactImages(made);
  expectSources(made, input);
  expectWhole(made, euler,
    made.remeshed.quads.onBoundary.empty() ||
      std::count(made.remeshed.quads.onBoundary.begin(), made.remeshed.quads.onBoundary.end(), 1) ==
        0);
  expectMapOfTheQuads(made);
  // As wide as others are long; a quarter more or less is what quads differ by anyway.
  EXPECT_GT(widthAcross(made), 0.8);
  EXPECT_LT(widthAcross(made), 1.25);
}

TEST(MidLine, ClosedSurfaces)
{
  const SurfaceInput ball = toInput(sphere(4));
  const SymmetricResult made =
    remeshSymmetric(ball, aboutQuads(600), midLineAbout({ 0, 0, 0 }, { 0, 0, 3 }));
  expectMidLine(made, ball, 2, 1, 0);
  // The number asked for is that of the whole.
  EXPECT_NEAR(static_cast<double>(made.remeshed.quads.quads.size()), 600, 150);
  const SurfaceInput lopsided = toInput(lopsidedEllipsoid(4));
  expectMidLine(remeshSymmetric(lopsided, aboutQuads(600), midLineAbout({ 0, 0, 0 }, { 1, 0, 0 })),
    lopsided, 2, 1, 0);
}

TEST(MidLine, SeveralCurvesInThePlane)
{
  const SurfaceInput input = toInput(torus(60, 30));
  for (const Vector3& normal : { Vector3(0, 0, 1), Vector3(1, 0, 0) })
  {
    SCOPED_TRACE(normal.transpose());
    const SymmetricResult made =
      remeshSymmetric(input, aboutQuads(800), midLineAbout(Vector3::Zero(), normal));
    expectMidLine(made, input, 0, 2, 0);
    EXPECT_EQ(made.remeshed.smallParts.handles, 1U);
  }
}

TEST(MidLine, OpenSurfaces)
{
  // The boundary crosses the plane at four places, and round a hole at two more.
  const SurfaceInput cylinder = toInput(openCylinder(48, 20));
  expectMidLine(remeshSymmetric(cylinder, aboutQuads(500), midLineAbout({ 0, 0, 0 }, { 1, 0, 0 })),
    cylinder, 0, 0, 2);
  const SurfaceInput plate = toInput(plateWithHole(4));
  expectMidLine(remeshSymmetric(plate, aboutQuads(300), midLineAbout({ 6, 6, 0 }, { 0, 1, 0 })),
    plate, 0, 0, 2);
}

TEST(MidLine, FeaturesThatCrossThePlaneLieOnEdges)
{
  const SurfaceInput input = toInput(unitCube(6));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(300), midLineAbout(Vector3::Constant(0.5), { 0, 1, 0 }));
  expectMidLine(made, input, 2, 1, 0);
  const QuadMesh& quads = made.remeshed.quads;
  double length = 0;
  std::size_t crossing = 0;
  for (const QuadLine& line : quads.lines)
  {
    EXPECT_FALSE(line.boundary);
    length += (quads.points[line.a] - quads.points[line.b]).norm();
    crossing += made.mirrorPoint[line.a] == line.b ? 1 : 0;
  }
  EXPECT_NEAR(length, 12, 1e-9); // the edges of the box
  EXPECT_EQ(crossing, 4U);
}

TEST(MidLine, FeaturesThatMeetInThePlaneAreRefused)
{
  // Two of the four edges of a pyramid are in front, and end in its tip.
  const Mesh pyramid =
    makeMesh({ { 1, 1, 0 }, { -1, 1, 0 }, { -1, -1, 0 }, { 1, -1, 0 }, { 0, 0, 1.5 } },
      { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } });
  try
  {
    remeshSymmetric(toInput(pyramid), aboutQuads(300), midLineAbout({ 0, 0, 0 }, { 1, 0, 0 }));
    FAIL() << "features meet in the plane";
  }
  catch (const InvalidInput& error)
  {
    const std::string message = error.what();
    EXPECT_NE(
      message.find("several features meet in the mirror plane, at (0, 0, 1.5)"), std::string::npos)
      << message;
    EXPECT_NE(message.find("isoline"), std::string::npos);
  }
}

TEST(MidLine, FeaturesInThePlaneAreGivenUpAndTold)
{
  // Two of the box's edges lie in the plane through opposite edges.
  const SurfaceInput box = toInput(unitCube(6));
  const SymmetricResult blunt =
    remeshSymmetric(box, aboutQuads(300), midLineAbout(Vector3::Constant(0.5), { 1, -1, 0 }));
  ASSERT_TRUE(blunt.remeshed.status.ok()) << blunt.remeshed.status.message;
  expectSymmetricConnectivity(blunt);
  expectPlaneInQuads(blunt, 1, 0);
  expectWhole(blunt, 2, true);
  EXPECT_TRUE(hasNotice(blunt, "features of the length 2 lie in the mirror plane"));
  // A roof over a strip: its ridge is in the plane.
  Mesh roof = gridPlane(12, 12);
  for (Vector3& p : roof.position.editAll())
  {
    p.z() = -1.2 * std::abs(p.x() - 6);
  }
  const SurfaceInput input = toInput(roof);
  const SymmetryOptions ridge = midLineAbout({ 6, 0, 0 }, { 1, 0, 0 });
  const SymmetricResult made = remeshSymmetric(input, aboutQuads(150), ridge);
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectPlaneInQuads(made, 0, 1);
  EXPECT_TRUE(hasNotice(made, "features of the length 12"));
  const auto& lost = made.remeshed.givenUpFeatures;
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost.front().reason, FeatureLoss::MidLine);
  EXPECT_NEAR(lost.front().length, 12, 1e-9);
}

TEST(MidLine, WhatIsAskedOfThePlaneIsNotMet)
{
  SurfaceInput input = toInput(lopsidedEllipsoid(4));
  input.targetValences.assign(input.points.size(), 0);
  const Index inPlane = nearestPoint(input.points, Vector3(0, -1.6, 0));
  const Index behind = nearestPoint(input.points, Vector3(-0.7, 0.6, 0.6));
  input.targetValences[inPlane] = 6;
  input.targetValences[behind] = 5;
  CurveRequest cycle;
  cycle.kind = CurveKind::Cycle;
  for (int i = 0; i < 40; ++i)
  {
    const double angle = 2 * kPi * i / 40;
    cycle.points.emplace_back(
      0, 1.6 * std::cos(angle) + 0.2 * std::sin(angle), 1.2 * std::sin(angle));
  }
  input.curves.push_back(cycle);
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(800), midLineAbout({ 0, 0, 0 }, { 1, 0, 0 }));
  expectMidLine(made, input, 2, 1, 0);
  EXPECT_TRUE(hasNotice(made, "point " + std::to_string(inPlane)));
  EXPECT_TRUE(hasNotice(made, "which quads straddle"));
  const QuadMesh& quads = made.remeshed.quads;
  for (const Vector3& place : { input.points[behind], made.plane.image(input.points[behind]) })
  {
    const Index p = nearestPoint(quads.points, place);
    EXPECT_LE((quads.points[p] - place).norm(), 1e-12 * made.diagonal);
    EXPECT_EQ(quads.valence[p], 5);
  }
  ASSERT_EQ(made.remeshed.curves.size(), 1U);
  EXPECT_FALSE(made.remeshed.curves.front().met);
  EXPECT_NE(made.remeshed.curves.front().why.find("which quads straddle"), std::string::npos);
}

TEST(MidLine, ComponentsBesideThePlane)
{
  const SurfaceInput input =
    toInput(disjointUnion(lopsidedEllipsoid(3), lopsidedEllipsoid(3), Vector3(4, 0, 0)));
  const SymmetricResult made =
    remeshSymmetric(input, aboutQuads(600), midLineAbout({ 2, 0, 0 }, { 1, 0, 0 }));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneInQuads(made, 0, 0);
  expectExactImages(made);
  expectSources(made, input);
  expectWhole(made, 4, true);
}

TEST(MidLine, NarrowHalvesGetMoreQuads)
{
  // A tube that the plane cuts along: at this size each half is one quad wide.
  const SurfaceInput input = toInput(openCylinder(24, 40, 0.3, 6));
  RemeshOptions options = aboutQuads(40);
  const SymmetricResult made =
    remeshSymmetric(input, options, midLineAbout({ 0, 0, 0 }, { 1, 0, 0 }));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneInQuads(made, 0, 2);
  expectWhole(made, 0, false);
}

TEST(MidLine, NearlySymmetricSurfaceIsFollowed)
{
  const SurfaceInput input = toInput(withNoise(lopsidedEllipsoid(4), 0.005));
  RemeshOptions options = aboutQuads(600);
  options.featureAngle.reset();
  SymmetryOptions found;
  found.planeCurve = PlaneCurve::MidLine;
  const SymmetricResult made = remeshSymmetric(input, options, found);
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  expectSymmetricConnectivity(made);
  expectPlaneInQuads(made, 1, 0);
  // Vertices nearer to the plane than this were put into it.
  expectSources(made, input, kRoundingOfSingle);
  EXPECT_GT(made.movedPoints, 0U);
  const QuadQuality quality = evaluateQuads(made.remeshed.quads.points, made.remeshed.quads.quads);
  EXPECT_TRUE(quality.manifold && quality.closed);
  EXPECT_EQ(quality.nonPositiveJacobians, 0U);
}

TEST(MidLine, SameForAnyThreadsAndWithAStore)
{
  const SurfaceInput input = toInput(withNoise(lopsidedEllipsoid(3), 0.01));
  RemeshOptions options = aboutQuads(300);
  options.featureAngle.reset();
  options.mergeCharts = true;
  SymmetryOptions found;
  ResultStore store;
  const SymmetricResult plain = remeshSymmetric(input, options, found, &store);
  found.planeCurve = PlaneCurve::MidLine;
  const SymmetricResult first = remeshSymmetric(input, options, found);
  ASSERT_TRUE(first.remeshed.status.ok()) << first.remeshed.status.message;
  remeshSymmetric(input, options, found, &store);
  options.threads = 1;
  const SymmetricResult again = remeshSymmetric(input, options, found, &store);
  EXPECT_EQ(again.remeshed.quads.quads, first.remeshed.quads.quads);
  EXPECT_EQ(again.remeshed.quads.points, first.remeshed.quads.points);
  EXPECT_EQ(again.mirrorPoint, first.mirrorPoint);
  EXPECT_TRUE(again.remeshed.uv == first.remeshed.uv);
  EXPECT_NE(again.remeshed.mapKey, plain.remeshed.mapKey);
  // What the other choice has left in the store is its own.
  found.planeCurve = PlaneCurve::Isoline;
  const SymmetricResult other = remeshSymmetric(input, options, found, &store);
  EXPECT_EQ(other.remeshed.quads.points, plain.remeshed.quads.points);
  EXPECT_TRUE(other.remeshed.uv == plain.remeshed.uv);
}

TEST(MidLine, RefusesWhatHasNoPlane)
{
  const SurfaceInput input = toInput(sphere(2));
  SymmetryOptions symmetry = midLineAbout({ 0, 0, 0 }, { 1, 0, 0 });
  RemeshOptions options = aboutQuads(100);
  options.method = MapMethod::Seamless;
  EXPECT_THROW(remeshSymmetric(input, options, symmetry), InvalidInput);
  symmetry.rotation = RotationRequest{ 4, std::nullopt };
  EXPECT_THROW(remeshSymmetric(input, aboutQuads(100), symmetry), InvalidInput);
}

} // namespace
} // namespace quadrille
