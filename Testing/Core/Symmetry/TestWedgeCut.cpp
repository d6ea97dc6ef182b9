// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/SymmetrySearch.h"
#include "Symmetry/WedgeCut.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

const RotationAxis kUpwards{ Vector3::Zero(), Vector3::UnitZ() };

double areaOf(const std::vector<Vector3>& points, const std::vector<Index>& corners)
{
  double area = 0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
  {
    area += (points[corners[i + 1]] - points[corners[i]])
              .cross(points[corners[i + 2]] - points[corners[i]])
              .norm() /
      2;
  }
  return area;
}

/// A wedge has its share of the area, its corners are where their weights say, and seams end at each other's images.
void expectWedge(const SurfacePart& wedge, const Mesh& mesh, int order)
{
  EXPECT_EQ(wedge.mismatch, "");
  EXPECT_EQ(wedge.loneFeatures, 0U);
  const SurfaceInput& input = wedge.input;
  ASSERT_EQ(wedge.face.size() * 3, input.polygonPoints.size());
  ASSERT_EQ(wedge.weights.size(), wedge.face.size());
  EXPECT_NEAR(
    order * areaOf(input.points, input.polygonPoints), areaOf(mesh.position, mesh.origin), 1e-9);
  for (std::size_t i = 0; i < input.polygonPoints.size(); ++i)
  {
    Vector3 place = Vector3::Zero();
    for (Index k = 0; k < 3; ++k)
    {
      place +=
        wedge.weights[i / 3][i % 3][k] * mesh.position[mesh.origin[3 * wedge.face[i / 3] + k]];
    }
    const Vector3& p = input.points[input.polygonPoints[i]];
    EXPECT_LE((place - p).norm(), 1e-9);
    EXPECT_GE(wedge.planes[0].height(p), -1e-9);
    EXPECT_GE(order == 2 ? 0 : wedge.planes[1].height(p), -1e-9);
  }
  const Isometry rotation = Isometry::of(kUpwards, order);
  for (const SeamRequest& seam : input.seams)
  {
    EXPECT_LE((rotation.image(seam.from) - seam.imageFrom).norm(), 1e-9);
    EXPECT_LE((rotation.image(seam.to) - seam.imageTo).norm(), 1e-9);
  }
}

SurfacePart wedgeOf(const Mesh& mesh, int order)
{
  return cutWedge(mesh, Isometry::of(kUpwards, order), 1e-9, { 1e-3, 1e-3 });
}

TEST(RotationCut, TorusIsCutIntoTubes)
{
  const Mesh mesh = torus(60, 20);
  for (const int order : { 2, 3, 4, 10, 60 })
  {
    SCOPED_TRACE(order);
    const SurfacePart wedge = wedgeOf(mesh, order);
    expectWedge(wedge, mesh, order);
    ASSERT_EQ(wedge.input.seams.size(), 1U);
    EXPECT_EQ(wedge.input.seams[0].from, wedge.input.seams[0].to);
    EXPECT_TRUE(wedge.poles.empty());
  }
}

TEST(RotationCut, CubeIsCutBetweenItsPoles)
{
  Mesh mesh = unitCube(4);
  for (Vector3& p : mesh.position.editAll())
  {
    p -= Vector3(0.5, 0.5, 0.5);
  }
  mesh = markFeatures(std::move(mesh), 0.6);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    mesh.flags.edit()[h] |= mesh.isFeature(h) ? kRequestedFeature : 0;
  }
  for (const int order : { 2, 4 })
  {
    SCOPED_TRACE(order);
    const SurfacePart wedge = wedgeOf(mesh, order);
    expectWedge(wedge, mesh, order);
    ASSERT_EQ(wedge.poles.size(), 2U);
    for (const Vector3& pole : wedge.poles)
    {
      EXPECT_LE((pole - Vector3(0, 0, pole.z() > 0 ? 0.5 : -0.5)).norm(), 1e-12);
    }
    // The cut crosses the edges of the top and of the bottom.
    EXPECT_EQ(wedge.input.seams.size(), 3U);
  }
}

TEST(RotationCut, TellsWhatDoesNotFit)
{
  Mesh mesh = torus(60, 20);
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() += p.x() > 0 ? 0.2 * p.x() : 0;
  }
  EXPECT_NE(wedgeOf(mesh, 3).mismatch, "");
}

TEST(RotationSearch, AxisOfATurnedSurface)
{
  const Vector3 direction = Vector3(1, -2, 0.7).normalized();
  const Vector3 place(3, 1, -2);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), direction);
  Mesh mesh = parametricGrid(70, 30, true,
    [](double u, double v)
    {
      const double bump = 1 + 0.3 * std::cos(7 * 2 * kPi * u);
      const double r = 1 + 0.3 * bump * std::cos(2 * kPi * v);
      return Vector3(
        r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), 0.3 * bump * std::sin(2 * kPi * v));
    });
  TriangleList list;
  for (const Vector3& p : mesh.position)
  {
    list.points.push_back(turn * p + place);
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    list.corners.push_back({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
  }
  const NearestTriangle surface(list);
  const Isometry found = findIsometry(surface, Isometry::of(kUpwards, 7), 2);
  // As accurate as the coordinates.
  EXPECT_LE(found.direction.cross(direction).norm(), 1e-12);
  EXPECT_LE(found.axis().radial(place).norm(), 1e-11);
  EXPECT_LE(imageDeviation(surface, found, 2).maximum, 1e-11);
  // Round the same axis it is of no order that does not divide 7 and 70.
  EXPECT_GT(imageDeviation(surface, Isometry::of(found.axis(), 4), 2).rms, 0.01);
}

} // namespace
} // namespace quadrille
