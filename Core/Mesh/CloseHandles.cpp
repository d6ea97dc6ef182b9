// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CloseHandles.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/HandleBasis.h"
#include "Mesh/HandleStubs.h"
#include "Mesh/LoopSearch.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <optional>

namespace quadrille
{

namespace
{

std::optional<LoopSearch::Loop> shortestNear(
  LoopSearch& search, const std::vector<Index>& place, double bound)
{
  std::optional<LoopSearch::Loop> best;
  for (const Index root : place)
  {
    if (std::optional<LoopSearch::Loop> loop = search.shortest(root, best ? best->length : bound))
    {
      best = std::move(loop);
    }
  }
  return best;
}

/// The half-edges from each vertex of the loop to the next one.
std::vector<Index> halfEdgesOf(const Mesh& mesh, const LoopSearch::Loop& loop)
{
  std::vector<Index> halfEdges;
  for (std::size_t i = 0; i < loop.arcs.size(); ++i)
  {
    const Index h = loop.arcs[i].halfEdge;
    halfEdges.push_back(mesh.origin[h] == loop.vertices[i] ? h : mesh.twin[h]);
  }
  return halfEdges;
}

} // namespace

std::vector<std::size_t> closeHandles(PreparedSurface& surface,
  const std::vector<std::vector<Index>>& places, double bound, double opening)
{
  // All loops are found first, as cuts change the surface; loops without a common vertex stay what they are.
  std::vector<std::vector<Index>> cuts;
  std::vector<std::size_t> closed;
  {
    LoopSearch search(surface.mesh, LoopSearch::kInnerEdges);
    HandleBasis basis(2 * search.handles());
    std::vector<std::uint8_t> used(surface.mesh.vertexCount(), 0);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      poll();
      const std::optional<LoopSearch::Loop> loop = shortestNear(search, places[i], bound);
      if (!loop ||
        std::any_of(
          loop->vertices.begin(), loop->vertices.end(), [&](Index v) { return used[v] != 0; }))
      {
        continue;
      }
      // Disjoint loops cross nowhere, so being new to the basis means that all cuts together leave the surface in one
      // piece.
      const LoopSearch::Class sum = search.classOf(*loop);
      if (basis.insert(sum, search.crossings(sum)))
      {
        cuts.push_back(halfEdgesOf(surface.mesh, *loop));
        closed.push_back(i);
        for (const Index v : loop->vertices)
        {
          used[v] = 1;
        }
      }
    }
  }
  const Index facesBefore = surface.mesh.faceCount();
  std::vector<std::pair<Index, double>> stubs; // a half-edge from the middle of each cap, its girth
  for (const std::vector<Index>& cut : cuts)
  {
    double girth = 0;
    for (const Index h : cut)
    {
      girth += surface.mesh.edgeVector(h).norm();
    }
    const Index first = surface.mesh.faceCount();
    cutAndClose(surface, cut);
    const Index second = first + static_cast<Index>(cut.size());
    stubs.push_back({ 3 * first + 2, girth });
    stubs.push_back({ 3 * second + 2, girth });
  }
  for (Index h = 3 * facesBefore; h < surface.mesh.halfEdgeCount(); h += 3)
  {
    surface.area += surface.mesh.edgeVector(h).cross(surface.mesh.edgeVector(h + 1)).norm() / 2;
  }
  for (const auto& [h, girth] : stubs)
  {
    poll();
    removeStub(surface, h, girth, opening);
  }
  if (!cuts.empty())
  {
    surface.repair.closedHandles += cuts.size();
    orderSurface(surface, 1);
    surface.hash = contentHash(surface.mesh, 1);
  }
  return closed;
}

} // namespace quadrille
