// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Topology.h"
#include "MeshInput.h"
#include "Repair/SurfaceWrap.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

Mesh meshOf(const TriangleList& surface)
{
  return makeMesh(surface.points, surface.corners); // throws where it is no oriented manifold
}

/// Vertices, edges and faces; 2 for each closed component of genus 0.
std::ptrdiff_t eulerNumber(const Mesh& mesh)
{
  const auto faces = static_cast<std::ptrdiff_t>(mesh.faceCount());
  return static_cast<std::ptrdiff_t>(mesh.vertexCount()) - faces / 2; // closed: 2 e = 3 f
}

bool isClosed(const Mesh& mesh)
{
  return std::find(mesh.twin.begin(), mesh.twin.end(), kInvalidIndex) == mesh.twin.end();
}

double volumeOf(const Mesh& mesh)
{
  double volume = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const auto p = [&](Index corner) { return mesh.position[mesh.origin[3 * f + corner]]; };
    volume += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return volume;
}

SurfaceInput crossingSpheres()
{
  return toInput(disjointUnion(sphere(3), sphere(3), { 1, 0, 0 }));
}

TEST(SurfaceWrap, OfCrossingSpheresIsOneSphere)
{
  const WrappedSurface wrap = wrapSurface(soupOf(crossingSpheres()), { 0.2, 0.02, {} });
  ASSERT_TRUE(wrap.status.ok()) << wrap.status.message;
  const Mesh mesh = meshOf(wrap.surface);
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_EQ(eulerNumber(mesh), 2);
  // Two unit balls at a distance of 1 fill 9/4 pi. The wrap has them inside, within alpha of their surface.
  EXPECT_GT(volumeOf(mesh), 2.2 * kPi);
  EXPECT_LT(volumeOf(mesh), 2.25 * kPi * 1.2 * 1.2 * 1.2);
}

TEST(SurfaceWrap, PointsLieAtTheOffset)
{
  const Soup soup = soupOf(toInput(sphere(3)));
  const WrappedSurface wrap = wrapSurface(soup, { 0.3, 0.05, {} });
  const NearestTriangle surface(soup.triangles);
  for (const Vector3& p : wrap.surface.points)
  {
    EXPECT_NEAR(
      surface.at(p)->distance, wrap.offset, 0.02 * wrap.offset); // CGAL promises a hundredth
  }
}

TEST(SurfaceWrap, DefaultsFollowFromTheDiagonal)
{
  const Soup soup = soupOf(toInput(unitCube(2)));
  EXPECT_DOUBLE_EQ(soup.diagonal, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(soup.area, 6);
  const WrappedSurface wrap = wrapSurface(soup, {});
  EXPECT_DOUBLE_EQ(wrap.alpha, soup.diagonal / 100);
  EXPECT_DOUBLE_EQ(wrap.offset, soup.diagonal / 600);
}

TEST(SurfaceWrap, ClosesAHoleThatTheBallDoesNotFitThrough)
{
  SurfaceInput input = toInput(unitCube(4));
  input.polygonPoints.resize(input.polygonPoints.size() - 3); // a triangle of size 1/4 is missing
  input.polygonOffsets.pop_back();
  const Mesh closed = meshOf(wrapSurface(soupOf(input), { 0.3, 0.05, {} }).surface);
  EXPECT_EQ(eulerNumber(closed), 2);
  EXPECT_GT(volumeOf(closed), 1);
  // A ball that does goes inside: only the walls are left.
  const Mesh walls = meshOf(wrapSurface(soupOf(input), { 0.04, 0.01, {} }).surface);
  EXPECT_LT(volumeOf(walls), 0.5);
}

TEST(SurfaceWrap, TakesPointsWithoutPolygons)
{
  SurfaceInput input;
  input.points = sphere(4).position;
  const WrappedSurface wrap = wrapSurface(soupOf(input), { 0.4, 0.1, {} });
  ASSERT_TRUE(wrap.status.ok()) << wrap.status.message;
  const Mesh mesh = meshOf(wrap.surface);
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_EQ(eulerNumber(mesh), 2);
  EXPECT_GT(volumeOf(mesh),
    4 * kPi / 3 * 0.9); // the inside is closed, as alpha exceeds the distances of the points
}

TEST(SurfaceWrap, TwiceTheSameBytes)
{
  const Soup soup = soupOf(crossingSpheres());
  const WrappedSurface a = wrapSurface(soup, { 0.2, 0.02, {} });
  const WrappedSurface b = wrapSurface(soup, { 0.2, 0.02, {} });
  EXPECT_EQ(a.surface.corners, b.surface.corners);
  EXPECT_EQ(a.surface.points, b.surface.points);
}

TEST(SurfaceWrap, StopsOnRequest)
{
  int reports = 0;
  const ProgressCallback stop = [&reports](double fraction, const std::string&)
  {
    EXPECT_TRUE(fraction >= 0 && fraction <= 1);
    return ++reports < 3;
  };
  EXPECT_THROW(wrapSurface(soupOf(crossingSpheres()), { 0.02, 0.002, stop }), Cancelled);
  EXPECT_EQ(reports, 3);
}

TEST(SurfaceWrap, RefusesWhatCannotBe)
{
  const Soup soup = soupOf(crossingSpheres());
  EXPECT_THROW(wrapSurface(soup, { 0, {}, {} }), InvalidInput);
  EXPECT_THROW(wrapSurface(soup, { 0.1, -1, {} }), InvalidInput);
  EXPECT_THROW(wrapSurface(soup, { 1e-5, {}, {} }), InvalidInput);
  SurfaceInput input;
  EXPECT_THROW(soupOf(input), InvalidInput);
  input.points.assign(3, Vector3::Zero());
  EXPECT_THROW(wrapSurface(soupOf(input), {}), InvalidInput);
  input.points.edit()[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(soupOf(input), InvalidInput);
}

} // namespace
