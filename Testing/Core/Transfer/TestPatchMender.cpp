// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Angles.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/PatchMender.h"
#include "Transfer/PatchRotations.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Moves all corners of the vertices that `chosen` wants by the same vector in the chart of each corner; for maps
/// with a single chart round these vertices.
void moveVertices(const Mesh& mesh, std::vector<FixedVec2>& uv, FixedVec2 by,
  const std::function<bool(const Vector3&)>& chosen)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    uv[h] = chosen(mesh.position[mesh.origin[h]]) ? uv[h] + by : uv[h];
  }
}

/// Quadrants of n by n squares round a point, flat and of even shapes, with a map that has its irregular vertex one
/// step beside the point: all others are where a map has them that has it in the point.
struct ShiftedCone
{
  Mesh mesh;
  std::vector<FixedVec2> uv;
  std::vector<int> turns;
};

ShiftedCone shiftedCone(int quadrants, int n)
{
  // Of a quadrant the vertices with x >= 1; those with x = 0 are the next one's.
  const auto at = [&](int quadrant, int x, int y)
  {
    const int q = x == 0 ? (quadrant + 1) % quadrants : quadrant;
    const int i = x == 0 ? y : x;
    const int j = x == 0 ? 0 : y;
    return static_cast<Index>(i == 0 ? 0 : 1 + (q * n + i - 1) * n + j);
  };
  std::vector<Vector3> points{ Vector3::Zero() };
  for (int q = 0; q < quadrants; ++q)
  {
    for (int i = 1; i <= n; ++i)
    {
      for (int j = 0; j < n; ++j)
      {
        const double angle = (q * kRightAngle + std::atan2(j, i)) * 4 / quadrants;
        points.emplace_back(std::hypot(i, j) * Vector3(std::cos(angle), std::sin(angle), 0));
      }
    }
  }
  std::vector<Triangle> triangles;
  std::vector<FixedVec2> around, uv;
  const Index moved = at(0, 1, 0);
  const auto add = [&](int q, const std::array<std::pair<int, int>, 3>& corners)
  {
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto& [i, j] = corners[k];
      triangle[k] = at(q, i, j);
      around.push_back(rotate(FixedVec2{ i * kOne, j * kOne }, q));
      uv.push_back(triangle[k] == moved ? FixedVec2{}
          : triangle[k] == 0            ? FixedVec2{ -kOne / 8, kOne / 4 }
                                        : around.back());
    }
    triangles.push_back(triangle);
  };
  for (int q = 0; q < quadrants; ++q)
  {
    for (int x = 0; x < n; ++x)
    {
      for (int y = 0; y + 1 < n; ++y)
      {
        add(q, { { { x, y }, { x + 1, y }, { x + 1, y + 1 } } });
        add(q, { { { x, y }, { x + 1, y + 1 }, { x, y + 1 } } });
      }
    }
  }
  ShiftedCone made{ makeMesh(points, triangles), std::move(uv), {} };
  made.turns = turnsOf(made.mesh, around);
  std::swap(made.turns[0], made.turns[moved]);
  return made;
}

} // namespace

TEST(PatchMender, IrregularVertexBesideItsPlaceKeepsItsTurns)
{
  for (const int quadrants : { 5, 6, 7 })
  {
    SCOPED_TRACE(quadrants);
    ShiftedCone model = shiftedCone(quadrants, 10);
    ASSERT_EQ(seamResiduals(model.mesh, model.uv), 0U);
    ASSERT_NE(turnsOf(model.mesh, model.uv), model.turns);
    const MendResult result = mendPatches(model.mesh, model.uv, model.turns, 1, {});
    EXPECT_EQ(result.notPositive, 0U);
    EXPECT_TRUE(result.defects.empty());
    EXPECT_EQ(seamResiduals(model.mesh, model.uv), 0U);
    EXPECT_EQ(turnsOf(model.mesh, model.uv), model.turns);
  }
}

TEST(PatchMender, LeavesAValidMapAlone)
{
  const Mesh mesh = torus(30, 15);
  std::vector<FixedVec2> uv =
    torusMap(mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  const std::vector<FixedVec2> before = uv;
  const MendResult result = mendPatches(mesh, uv, turnsOf(mesh, uv), 1, {});
  EXPECT_EQ(result.patches, 0U);
  EXPECT_EQ(result.notPositive, 0U);
  EXPECT_EQ(uv, before);
}

TEST(PatchMender, MendsAFoldInsideAPlane)
{
  const Mesh mesh = gridPlane(20, 20);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  const std::vector<int> turns = turnsOf(mesh, uv);
  const auto inFold = [](const Vector3& p)
  { return (p - Vector3(10, 10, 0)).lpNorm<Eigen::Infinity>() <= 1; };
  moveVertices(mesh, uv, { 5 * kOne / 2, kOne }, inFold);
  const std::vector<FixedVec2> before = uv;
  ASSERT_GT(notPositive(uv), 0U);
  const MendResult result = mendPatches(mesh, uv, turns, 1, {});
  EXPECT_EQ(result.notPositive, 0U);
  EXPECT_EQ(notPositive(uv), 0U);
  EXPECT_EQ(seamResiduals(mesh, uv), 0U);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    if (p.x() == 0 || p.x() == 20 || p.y() == 0 || p.y() == 20)
    {
      EXPECT_EQ(uv[h], before[h]) << "far from the fold nothing moves";
    }
  }
}

TEST(PatchMender, MendsAcrossSeamsWithRotations)
{
  // The fold lies over an edge of the cube, whose two sides have charts turned against each other. It is made by
  // sliding vertices of the edge along it, exactly, through both charts.
  const Mesh mesh = markFeatures(unitCube(12), kFeatureAngle);
  std::vector<Vector3> folded = mesh.position;
  for (Vector3& p : folded)
  {
    if (p.x() == 1 && p.y() == 1 && p.z() > 0.4 && p.z() < 0.6)
    {
      p.z() += 0.3; // past its neighbours on the edge
    }
  }
  std::vector<FixedVec2> uv = cubeMap(mesh, 12, &folded);
  ASSERT_GT(notPositive(uv), 0U);
  ASSERT_EQ(seamResiduals(mesh, uv), 0U);
  const std::vector<int> turns = turnsOf(mesh, cubeMap(mesh, 12, nullptr));
  const MendResult result = mendPatches(mesh, uv, turns, 1, {});
  EXPECT_EQ(turnsOf(mesh, uv), turns);
  EXPECT_GT(result.patches, 0U);
  EXPECT_EQ(notPositive(uv), 0U);
  EXPECT_EQ(seamResiduals(mesh, uv), 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(mesh, uv), 0U);
}

TEST(PatchMender, EndOfASlitStaysOnItsWholePoint)
{
  // A plane with a slit from (10, 10) to the right. At its end the boundary turns back along itself: both boundary
  // edges lie on one isoline, as where a boundary passes straight, but there are four quarter turns between them.
  const int n = 20;
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  for (int y = 0; y <= n; ++y)
  {
    for (int x = 0; x <= n; ++x)
    {
      points.emplace_back(x, y, 0);
    }
  }
  for (int x = 11; x <= n; ++x)
  {
    points.emplace_back(x, 10, 0); // the upper side of the slit
  }
  const auto at = [&](int x, int y, bool above)
  {
    return static_cast<Index>(
      y == 10 && x > 10 && above ? (n + 1) * (n + 1) + x - 11 : y * (n + 1) + x);
  };
  for (int y = 0; y < n; ++y)
  {
    for (int x = 0; x < n; ++x)
    {
      const bool above = y >= 10;
      const Index a = at(x, y, above), b = at(x + 1, y, above), c = at(x + 1, y + 1, above),
                  d = at(x, y + 1, above);
      triangles.push_back({ a, b, c });
      triangles.push_back({ a, c, d });
    }
  }
  const Mesh mesh = makeMesh(points, triangles);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  const std::vector<int> turns = turnsOf(mesh, uv);
  const Vector3 end(10, 10, 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    ASSERT_TRUE(mesh.position[mesh.origin[h]] != end || turns[mesh.origin[h]] == 4);
  }
  moveVertices(mesh, uv, { 7 * kOne / 4, kOne / 2 },
    [](const Vector3& p) { return p.x() >= 8 && p.x() <= 9 && std::abs(p.y() - 10) <= 1; });
  ASSERT_GT(notPositive(uv), 0U);
  mendPatches(mesh, uv, turns, 1, {});
  EXPECT_EQ(notPositive(uv), 0U);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.position[mesh.origin[h]] == end)
    {
      EXPECT_EQ(uv[h], (FixedVec2{ 10 * kOne, 10 * kOne }));
    }
  }
}

TEST(PatchMender, GivesUpOnWhatCannotBeMended)
{
  // The whole map is mirrored: no patch with a fixed border can be positive.
  const Mesh mesh = gridPlane(12, 12);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(-p.x(), p.y()); });
  const MendResult result = mendPatches(mesh, uv, std::vector<int>(mesh.vertexCount(), 4), 1, {});
  EXPECT_EQ(result.notPositive, notPositive(uv));
  EXPECT_GT(result.notPositive, 0U);
  EXPECT_EQ(seamResiduals(mesh, uv), 0U);
}

namespace
{

/// A disk round a vertex of valence 5: five squares of n by n quads, each with its own chart, all of whose corners
/// (0, 0) are the middle. The v axis of one is the u axis of the next.
struct Cone
{
  explicit Cone(int size) : n(size)
  {
    std::vector<Vector3> points{ Vector3::Zero() };
    for (int k = 0; k < 5; ++k)
    {
      for (int y = 0; y < n; ++y)
      {
        for (int x = 1; x <= n; ++x)
        {
          const double angle = 0.8 * (std::atan2(y, x) + k * std::acos(0.0));
          points.push_back(std::hypot(x, y) * Vector3(std::cos(angle), std::sin(angle), 0));
        }
      }
    }
    std::vector<Triangle> triangles;
    for (int k = 0; k < 5; ++k)
    {
      for (int y = 0; y + 1 < n; ++y)
      {
        for (int x = 0; x < n; ++x)
        {
          const Index a = at(k, x, y), b = at(k, x + 1, y), c = at(k, x + 1, y + 1),
                      d = at(k, x, y + 1);
          triangles.push_back({ a, b, c });
          triangles.push_back({ a, c, d });
          place.insert(place.end(),
            { { x, y }, { x + 1, y }, { x + 1, y + 1 }, { x, y }, { x + 1, y + 1 }, { x, y + 1 } });
          chart.insert(chart.end(), 6, k);
        }
      }
    }
    mesh = makeMesh(points, triangles);
  }

  /// x = 0 is the axis of the next square.
  Index at(int k, int x, int y) const
  {
    if (x == 0)
    {
      return y == 0 ? 0 : at((k + 1) % 5, y, 0);
    }
    return static_cast<Index>(1 + k * n * n + y * n + x - 1);
  }

  /// moved: vertex and displacement in the chart of `of`, turned into the charts beside it.
  std::vector<FixedVec2> map(const std::vector<std::pair<Index, FixedVec2>>& moved, int of) const
  {
    std::vector<FixedVec2> uv;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      uv.push_back({ place[h].first * kOne, place[h].second * kOne });
      for (const auto& [vertex, by] : moved)
      {
        if (mesh.origin[h] == vertex)
        {
          uv.back() = uv.back() + rotate(by, chart[h] == (of + 1) % 5 ? 3 : chart[h] == of ? 0 : 1);
        }
      }
    }
    return uv;
  }

  int n;
  Mesh mesh;
  std::vector<std::pair<std::int64_t, std::int64_t>> place; ///< #H
  std::vector<int> chart;                                   ///< #H
};

} // namespace

TEST(PatchMender, KeepsTheTurnsOfACone)
{
  // The ring of the cone has been carried over it on one side, as a replay leaves it where the whole point of the cone
  // lies beside the place that its triangles have room for. The cone must not pass four of its turns to a neighbour.
  const Cone cone(8);
  const std::vector<int> turns = turnsOf(cone.mesh, cone.map({}, 0));
  ASSERT_EQ(turns[0], 5);
  const FixedVec2 by{ -3 * kOne / 2, -5 * kOne / 4 };
  std::vector<FixedVec2> uv =
    cone.map({ { cone.at(0, 1, 1), by }, { cone.at(0, 1, 0), by }, { cone.at(0, 0, 1), by } }, 0);
  ASSERT_GT(notPositive(uv), 0U);
  ASSERT_EQ(seamResiduals(cone.mesh, uv), 0U);
  const MendResult result = mendPatches(cone.mesh, uv, turns, 1, {});
  EXPECT_TRUE(result.defects.empty());
  EXPECT_EQ(notPositive(uv), 0U);
  EXPECT_EQ(turnsOf(cone.mesh, uv), turns);
  EXPECT_EQ(seamResiduals(cone.mesh, uv), 0U);
}

TEST(PatchRotations, KnowTheMapInsideFromThatRoundIt)
{
  // Inside the patch the map is scrambled, and only its transitions are used.
  const Cone cone(8);
  const std::vector<FixedVec2> whole = cone.map({}, 0);
  const FixedVec2 by{ -3 * kOne / 2, -5 * kOne / 4 };
  const std::vector<FixedVec2> scrambled =
    cone.map({ { cone.at(0, 1, 1), by }, { cone.at(0, 1, 0), by }, { cone.at(0, 0, 1), by } }, 0);
  std::vector<Index> patch;
  std::vector<std::uint8_t> inPatch(cone.mesh.faceCount(), 0);
  for (Index f = 0; f < cone.mesh.faceCount(); ++f)
  {
    const bool near = cone.place[3 * f].first < 4 && cone.place[3 * f].second < 4;
    if (near)
    {
      patch.push_back(f);
      inPatch[f] = 1;
    }
  }
  const std::vector<double> rotations = patchRotations(cone.mesh, scrambled, patch, inPatch);
  ASSERT_EQ(rotations.size(), patch.size());
  for (std::size_t i = 0; i < patch.size(); ++i)
  {
    // The first edge, in the face laid out and in the map.
    const Index h = 3 * patch[i];
    const Vector2 image = toDouble(whole[h + 1] - whole[h]);
    const double wanted = std::atan2(image.y(), image.x()) - directionOf(cone.mesh, h);
    // Angles at the middle grow by a quarter, and the shear of a triangle turns its edges by less than that.
    EXPECT_GT(std::cos(rotations[i] - wanted), std::cos(0.6)) << "face " << patch[i];
  }
}

TEST(PatchRotations, NothingIsKnownWithoutASurrounding)
{
  const Mesh mesh = gridPlane(3, 3);
  const std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  std::vector<Index> all(mesh.faceCount());
  std::iota(all.begin(), all.end(), Index{ 0 });
  const std::vector<std::uint8_t> inPatch(mesh.faceCount(), 1);
  EXPECT_TRUE(patchRotations(mesh, uv, all, inPatch).empty());
}

TEST(PatchMender, NoBoundaryVertexSlidesPastACorner)
{
  // Three quarters of a square round a corner of three quarter turns, which only two triangles meet.
  const int n = 10;
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  std::vector<Index> id((2 * n + 1) * (2 * n + 1), kInvalidIndex);
  const auto at = [&](int x, int y)
  {
    Index& v = id[static_cast<std::size_t>((y + n) * (2 * n + 1) + x + n)];
    if (v == kInvalidIndex)
    {
      v = static_cast<Index>(points.size());
      points.emplace_back(x, y, 0);
    }
    return v;
  };
  for (int y = -n; y < n; ++y)
  {
    for (int x = -n; x < n; ++x)
    {
      if (x >= 0 || y >= 0)
      {
        const Index a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
        const bool other = (x == 0 && y == -1) || (x == -1 && y == 0); // no diagonal at the corner
        triangles.push_back(other ? Triangle{ a, b, d } : Triangle{ a, b, c });
        triangles.push_back(other ? Triangle{ b, c, d } : Triangle{ a, c, d });
      }
    }
  }
  const Mesh mesh = makeMesh(points, triangles);
  std::vector<FixedVec2> uv =
    mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  const std::vector<int> turns = turnsOf(mesh, uv);
  ASSERT_EQ(turns[at(0, 0)], 3);
  moveVertices(
    mesh, uv, { 5 * kOne / 4, 0 }, [](const Vector3& p) { return p == Vector3(-1, 0, 0); });
  ASSERT_GT(notPositive(uv), 0U);
  mendPatches(mesh, uv, turns, 1, {});
  EXPECT_EQ(notPositive(uv), 0U);
  EXPECT_EQ(turnsOf(mesh, uv), turns);
}
