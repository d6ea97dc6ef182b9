// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/GuidedMap.h"

#include "Base/Progress.h"
#include "GridMap/MapCheck.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/BreadthFirst.h"
#include "Mesh/FaceSpread.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>

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
  const std::vector<int> ring = ringsFrom(mesh,
    cornerVertices(
      mesh, idsWhere(mesh.faceCount(), [&](Index f) { return !level.guides[f].isFree(); })),
    kRingsRoundRegions);
  std::vector<std::uint8_t> far(ring.size());
  std::transform(ring.begin(), ring.end(), far.begin(),
    [](int r) { return static_cast<std::uint8_t>(r > kRingsRoundRegions ? 1 : 0); });
  return far;
}

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
  std::vector<SpreadStart> starts; // the faces round the corners of guided faces
  std::vector<Index> levelFace;    // of each of these
  for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
  {
    if (!level.guides[Mesh::face(h)].isFree())
    {
      const Index v = level.fineVertex[level.mesh.origin[h]];
      forEachInFan(fine, outgoing[v],
        [&](Index side)
        {
          starts.push_back({ Mesh::face(side), fine.position[v], edgeLength * sizeAt(fine, v) });
          levelFace.push_back(Mesh::face(h));
        });
    }
  }
  const std::vector<Index> reached =
    spreadOverFaces(fine, starts, [&](Index h) { return !fine.isConstrained(h); });
  for (Index f = 0; f < fine.faceCount(); ++f)
  {
    if (reached[f] != kInvalidIndex)
    {
      result.push_back({ f, level.guides[levelFace[reached[f]]] });
    }
  }
  return result;
}

} // namespace quadrille
