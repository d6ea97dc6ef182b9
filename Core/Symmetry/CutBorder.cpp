// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/CutBorder.h"

#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{

Mesh connectTriangles(const SurfaceInput& input)
{
  Mesh mesh;
  mesh.position = input.points;
  mesh.origin = input.polygonPoints;
  mesh.twin.assign(mesh.origin.size(), kInvalidIndex);
  mesh.flags.assign(mesh.origin.size(), 0);
  std::vector<std::array<Index, 3>> edges; // lower and upper end, half-edge
  edges.reserve(mesh.origin.size());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const auto [low, high] = std::minmax({ mesh.origin[h], mesh.target(h) });
    edges.push_back({ low, high, h });
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i)
  {
    const Index g = edges[i - 1][2], h = edges[i][2];
    const bool isSame = edges[i - 1][0] == edges[i][0] && edges[i - 1][1] == edges[i][1];
    if (isSame && mesh.origin[g] != mesh.origin[h])
    {
      mesh.twin.edit()[g] = h;
      mesh.twin.edit()[h] = g;
    }
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if ((input.featureEdges[Mesh::face(h)] & 1U << h % 3) != 0)
    {
      mesh.flags.edit()[h] |= kFeatureEdge | kRequestedFeature;
      if (mesh.twin[h] != kInvalidIndex)
      {
        mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge | kRequestedFeature;
      }
    }
  }
  return mesh;
}

std::vector<std::uint8_t> edgesInPlane(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  std::vector<std::uint8_t> inPlane(mesh.halfEdgeCount(), 0);
  const auto lies = [&](Index v) { return std::abs(plane.height(mesh.position[v])) <= tolerance; };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    inPlane[h] = mesh.isBoundary(h) && lies(mesh.origin[h]) && lies(mesh.target(h)) ? 1 : 0;
  }
  return inPlane;
}

std::vector<BorderChain> borderChains(const Mesh& cut, const std::vector<std::uint8_t>& side)
{
  std::vector<std::uint8_t> isDone(cut.halfEdgeCount(), 0), isLater(cut.halfEdgeCount(), 0);
  for (Index h = 0; h < cut.halfEdgeCount(); ++h)
  {
    if (side[h] != 0)
    {
      const Index next = nextOnBoundary(cut, h);
      isLater[next] = side[next] == side[h] ? 1 : 0;
    }
  }
  std::vector<BorderChain> chains;
  for (const bool open : { true, false })
  {
    for (Index first = 0; first < cut.halfEdgeCount(); ++first)
    {
      if (side[first] == 0 || isDone[first] != 0 || (open && isLater[first] != 0))
      {
        continue;
      }
      BorderChain& chain = chains.emplace_back();
      Index h = first;
      do
      {
        isDone[h] = 1;
        chain.edges.push_back(h);
        h = nextOnBoundary(cut, h);
      } while (side[h] == side[first] && h != first);
      chain.closed = h == first;
    }
  }
  return chains;
}

} // namespace quadrille
