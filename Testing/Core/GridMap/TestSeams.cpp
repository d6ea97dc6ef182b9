// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Maps in which two parts of the boundary are equally long.
#include "GridMap/GridMap.h"
#include "Requests/SeamRequests.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// An L whose two ends are 1 and `width` wide.
Mesh unevenL(double width)
{
  const int n = 6;
  Mesh mesh = plateL(n);
  for (Vector3& p : mesh.position.editAll())
  {
    p /= n;
    p.y() *= width;
  }
  return mesh;
}

/// The ends of both arms.
SeamRequest endsOf(double width)
{
  return { Vector3(1, 2 * width, 0), Vector3(0, 2 * width, 0), Vector3(2, width, 0),
    Vector3(2, 0, 0) };
}

/// In units of the map, 2^-24 quads.
std::int64_t lengthOf(const std::vector<Index>& edges, const std::vector<FixedVec2>& uv)
{
  std::int64_t length = 0;
  for (const Index h : edges)
  {
    const FixedVec2 d = uv[Mesh::next(h)] - uv[h];
    length += std::abs(d.u) + std::abs(d.v);
  }
  return length;
}

GridMapResult mapWithSeams(const Mesh& mesh, const std::vector<SeamRequest>& seams)
{
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.seams = seams;
  return computeGridMap(mesh, options);
}

TEST(Seams, BothPartsAreFoundInTheOrderOfTheBoundary)
{
  const Mesh mesh = unevenL(1.5);
  const std::vector<SeamEdges> seams = findSeams(mesh, { endsOf(1.5) });
  ASSERT_EQ(seams.size(), 1U);
  ASSERT_FALSE(seams[0].empty());
  for (const Index h : seams[0].left)
  {
    EXPECT_DOUBLE_EQ(mesh.position[mesh.origin[h]].y(), 3);
    EXPECT_LT(mesh.edgeVector(h).x(), 0);
  }
  for (const Index h : seams[0].right)
  {
    EXPECT_DOUBLE_EQ(mesh.position[mesh.origin[h]].x(), 2);
    EXPECT_GT(mesh.edgeVector(h).y(), 0);
  }
  EXPECT_EQ(seamVertices(mesh, { endsOf(1.5) }).size(), 4U);
  // With an end of another one between there is no such part.
  const SeamRequest other{ Vector3(0.5, 3, 0), Vector3(0, 3, 0), Vector3(2, 0.5, 0),
    Vector3(2, 0, 0) };
  EXPECT_TRUE(findSeams(mesh, { endsOf(1.5), other })[0].empty());
}

TEST(Seams, AreEquallyLongInWholeNumbers)
{
  for (const double width : { 1.0, 1.5, 2.0, 3.0 })
  {
    SCOPED_TRACE(width);
    const Mesh mesh = unevenL(width);
    const SeamEdges seam = findSeams(mesh, { endsOf(width) }).front();
    const GridMapResult map = mapWithSeams(mesh, { endsOf(width) });
    ASSERT_TRUE(map.status.ok()) << map.status.message;
    EXPECT_TRUE(map.certificate.valid()) << map.certificate.text();
    EXPECT_EQ(lengthOf(seam.left, map.seamlessUv), lengthOf(seam.right, map.seamlessUv));
    EXPECT_EQ(lengthOf(seam.left, map.uv), lengthOf(seam.right, map.uv));
    EXPECT_EQ(lengthOf(seam.left, map.uv) % kOne, 0);
    EXPECT_GT(lengthOf(seam.left, map.uv), 0);
  }
  // Without the seam they are not: the wide end has three times the edges.
  const Mesh mesh = unevenL(3);
  const SeamEdges seam = findSeams(mesh, { endsOf(3) }).front();
  const GridMapResult plain = mapWithSeams(mesh, {});
  ASSERT_TRUE(plain.status.ok()) << plain.status.message;
  EXPECT_NE(lengthOf(seam.left, plain.uv), lengthOf(seam.right, plain.uv));
}

TEST(Seams, ByMethodsThatRound)
{
  const Mesh mesh = unevenL(2);
  const SeamEdges seam = findSeams(mesh, { endsOf(2) }).front();
  for (const MapMethod method : { MapMethod::MixedInteger, MapMethod::QuadCover })
  {
    GridMapOptions options;
    options.method = method;
    options.edgeLength = 0.25;
    options.seams = { endsOf(2) };
    const GridMapResult map = computeGridMap(mesh, options);
    ASSERT_TRUE(map.status.ok()) << map.status.message;
    EXPECT_EQ(lengthOf(seam.left, map.uv), lengthOf(seam.right, map.uv));
  }
}

TEST(Seams, MissingOnesAreTold)
{
  const GridMapResult map = mapWithSeams(sphere(2), { endsOf(1) });
  EXPECT_EQ(map.status.code, StatusCode::Infeasible);
  EXPECT_NE(map.status.message.find("cut"), std::string::npos);
}

} // namespace
} // namespace quadrille
