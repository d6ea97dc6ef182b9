// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/PatchLevels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

constexpr int kColumns = 24;

/// A patch of a plane whose map has one chart: all faces but those at the boundary, and the vertices that it may move.
struct PlanePatch
{
  Mesh mesh = gridPlane(kColumns, kColumns);
  std::vector<Index> patch;
  std::vector<PatchCorner> corners; ///< of all stars, one after the other
  std::vector<PatchStar> stars;
  std::vector<FixedVec2> valid;
  std::vector<int> turns;

  explicit PlanePatch(bool hasCurve)
  {
    valid = mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
    turns = turnsOf(mesh, valid);
    const auto isOnCurve = [&](Index v)
    { return hasCurve && mesh.position[v].y() == kColumns / 2; };
    const auto depth = [&](Index v)
    {
      const Vector3& p = mesh.position[v];
      return std::min({ p.x(), p.y(), kColumns - p.x(), kColumns - p.y() });
    };
    std::vector<std::vector<Index>> at(mesh.vertexCount());
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const Index* v = &mesh.origin[3 * f];
      if (depth(v[0]) >= 1 && depth(v[1]) >= 1 && depth(v[2]) >= 1)
      {
        patch.push_back(f);
      }
    }
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      at[mesh.origin[h]].push_back(h);
      if (isOnCurve(mesh.origin[h]) && isOnCurve(mesh.target(h)))
      {
        mesh.flags.edit()[h] |= kFeatureEdge;
      }
    }
    std::vector<std::size_t> first;
    std::vector<Index> vertices;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      if (depth(v) >= 1)
      {
        vertices.push_back(v);
        first.push_back(corners.size());
        for (const Index h : at[v])
        {
          corners.push_back({ h, 0 });
        }
      }
    }
    first.push_back(corners.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      const PatchFreedom freedom = depth(vertices[i]) < 2 ? PatchFreedom::Fixed
        : isOnCurve(vertices[i])                          ? PatchFreedom::AlongU
                                                          : PatchFreedom::Plane;
      stars.push_back(
        { freedom, i % 5 == 0, corners.data() + first[i], corners.data() + first[i + 1] });
    }
  }

  /// All that may move, somewhere else.
  std::vector<FixedVec2> scrambled() const
  {
    std::vector<FixedVec2> uv = valid;
    std::mt19937 random(7);
    const auto draw = [&]() { return static_cast<std::int64_t>(random() % (6 * kOne)) - 3 * kOne; };
    for (const PatchStar& star : stars)
    {
      FixedVec2 by{ draw(), draw() };
      by.v = star.freedom == PatchFreedom::AlongU ? 0 : by.v;
      for (const PatchCorner* c = star.begin; c != star.end; ++c)
      {
        uv[c->corner] = uv[c->corner] + (star.freedom == PatchFreedom::Fixed ? FixedVec2{} : by);
      }
    }
    return uv;
  }
};

/// A level's map by the places in the plane.
bool solveByPosition(const Mesh& mesh, std::vector<FixedVec2>& uv)
{
  uv = mapByPosition(mesh, [](const Vector3& p) { return Vector2(p.x(), p.y()); });
  return notPositive(uv) == 0;
}

} // namespace

TEST(PatchLevels, VerticesComeBackWithoutFoldsWhateverTheMapWas)
{
  for (const bool hasCurve : { false, true })
  {
    SCOPED_TRACE(hasCurve);
    const PlanePatch plane(hasCurve);
    std::vector<FixedVec2> uv = plane.scrambled();
    const std::vector<FixedVec2> before = uv;
    ASSERT_GT(notPositive(uv), 0U);
    std::size_t asked = 0, fewest = plane.mesh.faceCount();
    const PatchSolver solver = [&](const Mesh& mesh, const std::vector<Index>& patch,
                                 const std::vector<int>& turns, std::vector<FixedVec2>& levelUv)
    {
      ++asked;
      fewest = std::min<std::size_t>(fewest, patch.size());
      EXPECT_EQ(turns.size(), mesh.position.size());
      EXPECT_EQ(seamResiduals(mesh, levelUv), 0U);
      return solveByPosition(mesh, levelUv);
    };
    const PatchLevelsResult result =
      solveByLevels(plane.mesh, plane.patch, plane.stars, plane.turns, 1, solver, uv);
    EXPECT_TRUE(result.valid);
    EXPECT_GT(result.work, 0U);
    EXPECT_GE(asked, 1U);
    EXPECT_LT(2 * fewest, plane.patch.size());
    EXPECT_EQ(notPositive(uv), 0U);
    EXPECT_EQ(seamResiduals(plane.mesh, uv), 0U);
    EXPECT_EQ(turnsOf(plane.mesh, uv), plane.turns);
    for (const PatchStar& star : plane.stars)
    {
      for (const PatchCorner* c = star.begin; c != star.end; ++c)
      {
        if (star.freedom == PatchFreedom::Fixed)
        {
          EXPECT_EQ(uv[c->corner], before[c->corner]);
        }
        else if (star.freedom == PatchFreedom::AlongU)
        {
          EXPECT_EQ(uv[c->corner].v, before[c->corner].v) << "off its isoline";
        }
      }
    }
  }
}

TEST(PatchLevels, WithoutAMapOfALevelNothingChanges)
{
  const PlanePatch plane(true);
  std::vector<FixedVec2> uv = plane.scrambled();
  const std::vector<FixedVec2> before = uv;
  std::vector<std::size_t> sizes;
  const PatchSolver solver = [&](const Mesh&, const std::vector<Index>& patch,
                               const std::vector<int>&, std::vector<FixedVec2>& levelUv)
  {
    sizes.push_back(patch.size());
    levelUv.assign(levelUv.size(), FixedVec2{});
    return false;
  };
  EXPECT_FALSE(
    solveByLevels(plane.mesh, plane.patch, plane.stars, plane.turns, 1, solver, uv).valid);
  EXPECT_EQ(uv, before);
  // Several levels were asked for, each finer than the one before.
  EXPECT_GE(sizes.size(), 2U);
  EXPECT_TRUE(std::is_sorted(sizes.begin(), sizes.end()));
}
