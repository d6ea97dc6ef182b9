// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "BothPhases.h"
#include "Hierarchy/FreeStar.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

/// Noise without a pattern, so that no two triangulations of a ring are equally good.
Mesh roughSphere(int level, double amplitude)
{
  Mesh mesh = sphere(level);
  std::uint32_t state = 12345;
  for (Vector3& p : mesh.position.editAll())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      state = state * 1664525U + 1013904223U;
      p[axis] += amplitude * (static_cast<double>(state >> 8) / 8388608.0 - 1);
    }
  }
  return mesh;
}

DecimationMesh decimationMesh(const Mesh& mesh)
{
  return DecimationMesh(mesh, traceFeatureCurves(mesh, 1));
}

/// The same records but for the weights, which may differ by single precision.
void expectSameRecords(const RecordWriter& a, const RecordWriter& b)
{
  ASSERT_EQ(a.bytes().size(), b.bytes().size());
  ASSERT_EQ(a.flips(), b.flips());
  const auto begin = [](const RecordWriter& log)
  { return log.bytes().data() + log.bytes().size() - kFlipBytes * log.flips(); };
  EXPECT_TRUE(std::equal(begin(a), a.bytes().data() + a.bytes().size(), begin(b)));
  CollapseRecord recordA;
  CollapseRecord recordB;
  readCollapse(begin(a), recordA);
  readCollapse(begin(b), recordB);
  EXPECT_EQ(recordA.slot, recordB.slot);
  EXPECT_EQ(recordA.target(), recordB.target());
  // Weights by ring vertex: which of two equal ones is the base may differ.
  const auto weights = [](const CollapseRecord& record)
  {
    std::array<double, kMaximumRing> w{};
    const double first = record.weight[0] / 4294967296.0;
    const double second = record.weight[1] / 4294967296.0;
    w[record.ring[0]] += 1 - first - second;
    w[record.ring[1]] += first;
    w[record.ring[2]] += second;
    return w;
  };
  for (std::size_t i = 0; i < kMaximumRing; ++i)
  {
    // Angles are good to 3e-7 and lie in triangles that are not flatter than 0.02: a factor of about 50.
    EXPECT_NEAR(weights(recordA)[i], weights(recordB)[i], 2e-5);
  }
}

} // namespace

TEST(FreeStar, DoesWhatVertexRemovalDoes)
{
  int planned = 0;
  int refused = 0;
  for (const double amplitude : { 0.002, 0.01, 0.02, 0.04 })
  {
    const Mesh mesh = roughSphere(4, amplitude);
    DecimationMesh fast = decimationMesh(mesh);
    DecimationMesh slow = decimationMesh(mesh);
    RemovalGuards guards;
    FreeStar star(fast, guards);
    VertexRemoval removal(slow);
    for (Index v = 0; v < mesh.vertexCount(); v += 1 + v % 3)
    {
      if (fast.valence[v] < FreeStar::kLeast || fast.valence[v] > FreeStar::kMost)
      {
        continue;
      }
      star.gather(v);
      ASSERT_TRUE(removal.gather(v));
      EXPECT_NEAR(star.shortestEdge(0.1) * 0.1, removal.shortestEdge(), 1e-7);
      const FreeStar::Outcome outcome = star.plan();
      if (outcome == FreeStar::Outcome::Unsuited)
      {
        continue;
      }
      const bool allowed = removal.plan(guards);
      ASSERT_EQ(outcome == FreeStar::Outcome::Planned, allowed) << v;
      ++(allowed ? planned : refused);
      if (allowed)
      {
        RecordWriter fastLog;
        RecordWriter slowLog;
        star.apply(fastLog);
        removal.apply(slowLog);
        expectSameRecords(fastLog, slowLog);
        ASSERT_EQ(fast.origin, slow.origin);
        ASSERT_EQ(fast.twin, slow.twin);
        ASSERT_EQ(fast.valence, slow.valence);
        slow.outgoing =
          fast.outgoing; // either half-edge of a vertex is right, but rings must begin alike
      }
    }
  }
  EXPECT_GT(planned, 2000);
  EXPECT_GT(refused, 100);
}

TEST(FreeStar, LeavesSliversToVertexRemoval)
{
  Mesh mesh = sphere(3);
  const Index v = 100;
  DecimationMesh before = decimationMesh(mesh);
  const Index a = before.target(before.outgoing[v]);
  const Index b = before.target(before.twin[Mesh::previous(before.outgoing[v])]);
  mesh.position.edit()[v] =
    0.5 * (mesh.position[a] + mesh.position[b]); // the face v a b has no height left
  DecimationMesh flat = decimationMesh(mesh);
  FreeStar star(flat, RemovalGuards());
  star.gather(v);
  star.shortestEdge(1);
  EXPECT_EQ(star.plan(), FreeStar::Outcome::Unsuited);
}

TEST(FreeStar, LeavesDiagonalsThatExistToVertexRemoval)
{
  // A thin prism with pointed ends: the diagonals inside the ring of a vertex of its middle go round its back.
  const int rows = 5;
  std::vector<Vector3> points;
  for (int row = 0; row < rows; ++row)
  {
    for (int i = 0; i < 3; ++i)
    {
      const double angle = 2 * kPi * i / 3;
      points.emplace_back(0.2 * std::cos(angle), 0.2 * std::sin(angle), row);
    }
  }
  points.emplace_back(0, 0, -1);
  points.emplace_back(0, 0, rows);
  std::vector<Triangle> triangles;
  const auto at = [](int row, int i) { return static_cast<Index>(3 * row + i % 3); };
  for (int i = 0; i < 3; ++i)
  {
    triangles.push_back({ 3 * rows, at(0, i + 1), at(0, i) });
    for (int row = 0; row + 1 < rows; ++row)
    {
      triangles.push_back({ at(row, i), at(row, i + 1), at(row + 1, i) });
      triangles.push_back({ at(row, i + 1), at(row + 1, i + 1), at(row + 1, i) });
    }
    triangles.push_back({ at(rows - 1, i), at(rows - 1, i + 1), 3 * rows + 1 });
  }
  const Mesh mesh = makeMesh(points, triangles);
  ASSERT_EQ(validate(mesh), "");
  DecimationMesh prism = decimationMesh(mesh);
  RemovalGuards loose;
  loose.minimumQuality = 1e-3;
  loose.minimumNormalDot = -1;
  FreeStar star(prism, loose);
  for (Index v = 6; v < 9; ++v)
  {
    star.gather(v);
    star.shortestEdge(1);
    // Whatever it chooses, the other two vertices of the row are joined behind it.
    EXPECT_NE(star.plan(), FreeStar::Outcome::Planned) << v;
  }
}

TEST(FreeStar, FoldsOfTheInputDoNotStopPhase1)
{
  // Noise of about the length of the edges, as scans have it where they are much denser than exact.
  const auto verticesAfter = [](const Mesh& mesh)
  {
    HierarchyOptions options;
    options.targetEdgeLength = 0.3;
    options.coarseVertices = 100000;
    options.threads = 1;
    return buildHierarchy(mesh, 1, options).intermediate.mesh.vertexCount();
  };
  // Noise makes the surface larger. Without the rule for stars that are folded already more than half of the vertices
  // stay.
  EXPECT_LT(verticesAfter(roughSphere(5, 0.03)), 2 * verticesAfter(sphere(5)));
}
