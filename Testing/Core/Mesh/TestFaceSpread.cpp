// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceSpread.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

TEST(FaceSpread, EachFaceIsOfTheNearestStartThatReachesIt)
{
  const Mesh mesh = gridPlane(30, 10);
  std::vector<SpreadStart> starts;
  for (const double x : { 5.2, 21.2 })
  {
    const auto isThere = [&](Index f)
    { return (mesh.middleOfFace(f) - Vector3(x, 5.2, 0)).norm() < 0.5; };
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      if (isThere(f))
      {
        starts.push_back({ f, mesh.middleOfFace(f), starts.empty() ? 4.0 : 9.0 });
        break;
      }
    }
  }
  ASSERT_EQ(starts.size(), 2U);
  // The second one may not cross the line at x = 18.
  const auto mayCross = [&](Index h)
  {
    const double a = mesh.middleOfFace(Mesh::face(h)).x();
    const double b = mesh.middleOfFace(Mesh::face(mesh.twin[h])).x();
    return (a < 18) == (b < 18);
  };
  const std::vector<Index> reached = spreadOverFaces(mesh, starts, mayCross);
  ASSERT_EQ(reached.size(), mesh.faceCount());
  constexpr double kAFace = 0.8; // a face at the edge may have no neighbour within the reach
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 p = mesh.middleOfFace(f);
    const double first = (p - starts[0].from).norm(), second = (p - starts[1].from).norm();
    if (reached[f] != kInvalidIndex)
    {
      EXPECT_LE(reached[f] == 0 ? first : second, starts[reached[f]].reach) << p.transpose();
      EXPECT_EQ(reached[f] == 1, p.x() > 18) << p.transpose();
    }
    else
    {
      EXPECT_GT(first, 4 - kAFace) << p.transpose();
      EXPECT_TRUE(second > 9 - kAFace || p.x() < 18) << p.transpose();
    }
  }
}

TEST(FaceSpread, WithoutStartsNothingIsReached)
{
  const Mesh mesh = gridPlane(3, 3);
  const std::vector<Index> reached = spreadOverFaces(mesh, {}, [](Index) { return true; });
  EXPECT_EQ(
    std::count(reached.begin(), reached.end(), kInvalidIndex), static_cast<int>(mesh.faceCount()));
}

} // namespace
} // namespace quadrille
