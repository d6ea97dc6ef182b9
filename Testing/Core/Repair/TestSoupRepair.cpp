// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshInput.h"
#include "Repair/SoupRepair.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

SurfaceInput withoutFaces(SurfaceInput input, std::size_t faces)
{
  input.polygonPoints.resize(input.polygonPoints.size() - 3 * faces);
  input.polygonOffsets.resize(input.polygonOffsets.size() - faces);
  return input;
}

/// Each triangle with three points of its own.
SurfaceInput exploded(const SurfaceInput& input)
{
  SurfaceInput result;
  result.polygonOffsets = input.polygonOffsets;
  for (const Index p : input.polygonPoints)
  {
    result.polygonPoints.push_back(static_cast<Index>(result.points.size()));
    result.points.push_back(input.points[p]);
  }
  return result;
}

Mesh repairedMesh(const RepairedSoup& soup)
{
  return makeMesh(
    soup.surface.points, soup.surface.corners); // throws where it is no oriented manifold
}

double enclosedVolume(const Mesh& mesh)
{
  double volume = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const auto p = [&](Index corner) { return mesh.position[mesh.origin[3 * f + corner]]; };
    volume += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return volume;
}

TEST(SoupRepair, LeavesACleanSurfaceAsItIs)
{
  const Mesh cube = unitCube(3);
  const RepairedSoup repaired = repairSoup(soupOf(toInput(cube)), { 10, true, {} });
  EXPECT_EQ(repaired.surface.points.size(), cube.vertexCount());
  EXPECT_EQ(repaired.surface.corners.size(), cube.faceCount());
  EXPECT_TRUE(repaired.report.sentences().empty());
  EXPECT_EQ(repaired.report.components, 1u);
  EXPECT_FALSE(repaired.report.isHopeless(repaired.surface.corners.size()));
}

TEST(SoupRepair, MergesAndOrientsASoup)
{
  const Mesh cube = unitCube(3);
  SurfaceInput input = exploded(toInput(cube));
  for (std::size_t t = 0; t < input.polygonPoints.size() / 3; t += 3)
  {
    std::swap(input.polygonPoints.edit()[3 * t], input.polygonPoints.edit()[3 * t + 1]);
  }
  const RepairedSoup repaired = repairSoup(soupOf(input), {});
  EXPECT_EQ(repaired.surface.points.size(), cube.vertexCount());
  EXPECT_EQ(repaired.report.mergedPoints, input.points.size() - cube.vertexCount());
  // Either a third was turned round, or all others.
  const std::size_t turned = cube.faceCount() / 3;
  EXPECT_TRUE(repaired.report.reorientedFaces == turned ||
    repaired.report.reorientedFaces == cube.faceCount() - turned)
    << repaired.report.reorientedFaces;
  EXPECT_NEAR(std::abs(enclosedVolume(repairedMesh(repaired))), 1, 1e-12);
}

TEST(SoupRepair, FillsAHoleThatIsShortEnough)
{
  const SurfaceInput input = withoutFaces(toInput(unitCube(4)), 1);
  const double boundary = 0.5 + std::sqrt(0.125); // two sides of a square of 1/4 and its diagonal
  const RepairedSoup open = repairSoup(soupOf(input), { 0.99 * boundary, true, {} });
  EXPECT_EQ(open.report.filledHoles, 0u);
  ASSERT_EQ(open.report.openBoundaries, 1u);
  EXPECT_EQ(open.report.boundaries[0].faces, 3u);
  EXPECT_NEAR(open.report.boundaries[0].length, boundary, 1e-12);
  const RepairedSoup closed = repairSoup(soupOf(input), { 1.01 * boundary, true, {} });
  EXPECT_EQ(closed.report.filledHoles, 1u);
  EXPECT_EQ(closed.report.openBoundaries, 0u);
  const Mesh mesh = repairedMesh(closed);
  EXPECT_EQ(std::count(mesh.twin.begin(), mesh.twin.end(), kInvalidIndex), 0);
  EXPECT_NEAR(enclosedVolume(mesh), 1, 1e-9); // a flat hole in a flat side gets a flat filling
  const auto filling =
    std::accumulate(closed.isFilling.begin(), closed.isFilling.end(), std::size_t{ 0 });
  EXPECT_EQ(filling, mesh.faceCount() - open.surface.corners.size());
}

TEST(SoupRepair, FindsSelfIntersections)
{
  // So that no two points lie at one place.
  const SurfaceInput input = toInput(disjointUnion(sphere(3), sphere(3), { 1, 0.01, 0.02 }));
  const RepairedSoup repaired = repairSoup(soupOf(input), {});
  const SoupReport& report = repaired.report;
  EXPECT_EQ(report.components, 2u);
  EXPECT_GT(report.intersectingPairs, 0u);
  EXPECT_EQ(report.intersectionPlaces, 1u); // the spheres meet in one circle
  ASSERT_EQ(report.intersections.size(), 1u);
  EXPECT_EQ(report.intersections[0].faces, report.intersectingFaces);
  // The circle lies nearly in the plane x = 1/2; faces have edges of about 0.15.
  for (std::size_t t = 0; t < repaired.surface.corners.size(); ++t)
  {
    if (repaired.isIntersecting[t])
    {
      for (const Index corner : repaired.surface.corners[t])
      {
        EXPECT_NEAR(repaired.surface.points[corner].x(), 0.5, 0.3);
      }
    }
  }
  EXPECT_EQ(report.sentences().size(), 1u);
  EXPECT_TRUE(repairSoup(soupOf(input), { 0, false, {} }).isIntersecting.empty());
}

TEST(SoupRepair, PartsWhatIsNotManifold)
{
  // Three triangles at one edge.
  SurfaceInput input;
  input.points = { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, -1, 0 } };
  input.polygonPoints = { 0, 1, 2, 0, 1, 3, 0, 1, 4 };
  input.polygonOffsets = { 0, 3, 6, 9 };
  const RepairedSoup repaired = repairSoup(soupOf(input), {});
  EXPECT_EQ(repaired.report.nonManifoldEdges, 1u);
  EXPECT_GT(repaired.report.copiedPoints, 0u);
  EXPECT_EQ(repairedMesh(repaired).faceCount(), 3u);
  EXPECT_EQ(repaired.report.intersectingPairs, 0u); // they touch where they were parted
}

TEST(SoupRepair, RemovesDegenerateAndDoubleFaces)
{
  SurfaceInput input = toInput(unitCube(1));
  const std::size_t faces = input.polygonPoints.size() / 3;
  const std::vector<Index> more = { 0, 0, 1, input.polygonPoints[1], input.polygonPoints[0],
    input.polygonPoints[2] };
  input.polygonPoints.append(more.begin(), more.end());
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  input.polygonOffsets.push_back(input.polygonOffsets.back() + 3);
  input.points.emplace_back(5, 5, 5);
  const RepairedSoup repaired = repairSoup(soupOf(input), {});
  EXPECT_EQ(repaired.surface.corners.size(), faces);
  EXPECT_EQ(repaired.report.degenerateFaces, 1u);
  EXPECT_EQ(repaired.report.duplicateFaces, 1u);
  EXPECT_EQ(repaired.report.isolatedPoints, 1u);
}

TEST(SoupRepair, FacesThatStandAloneAreHopeless)
{
  SurfaceInput input;
  for (int i = 0; i < 8; ++i)
  {
    const double x = 2 * i;
    input.points.append({ { x, 0, 0 }, { x + 1, 0, 0 }, { x, 1, 0 } });
  }
  input.polygonPoints.resize(24);
  std::iota(input.polygonPoints.edit(), input.polygonPoints.edit() + 24, 0);
  input.polygonOffsets = { 0, 3, 6, 9, 12, 15, 18, 21, 24 };
  const SoupReport eight = repairSoup(soupOf(input), {}).report;
  EXPECT_EQ(eight.components, 8u);
  EXPECT_TRUE(eight.isHopeless(8));
  EXPECT_FALSE(repairSoup(soupOf(withoutFaces(input, 1)), {}).report.isHopeless(7));
  // All through each other, too: no surface.
  for (std::size_t i = 0; i < input.points.size(); ++i)
  {
    const double angle = kPi / 8 * static_cast<double>(i / 3);
    const double side = i % 3 == 0 ? -1 : 1;
    input.points.edit()[i] = i % 3 == 2
      ? Vector3(0, 0, 1 + static_cast<double>(i))
      : Vector3(side * std::cos(angle), side * std::sin(angle), -0.1 * static_cast<double>(i));
  }
  const SoupReport star = repairSoup(soupOf(input), {}).report;
  EXPECT_EQ(star.components, 8u);
  EXPECT_EQ(star.intersectingFaces, 8u); // all of them meet on the z axis
  EXPECT_FALSE(star.isHopeless(8));
  // Two planes through each other: each of the four faces crosses two others.
  SurfaceInput crossing;
  crossing.points = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 }, { -1, 0, -1 },
    { 1, 0, -1 }, { 1, 0, 1 }, { -1, 0, 1 } };
  crossing.polygonPoints = { 0, 1, 2, 3, 4, 5, 6, 7 };
  crossing.polygonOffsets = { 0, 4, 8 };
  const SoupReport planes = repairSoup(soupOf(crossing), {}).report;
  EXPECT_EQ(planes.intersectingFaces, 4u);
  EXPECT_TRUE(planes.isHopeless(4));
}

TEST(SoupRepair, RefusesWhatCannotBe)
{
  SurfaceInput input;
  EXPECT_THROW(repairSoup(soupOf(input), {}), InvalidInput);
  input.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  EXPECT_THROW(repairSoup(soupOf(input), {}), InvalidInput); // no face
  input.polygonPoints = { 0, 1, 2 };
  input.polygonOffsets = { 0, 3 };
  EXPECT_THROW(repairSoup(soupOf(input), { -1, true, {} }), InvalidInput);
  EXPECT_EQ(repairSoup(soupOf(input), {}).surface.corners.size(), 1u);
  const ProgressCallback stop = [](double, const std::string&) { return false; };
  EXPECT_THROW(repairSoup(soupOf(input), { 0, true, stop }), Cancelled);
}

} // namespace
