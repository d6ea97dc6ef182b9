// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JointSheets.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace quadrille
{
namespace
{

SurfaceInput jointOf(const std::vector<SurfaceInput>& parts)
{
  std::vector<const SurfaceInput*> addresses;
  for (const SurfaceInput& part : parts)
  {
    addresses.push_back(&part);
  }
  return joinParts(parts, findContacts(addresses)).input;
}

SurfaceInput cubeAt(double x)
{
  SurfaceInput cube = test::toInput(test::unitCube(2));
  for (Vector3& p : cube.points.editAll())
  {
    p.x() += x;
  }
  return cube;
}

TEST(JointSheets, TouchingCubesAreThreeSheets)
{
  const SurfaceInput joint = jointOf({ cubeAt(0), cubeAt(1) });
  const JointSheets sheets = cutIntoSheets(joint, std::nullopt);
  ASSERT_EQ(sheets.offset.size(), 3U);
  EXPECT_EQ(sheets.edges.size(), 8U); // round a face of 2 x 2 cells
  EXPECT_EQ(sheets.polygons.size(), 2U * 48 - 8);
  EXPECT_EQ(std::count_if(sheets.polygons.begin(), sheets.polygons.end(),
              [](const std::vector<Index>& same) { return same.size() == 2; }),
    8);
  std::vector<int> faces(3, 0);
  std::set<std::int64_t> shared, single;
  for (std::size_t i = 0; i < sheets.polygons.size(); ++i)
  {
    ++faces[sheets.sheetOf[i]];
    (sheets.polygons[i].size() == 2 ? shared : single).insert(sheets.input.patchIds[i]);
  }
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(faces, (std::vector<int>{ 8, 40, 40 }));
  EXPECT_EQ(shared.size(), 1U);
  EXPECT_EQ(single.count(*shared.begin()), 0U);
  for (std::size_t p = 0; p < sheets.input.points.size(); ++p)
  {
    EXPECT_EQ(sheets.input.points[p] - sheets.offset[sheets.sheetOfPoint[p]],
      joint.points[sheets.jointPoint[p]]);
    EXPECT_EQ(sheets.movedBack(sheets.input.points[p]), joint.points[sheets.jointPoint[p]]);
  }
  // No two points of different sheets lie near each other.
  for (std::size_t p = 0; p < sheets.input.points.size(); ++p)
  {
    for (std::size_t q = 0; q < p; ++q)
    {
      if (sheets.sheetOfPoint[p] != sheets.sheetOfPoint[q])
      {
        EXPECT_GT((sheets.input.points[p] - sheets.input.points[q]).norm(), 0.25);
      }
    }
  }
}

TEST(JointSheets, SharpEdgesThatEndAtAJointAreAskedFor)
{
  const SurfaceInput joint = jointOf({ cubeAt(0), cubeAt(1) });
  EXPECT_TRUE(cutIntoSheets(joint, std::nullopt).input.featureEdges.empty());
  const JointSheets sheets = cutIntoSheets(joint, 40 * kPi / 180);
  int marked = 0;
  for (const std::uint8_t bits : sheets.input.featureEdges)
  {
    marked += (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1);
  }
  EXPECT_EQ(marked, 8); // four of each cube, each by one of its two faces
}

/// A fin stands on the middle of a sheet, and ends before its borders: both sides of the joint are one sheet.
TEST(JointSheets, ASheetThatMeetsItselfIsRefused)
{
  SurfaceInput floor = test::toInput(test::gridPlane(6, 6));
  SurfaceInput fin = test::toInput(test::gridPlane(2, 2));
  for (Vector3& p : fin.points.editAll())
  {
    p = Vector3(3, 2 + p.x(), p.y());
  }
  const SurfaceInput joint = jointOf({ floor, fin });
  try
  {
    cutIntoSheets(joint, std::nullopt);
    FAIL() << "no error";
  }
  catch (const InvalidInput& error)
  {
    EXPECT_NE(std::string(error.what()).find("a sheet meets itself"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("(3, 2.5, 0)"), std::string::npos) << error.what();
  }
}

/// Two cubes have an edge in common and no face: each goes on round it, and there is no border to cut them at.
TEST(JointSheets, SolidsThatTouchAtACurveGoOn)
{
  SurfaceInput other = cubeAt(1);
  for (Vector3& p : other.points.editAll())
  {
    p.y() += 1;
  }
  const JointSheets sheets = cutIntoSheets(jointOf({ cubeAt(0), other }), std::nullopt);
  EXPECT_EQ(sheets.offset.size(), 2U);
  EXPECT_TRUE(sheets.edges.empty());
  EXPECT_EQ(sheets.touching, 2U);
  EXPECT_EQ(sheets.touchingPlace.head<2>(), Eigen::Vector2d(1, 1));
}

/// Where there are borders to cut at, whoever asks decides.
TEST(JointSheets, TouchingSheetsAreJoinedOrLeft)
{
  SurfaceInput cube = cubeAt(0), other = cubeAt(1);
  for (Vector3& p : other.points.editAll())
  {
    p.y() += 1;
  }
  for (SurfaceInput* part : { &cube, &other }) // a patch for each side of the cube
  {
    const Mesh mesh = test::unitCube(2);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const Vector3 n = test::faceNormal(mesh, f);
      part->patchIds.push_back(std::lround(n.x() + 2 * n.y() + 3 * n.z()));
    }
  }
  const SurfaceInput joint = jointOf({ cube, other });
  const JointSheets joined = cutIntoSheets(joint, std::nullopt);
  EXPECT_EQ(joined.offset.size(), 12U);
  EXPECT_EQ(joined.touching, 0U);
  EXPECT_FALSE(joined.edges.empty());
  const JointSheets left = cutIntoSheets(joint, std::nullopt, TouchingSheets::Left);
  EXPECT_EQ(left.offset.size(), 2U);
  EXPECT_EQ(left.touching, 2U);
  EXPECT_TRUE(left.edges.empty());
}

} // namespace
} // namespace quadrille
