// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/GuidedMap.h"

#include "Base/Progress.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>

namespace quadrille
{
namespace
{

/// Edges of the intermediate level, each about half a quad, over which the map outside of guided regions gives way.
constexpr int kRingsRoundRegions = 8;

/// #V flags of the vertices that are farther from all guided faces than that.
std::vector<std::uint8_t> farFromGuides(const Level& level)
{
  const Mesh& mesh = level.mesh;
  std::vector<std::uint8_t> far(mesh.vertexCount(), 1);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!level.guides[Mesh::face(h)].isFree())
    {
      far[mesh.origin[h]] = 0;
    }
  }
  for (int ring = 0; ring < kRingsRoundRegions; ++ring)
  {
    const std::vector<std::uint8_t> before = far;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (before[mesh.origin[h]] == 0)
      {
        far[mesh.target(h)] = far[mesh.origin[Mesh::previous(h)]] = 0;
      }
    }
  }
  return far;
}

/// Where a guide begins to spread: a corner of a guided face of the level.
struct GuideStart
{
  Index vertex = kInvalidIndex; ///< of the finest mesh
  Index face = kInvalidIndex;   ///< of the level
};

} // namespace

std::optional<TransferResult> transferAlongGuides(const Mesh& fine, const Hierarchy& levels,
  const std::vector<FixedVec2>& coarseUv, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& integerVertex, const TransferOptions& options)
{
  const Level& level = levels.intermediate;
  if (level.guides.empty())
  {
    return std::nullopt;
  }
  const std::size_t rounds = levels.log.intermediateRounds;
  TransferOptions transfer = options;
  transfer.progress = subProgress(options.progress, 0.0, 0.3);
  std::vector<FixedVec2> uv =
    transferToLevel(levels.coarse, level, rounds, levels.log, coarseUv, transfer);
  std::vector<std::uint8_t> fixed = farFromGuides(level);
  for (Index v = 0; v < level.mesh.vertexCount(); ++v)
  {
    fixed[v] |= integerVertex[level.fineVertex[v]];
  }
  RelaxOptions relax;
  relax.guides = level.guides;
  relax.threads = options.threads;
  relax.progress = subProgress(options.progress, 0.3, 0.5);
  if (!relaxMap(level.mesh, fixed, relax, uv).status.ok())
  {
    return std::nullopt;
  }
  transfer.progress = subProgress(options.progress, 0.5, 1.0);
  return transferFromLevel(fine, level, rounds, levels.log, uv, turns, transfer);
}

std::vector<FaceGuide> guidesRoundRegions(const Mesh& fine, const Level& level, double edgeLength)
{
  std::vector<FaceGuide> result;
  if (level.guides.empty())
  {
    return result;
  }
  const std::vector<Index> outgoing = outgoingHalfEdges(fine);
  std::vector<GuideStart> starts;
  std::vector<Index> reachedFrom(fine.faceCount(), kInvalidIndex);
  using Entry = std::tuple<double, Index, Index>; // distance, face, start
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto offer = [&](Index f, Index start)
  {
    const Index v = starts[start].vertex;
    const double distance = (fine.middleOfFace(f) - fine.position[v]).norm();
    if (reachedFrom[f] == kInvalidIndex && distance <= edgeLength * sizeAt(fine, v))
    {
      queue.push({ distance, f, start });
    }
  };
  for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
  {
    if (!level.guides[Mesh::face(h)].isFree())
    {
      const auto start = static_cast<Index>(starts.size());
      starts.push_back({ level.fineVertex[level.mesh.origin[h]], Mesh::face(h) });
      forEachInFan(
        fine, outgoing[starts.back().vertex], [&](Index side) { offer(Mesh::face(side), start); });
    }
  }
  while (!queue.empty())
  {
    const auto [distance, face, start] = queue.top();
    queue.pop();
    if (reachedFrom[face] != kInvalidIndex)
    {
      continue;
    }
    reachedFrom[face] = start;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      if (!fine.isConstrained(h))
      {
        offer(Mesh::face(fine.twin[h]), start);
      }
    }
  }
  for (Index f = 0; f < fine.faceCount(); ++f)
  {
    if (reachedFrom[f] != kInvalidIndex)
    {
      result.push_back({ f, level.guides[starts[reachedFrom[f]].face] });
    }
  }
  return result;
}

} // namespace quadrille
