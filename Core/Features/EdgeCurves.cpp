// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/EdgeCurves.h"

#include "Mesh/Topology.h"

#include <cstdint>

namespace quadrille
{

std::vector<std::vector<Index>> curvesOfEdges(const Mesh& mesh, const std::vector<Index>& halfEdges)
{
  std::vector<std::vector<Index>> curves;
  if (halfEdges.empty())
  {
    return curves;
  }
  const Grouped<> at = edgesAtVertices(mesh, halfEdges);
  const std::vector<std::uint8_t> isOnNetwork = constrainedVertices(mesh);
  const auto onwards = [&](Index h, Index v)
  { return isOnNetwork[v] != 0 || at.size(v) != 2 ? kInvalidIndex : at.otherThan(v, h); };
  std::vector<std::uint8_t> done(mesh.halfEdgeCount(), 0);
  for (const Index seed : halfEdges)
  {
    if (done[seed] == 0)
    {
      curves.push_back(curveThrough(mesh, seed, onwards, done).edges);
    }
  }
  return curves;
}

} // namespace quadrille
