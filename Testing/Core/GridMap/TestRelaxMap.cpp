// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "../TestMeshes.h"

#include "Base/Angles.h"
#include "GridMap/GridMap.h"
#include "GridMap/MapCheck.h"
#include "GridMap/RelaxMap.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

using namespace quadrille;

namespace
{

/// A plane of unit cells, mapped to itself, except that inner vertices lie elsewhere, and those of the sides elsewhere
/// along them.
struct ShakenPlane
{
  Mesh mesh;
  std::vector<FixedVec2> exact, uv; ///< #H
  std::vector<std::uint8_t> integer;
  std::vector<int> turns;

  explicit ShakenPlane(int n, double size, int scale = 1) : mesh(test::gridPlane(n, n))
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> value(-size, size);
    std::vector<FixedVec2> image;
    for (Vector3& p : mesh.position.editAll())
    {
      const bool sideU = p.x() == 0 || p.x() == n, sideV = p.y() == 0 || p.y() == n;
      image.push_back(
        toFixed(Vector2(p.x() + (sideU ? 0 : value(random)), p.y() + (sideV ? 0 : value(random)))));
      integer.push_back(sideU && sideV ? 1 : 0);
      turns.push_back(sideU && sideV ? 1 : sideU || sideV ? 2 : 4);
      p *= scale;
    }
    for (const Index v : mesh.origin)
    {
      uv.push_back(image[v]);
      exact.push_back(toFixed(Vector2(mesh.position[v].head<2>() / scale)));
    }
  }
  double largestError() const
  {
    double error = 0;
    for (std::size_t h = 0; h < uv.size(); ++h)
    {
      error = std::max(error, toDouble(uv[h] - exact[h]).norm());
    }
    return error;
  }
};

RelaxOptions thorough()
{
  RelaxOptions options;
  options.leastGain = 1e-12;
  return options;
}

} // namespace

TEST(RelaxMap, FindsTheIsometry)
{
  // Three surface units to a quad: the size comes from the map.
  ShakenPlane plane(12, 0.3, 3);
  ASSERT_GT(plane.largestError(), 0.2);
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, thorough(), plane.uv);
  EXPECT_TRUE(result.status.ok());
  EXPECT_GT(result.before, 1.1);
  EXPECT_NEAR(result.after, 1, 1e-9); // 4 is the least energy of a triangle, and reached
  EXPECT_LT(plane.largestError(), 1e-4);
  EXPECT_TRUE(certify(plane.mesh, plane.uv, plane.turns, plane.integer).valid());
}

/// Charts are free, so the map may be cut anywhere.
TEST(RelaxMap, WorksAcrossAnyCharts)
{
  ShakenPlane plane(9, 0.3);
  const std::vector<FixedVec2> before = plane.uv;
  const auto chart = [](Index f) {
    return Transition{ static_cast<int>(f * 7 % 4), { (f * 3 % 5) * kOne, (f % 11) * kOne } };
  };
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    plane.uv[h] = chart(h / 3).apply(plane.uv[h]);
  }
  relaxMap(plane.mesh, plane.integer, thorough(), plane.uv);
  EXPECT_TRUE(certify(plane.mesh, plane.uv, plane.turns, plane.integer).valid());
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    plane.uv[h] = chart(h / 3).inverse().apply(plane.uv[h]);
  }
  EXPECT_LT(plane.largestError(), 1e-4);
}

/// An irregular vertex stays, and the rest keeps its winding: a cube's corners have three quads each.
TEST(RelaxMap, KeepsTurnsOfAClosedSurface)
{
  GridMapOptions options;
  options.edgeLength = 0.2;
  const Mesh mesh = test::sphere(3);
  GridMapResult map = computeGridMap(mesh, options);
  ASSERT_TRUE(map.status.ok());
  std::vector<FixedVec2> uv = map.uv;
  const std::vector<std::uint8_t> integer = integerVertices(mesh, map.field);
  const RelaxResult result = relaxMap(mesh, integer, {}, uv);
  EXPECT_LE(result.after, result.before);
  const Certificate certificate = certify(mesh, uv, map.field.turns, integer);
  EXPECT_TRUE(certificate.valid()) << certificate.text();
  EXPECT_EQ(certificate.area, map.certificate.area);
}

TEST(RelaxMap, LeavesWhatIsNotPositiveAlone)
{
  ShakenPlane plane(9, 0.3);
  // Turns over the triangles round one inner vertex.
  const Index v = 44;
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    if (plane.mesh.origin[h] == v)
    {
      plane.uv[h] = plane.uv[h] + FixedVec2{ 2 * kOne, 0 };
    }
  }
  const std::vector<FixedVec2> before = plane.uv;
  const std::vector<Index> inverted = findNotPositive(plane.mesh, plane.uv);
  ASSERT_FALSE(inverted.empty());
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, {}, plane.uv);
  EXPECT_LT(result.after, result.before);
  EXPECT_EQ(findNotPositive(plane.mesh, plane.uv), inverted);
  for (const Index f : inverted)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      EXPECT_TRUE(plane.uv[h] == before[h]);
    }
  }
}

/// What would move if it might: the sides of a plate with a dent, and a vertex that is to lie at a whole point.
TEST(RelaxMap, KeepsIsolinesAndIntegers)
{
  ShakenPlane plane(9, 0);
  for (Vector3& p : plane.mesh.position.editAll())
  {
    p.z() = 3 * std::exp(-(p - Vector3(3, 4, 0)).squaredNorm() / 4);
  }
  const Index v = 44;
  ASSERT_EQ(plane.turns[v], 4);
  plane.integer[v] = 1;
  const std::vector<FixedVec2> before = plane.uv;
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, thorough(), plane.uv);
  EXPECT_LT(result.after, result.before);
  EXPECT_GT(plane.largestError(), 0.05);
  const Certificate certificate = certify(plane.mesh, plane.uv, plane.turns, plane.integer);
  EXPECT_TRUE(certificate.valid()) << certificate.text();
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    EXPECT_TRUE(plane.mesh.origin[h] != v || plane.uv[h] == before[h]);
  }
}

/// Without the sweeps over single vertices, 15 steps of Newton's method would not do it: each lets a crushed triangle
/// grow by a third.
TEST(RelaxMap, RaisesCrushedTriangles)
{
  ShakenPlane plane(9, 0);
  const Index v = 44;
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    if (plane.mesh.origin[h] == v)
    {
      plane.uv[h].u += kOne - 8;
    }
  }
  ASSERT_TRUE(findNotPositive(plane.mesh, plane.uv).empty());
  RelaxOptions options;
  options.maximumSteps = 0;
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, options, plane.uv);
  EXPECT_GT(result.before, 1e6);
  EXPECT_LT(result.after, 1.5);
  EXPECT_EQ(result.steps, 0);
}

TEST(RelaxMap, TurnsAlongGuides)
{
  // In the middle of a plate, so that the sides do not decide.
  const auto angleOf = [](bool guided)
  {
    ShakenPlane plane(24, 0.1);
    RelaxOptions options = thorough();
    const Vector3 wanted(std::cos(0.3), std::sin(0.3), 0);
    for (Index f = 0; guided && f < plane.mesh.faceCount(); ++f)
    {
      const Vector3 p = plane.mesh.position[plane.mesh.origin[3 * f]];
      const bool inside = (p - Vector3(12, 12, 0)).norm() < 4;
      options.guides.push_back(inside ? Guide{ wanted, 1 } : Guide{});
    }
    relaxMap(plane.mesh, plane.integer, options, plane.uv);
    // The image of the wanted direction at the centre.
    const Index f = 2 * (24 * 12 + 12);
    const Vector3 a = plane.mesh.edgeVector(3 * f), b = -plane.mesh.edgeVector(3 * f + 2);
    Eigen::Matrix2d edges, image;
    edges << a.head<2>(), b.head<2>();
    image << toDouble(plane.uv[3 * f + 1] - plane.uv[3 * f]),
      toDouble(plane.uv[3 * f + 2] - plane.uv[3 * f]);
    const Vector2 along = image * edges.inverse() * wanted.head<2>();
    return std::abs(std::atan2(along.y(), along.x()));
  };
  EXPECT_NEAR(angleOf(false), 0.3, 0.01);
  EXPECT_LT(angleOf(true), 0.15);
}

/// Guides 45 degrees off both families, some nearer to the one and some to the other: all are on the same one.
TEST(RelaxMap, GuidesOfARegionKeepToOneFamily)
{
  ShakenPlane plane(24, 0.1);
  RelaxOptions options = thorough();
  const auto wanted = [](Index f)
  {
    const double angle = kPi / 4 + (f % 3 - 1.0) * 0.02;
    return Vector3(std::cos(angle), std::sin(angle), 0);
  };
  std::vector<Index> inside;
  for (Index f = 0; f < plane.mesh.faceCount(); ++f)
  {
    const Vector3 p = plane.mesh.position[plane.mesh.origin[3 * f]];
    const bool isInside = (p - Vector3(12, 12, 0)).norm() < 4;
    options.guides.push_back(isInside ? Guide{ wanted(f), 1 } : Guide{});
    if (isInside)
    {
      inside.push_back(f);
    }
  }
  relaxMap(plane.mesh, plane.integer, options, plane.uv);
  EXPECT_TRUE(certify(plane.mesh, plane.uv, plane.turns, plane.integer).valid());
  std::array<std::size_t, 2> off{ 0, 0 }; // faces more than 10 degrees off a family
  for (const Index f : inside)
  {
    const Vector3 a = plane.mesh.edgeVector(3 * f), b = -plane.mesh.edgeVector(3 * f + 2);
    Eigen::Matrix2d edges, image;
    edges << a.head<2>(), b.head<2>();
    image << toDouble(plane.uv[3 * f + 1] - plane.uv[3 * f]),
      toDouble(plane.uv[3 * f + 2] - plane.uv[3 * f]);
    const Eigen::Matrix2d j = image * edges.inverse();
    for (const int axis : { 0, 1 })
    {
      const double across = std::abs(j.row(axis).dot(wanted(f).head<2>())) / j.row(axis).norm();
      off[static_cast<std::size_t>(axis)] += across > std::sin(kPi / 18) ? 1 : 0;
    }
  }
  EXPECT_EQ(std::min(off[0], off[1]), 0U);
  EXPECT_GT(std::max(off[0], off[1]), inside.size() / 2);
}

TEST(RelaxMap, SameBytesForAnyNumberOfThreads)
{
  std::vector<FixedVec2> first;
  for (const int threads : { 1, 2, 4 })
  {
    ShakenPlane plane(70, 0.3);
    RelaxOptions options;
    options.threads = threads;
    relaxMap(plane.mesh, plane.integer, options, plane.uv);
    first = first.empty() ? plane.uv : first;
    EXPECT_TRUE(plane.uv == first) << threads;
  }
}

TEST(RelaxMap, RefusesWhatIsTooLarge)
{
  ShakenPlane plane(9, 0.3);
  const std::vector<FixedVec2> before = plane.uv;
  RelaxOptions options;
  options.maximumBytes = 10;
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, options, plane.uv);
  EXPECT_EQ(result.status.code, StatusCode::TooLarge);
  EXPECT_NE(result.status.message.find("162 triangles"), std::string::npos)
    << result.status.message;
  EXPECT_NE(result.status.message.find("memory is not free"), std::string::npos);
  EXPECT_TRUE(plane.uv == before);
}

TEST(RelaxMap, RefusesSizesThatDisagree)
{
  ShakenPlane plane(3, 0.1);
  EXPECT_THROW(relaxMap(plane.mesh, { 0 }, {}, plane.uv), InvalidInput);
  RelaxOptions options;
  options.guides.resize(1);
  EXPECT_THROW(relaxMap(plane.mesh, plane.integer, options, plane.uv), InvalidInput);
  plane.uv.pop_back();
  EXPECT_THROW(relaxMap(plane.mesh, plane.integer, {}, plane.uv), InvalidInput);
}

TEST(RelaxMap, StopsOnRequest)
{
  ShakenPlane plane(9, 0.3);
  RelaxOptions options;
  int reports = 0;
  options.progress = [&](double, const std::string&) { return ++reports < 3; };
  EXPECT_THROW(relaxMap(plane.mesh, plane.integer, options, plane.uv), Cancelled);
}

TEST(RelaxMap, MovesASideInByHalfAQuad)
{
  ShakenPlane plane(12, 0.2);
  RelaxOptions options = thorough();
  options.inset.assign(plane.uv.size(), 0);
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    const bool atSide = plane.mesh.position[plane.mesh.origin[h]].y() == 0 &&
      plane.mesh.position[plane.mesh.target(h)].y() == 0;
    options.inset[h] = plane.mesh.isBoundary(h) && atSide ? 1 : 0;
  }
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, options, plane.uv);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = plane.mesh.position[plane.mesh.origin[h]];
    // Between two parallel sides the least distortion is the same everywhere.
    const Vector2 even(p.x(), 0.5 + p.y() * 11.5 / 12);
    EXPECT_LT((toDouble(plane.uv[h]) - even).norm(), 1e-4);
    if (p.y() == 0)
    {
      EXPECT_EQ(plane.uv[h].v, kOne / 2); // with every bit
    }
  }
}

TEST(RelaxMap, TellsWhereASideHasNoRoom)
{
  // One quad wide, and both sides are to move towards each other.
  ShakenPlane plane(1, 0);
  RelaxOptions options = thorough();
  options.inset.assign(plane.uv.size(), 0);
  for (Index h = 0; h < plane.mesh.halfEdgeCount(); ++h)
  {
    options.inset[h] = plane.mesh.isBoundary(h) &&
        plane.mesh.position[plane.mesh.origin[h]].y() ==
          plane.mesh.position[plane.mesh.target(h)].y()
      ? 1
      : 0;
  }
  const RelaxResult result = relaxMap(plane.mesh, plane.integer, options, plane.uv);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  EXPECT_NE(result.status.message.find("cannot move by half a quad"), std::string::npos);
  options.maximumSteps = 0;
  EXPECT_THROW(relaxMap(plane.mesh, plane.integer, options, plane.uv), InvalidInput);
}
