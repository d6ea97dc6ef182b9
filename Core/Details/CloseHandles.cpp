// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/CloseHandles.h"

#include "Base/Progress.h"
#include "Details/HandleBasis.h"
#include "Details/HandleStubs.h"
#include "Details/NearLoops.h"
#include "Mesh/ContentHash.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <optional>

namespace quadrille
{

namespace
{

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

/// Where a loop leads along an edge and back, as at the rim of a wall that has no thickness there, its cap has no area,
/// and both sides of it would be features on each other: one side stays. first: of the fan of the cap.
void openFlatCap(Mesh& mesh, Index first, Index count, double girth)
{
  const auto corner = [&](Index i) -> const Vector3&
  { return mesh.position[mesh.origin[3 * (first + i) + 1]]; };
  double area = 0;
  Index begin = 0, end = 0;
  for (Index i = 0; i < count; ++i)
  {
    area += mesh.faceArea(first + i);
    begin = (corner(i) - corner(0)).norm() > (corner(begin) - corner(0)).norm() ? i : begin;
  }
  for (Index i = 0; i < count; ++i)
  {
    const double apart = (corner(i) - corner(begin)).norm();
    end = apart > (corner(end) - corner(begin)).norm() ? i : end;
  }
  if (area > kRounding * girth * girth)
  {
    return;
  }
  for (Index i = begin; i != end; i = (i + 1) % count)
  {
    const Index rim = 3 * (first + i);
    mesh.flags.edit()[rim] = 0;
    mesh.flags.edit()[mesh.twin[rim]] = 0;
  }
}

} // namespace

std::vector<std::size_t> closeHandles(PreparedSurface& surface,
  const std::vector<std::vector<Index>>& places, double bound, double opening, int threads)
{
  // All loops are found first, as cuts change the surface; loops without a common vertex stay what they are.
  std::vector<std::vector<Index>> cuts;
  std::vector<std::size_t> closed;
  {
    NearLoops near(surface.mesh, places, bound, LoopSearch::kInnerEdges, threads);
    HandleBasis basis(2 * near.search().handles());
    std::vector<std::uint8_t> used(surface.mesh.vertexCount(), 0);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      poll();
      const std::optional<LoopSearch::Loop> found = near.shortestNear(places[i]);
      if (!found)
      {
        continue;
      }
      const LoopSearch::Loop loop = near.onSurface(*found);
      if (std::any_of(
            loop.vertices.begin(), loop.vertices.end(), [&](Index v) { return used[v] != 0; }))
      {
        continue;
      }
      // Disjoint loops cross nowhere, so being new to the basis means that all cuts together leave the surface in one
      // piece.
      const LoopSearch::Class sum = near.search().classOf(*found);
      if (basis.insert(sum, near.search().crossings(sum)))
      {
        cuts.push_back(halfEdgesOf(surface.mesh, loop));
        closed.push_back(i);
        for (const Index v : loop.vertices)
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
    for (const Index cap : { first, second })
    {
      openFlatCap(surface.mesh, cap, static_cast<Index>(cut.size()), girth);
    }
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
    orderSurface(surface, threads);
    surface.hash = contentHash(surface.mesh, threads);
  }
  return closed;
}

} // namespace quadrille
