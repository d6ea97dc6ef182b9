// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the replay must do exactly, for any seamless map.
#pragma once

#include "Base/ChartRotation.h"
#include "Hierarchy/Hierarchy.h"
#include "TestMaps.h"
#include "Transfer/Replay.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace quadrille::test
{

/// uv on the slots of the coarse level, as replayRounds wants them.
inline std::vector<FixedVec2> onSlots(
  const Mesh& fine, const Level& coarse, const std::vector<FixedVec2>& coarseUv)
{
  std::vector<FixedVec2> uv(fine.halfEdgeCount());
  for (Index h = 0; h < coarse.mesh.halfEdgeCount(); ++h)
  {
    uv[3 * coarse.fineFace[h / 3] + h % 3] = coarseUv[h];
  }
  return uv;
}

/// The map seen through charts that are turned by random quarters and moved at random, face by face: every edge is
/// a seam with a transition of its own then.
inline void shuffleCharts(std::vector<FixedVec2>& uv, unsigned seed)
{
  std::mt19937_64 random(seed);
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    const int turns = static_cast<int>(random() % 4);
    const FixedVec2 shift{ static_cast<std::int64_t>(random() >> 28),
      -static_cast<std::int64_t>(random() >> 28) };
    for (std::size_t i = h; i < h + 3; ++i)
    {
      uv[i] = rotate(uv[i], turns) + shift;
    }
  }
}

/// Of a vertex with an edge that has no length in the map: such an edge has no rotation.
constexpr int kUnknownTurns = -1;

/// Quarter turns of the charts once round each inner vertex, modulo 4; 0 at boundary vertices; kUnknownTurns where an
/// edge has no length.
inline std::vector<int> holonomy(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<int> turns(mesh.vertexCount(), 0);
  std::vector<bool> boundary(mesh.vertexCount(), false);
  std::vector<bool> unknown(mesh.vertexCount(), false);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    // The transitions round the origin of h are those of the half-edges that lead to it.
    const Index incoming = Mesh::previous(h);
    boundary[mesh.origin[h]] =
      boundary[mesh.origin[h]] || mesh.isBoundary(h) || mesh.isBoundary(incoming);
    if (!mesh.isBoundary(incoming) && uv[h] == uv[incoming])
    {
      unknown[mesh.origin[h]] = true;
    }
    else if (!mesh.isBoundary(incoming))
    {
      const Index g = mesh.twin[incoming];
      const std::optional<int> quarter =
        rotationBetween(uv[h] - uv[incoming], uv[g] - uv[Mesh::next(g)]);
      EXPECT_TRUE(quarter) << "half-edge " << incoming;
      turns[mesh.origin[h]] += quarter.value_or(0);
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    turns[v] = unknown[v] ? kUnknownTurns : boundary[v] ? 0 : turns[v] & 3;
  }
  return turns;
}

/// uv: set on the slots of the coarse level; set on all afterwards.
inline ReplayCounts replayAll(const DecimationLog& log, std::vector<FixedVec2>& uv, int threads)
{
  return replayRounds(log, { log.rounds.size(), 0 }, uv, threads, {});
}

/// Replays a map that is seamless on the coarse level and holds all that must be exact against it.
inline void expectExactReplay(
  const Mesh& fine, const Hierarchy& h, const std::vector<FixedVec2>& coarseUv)
{
  ASSERT_EQ(seamResiduals(h.coarse.mesh, coarseUv), 0U);
  ASSERT_EQ(constrainedEdgesOffAxis(h.coarse.mesh, coarseUv), 0U);
  std::vector<FixedVec2> uv = onSlots(fine, h.coarse, coarseUv);
  const ReplayCounts counts = replayAll(h.log, uv, 2);
  EXPECT_EQ(counts.lostTransitions, 0U);
  EXPECT_EQ(seamResiduals(fine, uv), 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(fine, uv), 0U) << "exactly on isolines";
  std::vector<int> expected(fine.vertexCount(), 0);
  const std::vector<int> coarse = holonomy(h.coarse.mesh, coarseUv);
  for (Index v = 0; v < coarse.size(); ++v)
  {
    expected[h.coarse.fineVertex[v]] = coarse[v];
  }
  const std::vector<int> found = holonomy(fine, uv);
  std::size_t unknown = 0;
  for (Index v = 0; v < fine.vertexCount(); ++v)
  {
    unknown += found[v] == kUnknownTurns ? 1 : 0;
    if (found[v] != kUnknownTurns)
    {
      EXPECT_EQ(found[v], expected[v]) << "vertex " << v;
    }
  }
  // Where a star was inverted two of its vertices may come to lie on one point of the grid of 2^-24: a rare thing.
  EXPECT_LE(unknown, 4U);
  for (Index c = 0; c < h.coarse.mesh.halfEdgeCount(); ++c)
  {
    // A constrained vertex of the coarse level has its isoline's value on the fine one; nothing else may move it
    // either. Its corner may have gone to another vertex, but the faces' charts have not changed, so a corner that
    // still is this vertex's has its uv to the bit.
    const Index slot = 3 * h.coarse.fineFace[c / 3] + c % 3;
    if (fine.origin[slot] == h.coarse.fineVertex[h.coarse.mesh.origin[c]])
    {
      ASSERT_EQ(uv[slot], coarseUv[c]);
    }
  }
}

} // namespace quadrille::test
