// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRepair.h"

#include "QuadChecks.h"
#include "TestMeshes.h"

#include "Base/Lists.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"
#include "Quads/SurfaceWalk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

using namespace quadrille;

namespace
{

constexpr Index kColumns = 6, kRows = 5;

Index pointAt(Index i, Index j)
{
  return j * (kColumns + 1) + i;
}

Index quadAt(Index i, Index j)
{
  return j * kColumns + i;
}

/// One quad for each cell of gridPlane(kColumns, kRows), with its boundary as lines.
QuadMesh planeOfQuads(const Mesh& mesh)
{
  QuadMesh quads;
  const auto place = [&](const Vector3& p)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.position[mesh.origin[h]] == p)
      {
        std::array<double, 3> weights{};
        weights[h % 3] = 1;
        quads.sourceFace.push_back(Mesh::face(h));
        quads.sourceWeights.push_back(weights);
        return;
      }
    }
    ADD_FAILURE() << "no vertex there";
  };
  for (Index j = 0; j <= kRows; ++j)
  {
    for (Index i = 0; i <= kColumns; ++i)
    {
      quads.points.emplace_back(i, j, 0);
      place(quads.points.back());
    }
  }
  for (Index j = 0; j < kRows; ++j)
  {
    for (Index i = 0; i < kColumns; ++i)
    {
      quads.quads.push_back(
        { pointAt(i, j), pointAt(i + 1, j), pointAt(i + 1, j + 1), pointAt(i, j + 1) });
      quads.quadSourceFace.push_back(quads.sourceFace[pointAt(i, j)]);
      quads.quadSourceWeights.push_back({ 0.5, 0, 0.5 });
    }
  }
  const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] == kInvalidIndex)
    {
      quads.lines.push_back(
        { quads.quads[h / 4][h % 4], quads.quads[h / 4][(h + 1) % 4], kInvalidIndex, true });
    }
  }
  quads.valence = topology.valence;
  quads.onBoundary = topology.onBoundary;
  return quads;
}

/// The edge between the quads at (2, 0) and (3, 0) leads from (2, 0) to (4, 1) in place of (3, 0) to (3, 1): the point
/// (3, 0) on the boundary has a single quad then, with a flat corner.
QuadMesh withFlatCorner(const Mesh& mesh)
{
  QuadMesh quads = planeOfQuads(mesh);
  quads.quads[quadAt(2, 0)] = { pointAt(2, 0), pointAt(3, 0), pointAt(4, 0), pointAt(4, 1) };
  quads.quads[quadAt(3, 0)] = { pointAt(2, 0), pointAt(4, 1), pointAt(3, 1), pointAt(2, 1) };
  return quads;
}

double worstOf(const QuadMesh& quads)
{
  double worst = 1;
  for (const auto& quad : quads.quads)
  {
    worst = std::min(worst, scaledJacobian(cornersOf(quads.points, quad)));
  }
  return worst;
}

/// In the plane.
std::optional<SurfacePoint> placeOf(const Mesh& mesh, const Vector3& p)
{
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    std::array<double, 3> weights{};
    double all = 0;
    for (Index k = 0; k < 3; ++k)
    {
      const Vector3 a = mesh.position[mesh.origin[3 * f + (k + 1) % 3]];
      const Vector3 b = mesh.position[mesh.origin[3 * f + (k + 2) % 3]];
      weights[k] = (a - p).cross(b - p).z();
      all += weights[k];
    }
    if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)
    {
      return SurfacePoint{ f, { weights[0] / all, weights[1] / all, weights[2] / all } };
    }
  }
  return std::nullopt;
}

/// The lower half-edge of the constrained edge that has the place.
Index constrainedAt(const Mesh& mesh, const Vector3& p)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 a = mesh.position[mesh.origin[h]], b = mesh.position[mesh.target(h)];
    if (mesh.isConstrained(h) && (p - a).norm() + (b - p).norm() < (b - a).norm() + 1e-9)
    {
      return h;
    }
  }
  return kInvalidIndex;
}

} // namespace

TEST(QuadRepair, ReplacesAQuadWithAFlatCorner)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh quads = withFlatCorner(mesh);
  ASSERT_LE(worstOf(quads), 0);
  repairQuads(mesh, quads, {});
  EXPECT_GT(worstOf(quads), 0.3);
  const test::IndependentCheck check(quads);
  EXPECT_TRUE(check.oriented && check.vertexManifold);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.boundaryEdges, 2U * (kColumns + kRows));
  EXPECT_EQ(quads.lines.size(), check.boundaryEdges);
  const std::vector<std::uint8_t> onEdges = linesOnEdges(quads);
  EXPECT_TRUE(std::all_of(onEdges.begin(), onEdges.end(), [](std::uint8_t on) { return on != 0; }));
  ASSERT_EQ(quads.valence.size(), quads.points.size());
  EXPECT_EQ(quads.valence, analyzeQuads(quads.quads, quads.points.size()).valence);
  ASSERT_EQ(quads.quadSourceWeights.size(), quads.quads.size());
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    // What has another place in the map than a unit square has none.
    const QuadMesh before = withFlatCorner(mesh);
    const bool isOld = contains(before.quads, quads.quads[q]);
    EXPECT_EQ(isOld, (quads.quadSourceWeights[q] != std::array<double, 3>{}));
  }
}

TEST(QuadRepair, LeavesGoodQuadsAndThoseAtFixedVerticesAlone)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh good = planeOfQuads(mesh);
  repairQuads(mesh, good, {});
  EXPECT_EQ(good.quads, planeOfQuads(mesh).quads);
  EXPECT_EQ(good.points, planeOfQuads(mesh).points);

  QuadMesh quads = withFlatCorner(mesh);
  std::vector<Index> fixed;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    fixed.push_back(v);
  }
  repairQuads(mesh, quads, fixed);
  EXPECT_EQ(quads.quads, withFlatCorner(mesh).quads);
}

TEST(QuadRepair, DoesNotReachAcrossLines)
{
  const Mesh mesh = test::gridPlane(kColumns, kRows);
  QuadMesh quads = withFlatCorner(mesh);
  // A line above the row of the bad quad.
  for (Index i = 0; i < kColumns; ++i)
  {
    quads.lines.push_back({ pointAt(i, 1), pointAt(i + 1, 1), kInvalidIndex, false });
  }
  repairQuads(mesh, quads, {});
  EXPECT_GT(worstOf(quads), 0.1);
  const QuadMesh before = planeOfQuads(mesh);
  for (Index j = 1; j < kRows; ++j)
  {
    for (Index i = 0; i < kColumns; ++i)
    {
      EXPECT_TRUE(contains(quads.quads, before.quads[quadAt(i, j)]));
    }
  }
}

TEST(QuadRepair, DividesALineBesideAQuadThatOnlyLinesBound)
{
  // A triangular face above the diagonal from (1, 1) to (3, 1), whose point (2, 1) is a flat corner of its one quad.
  Mesh featured = test::makeMesh(
    { { 0, 0, 0 }, { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 }, { 1, 1, 0 }, { 3, 1, 0 }, { 2, 3, 0 } },
    { { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 5 }, { 2, 6, 5 }, { 2, 3, 6 }, { 3, 4, 6 }, { 3, 0, 4 },
      { 4, 5, 6 } });
  for (Index h = 0; h < featured.halfEdgeCount(); ++h)
  {
    const Index a = featured.origin[h], b = featured.target(h);
    if (a >= 4 && b >= 4)
    {
      featured.flags.edit()[h] = kFeatureEdge;
    }
  }
  QuadMesh quads;
  const auto add = [&](const Vector3& p)
  {
    const std::optional<SurfacePoint> place = placeOf(featured, p);
    ASSERT_TRUE(place);
    quads.points.push_back(p);
    quads.sourceFace.push_back(place->face);
    quads.sourceWeights.push_back(place->weights);
  };
  for (const Vector3& p :
    { Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(4, 0, 0), Vector3(4, 4, 0), Vector3(2, 4, 0),
      Vector3(0, 4, 0), Vector3(1, 1, 0), Vector3(2, 1, 0), Vector3(3, 1, 0), Vector3(2, 3, 0) })
  {
    add(p);
  }
  quads.quads = { { 0, 1, 7, 6 }, { 1, 2, 8, 7 }, { 2, 3, 9, 8 }, { 3, 4, 5, 9 }, { 5, 0, 6, 9 },
    { 6, 7, 8, 9 } };
  for (const auto& quad : quads.quads)
  {
    const Vector3 middle = (quads.points[quad[0]] + quads.points[quad[1]] + quads.points[quad[2]] +
                             quads.points[quad[3]]) /
      4;
    quads.quadSourceFace.push_back(placeOf(featured, middle)->face);
    quads.quadSourceWeights.push_back({ 0.5, 0.25, 0.25 });
  }
  const auto line = [&](Index a, Index b, bool boundary)
  {
    const Vector3 middle = (quads.points[a] + quads.points[b]) / 2;
    quads.lines.push_back({ a, b, constrainedAt(featured, middle), boundary });
  };
  for (const auto& [a, b] : { std::pair<Index, Index>{ 6, 7 }, { 7, 8 }, { 8, 9 }, { 9, 6 } })
  {
    line(a, b, false);
  }
  for (Index p = 0; p < 6; ++p)
  {
    line(p, (p + 1) % 6, true);
  }
  ASSERT_LE(scaledJacobian(cornersOf(quads.points, quads.quads[5])), 0);
  repairQuads(featured, quads, {});
  EXPECT_GT(worstOf(quads), 0.1);
  const test::IndependentCheck check(quads);
  EXPECT_TRUE(check.oriented && check.vertexManifold);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.boundaryEdges, 6U);
  EXPECT_GT(quads.lines.size(), 10U);
  const std::vector<std::uint8_t> onEdges = linesOnEdges(quads);
  EXPECT_TRUE(std::all_of(onEdges.begin(), onEdges.end(), [](std::uint8_t on) { return on != 0; }));
  for (const QuadLine& l : quads.lines)
  {
    const Vector3 middle = (quads.points[l.a] + quads.points[l.b]) / 2;
    EXPECT_EQ(constrainedAt(featured, middle), l.halfEdge);
  }
}
