// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Edges that follow each other.
#pragma once

#include "Mesh/Mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

struct CurveOfEdges
{
  std::vector<Index> edges;    ///< in their order
  std::array<Index, 2> ends{}; ///< vertices; of a closed one where it was begun
};

/// The curve of an edge. onwards(edge, vertex): the next edge beyond the vertex, kInvalidIndex where there is none.
/// done: #H flags of edges that are in curves; also ends it, and gets those of this one.
template <typename Onwards>
CurveOfEdges curveThrough(
  const Mesh& mesh, Index seed, const Onwards& onwards, std::vector<std::uint8_t>& done)
{
  CurveOfEdges curve;
  done[seed] = 1;
  std::array<std::vector<Index>, 2> ways;
  for (std::size_t side = 0; side < 2; ++side)
  {
    Index h = seed;
    Index v = side == 0 ? mesh.origin[seed] : mesh.target(seed);
    for (Index next = onwards(h, v); next != kInvalidIndex && done[next] == 0; next = onwards(h, v))
    {
      done[next] = 1;
      ways[side].push_back(next);
      h = next;
      v = mesh.otherEnd(h, v);
    }
    curve.ends[side] = v;
  }
  curve.edges.assign(ways[0].rbegin(), ways[0].rend());
  curve.edges.push_back(seed);
  curve.edges.insert(curve.edges.end(), ways[1].begin(), ways[1].end());
  return curve;
}

/// Runs of these edges in their order, through vertices where two of them meet and no constrained edge, by the first
/// half-edge of each. halfEdges: one of each edge, none of them constrained.
std::vector<std::vector<Index>> curvesOfEdges(
  const Mesh& mesh, const std::vector<Index>& halfEdges);

} // namespace quadrille
