// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which of some edges end at a vertex, for networks of feature edges.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct EdgesAtVertices
{
  std::vector<Index> offset,
    incident; ///< those of v: incident[offset[v]] to incident[offset[v + 1] - 1]

  Index degree(Index v) const { return offset[v + 1] - offset[v]; }
  /// At a vertex of two edges the one that is not h.
  Index otherThan(Index h, Index v) const
  {
    const Index first = incident[offset[v]];
    return first == h ? incident[offset[v] + 1] : first;
  }
};

/// edges: half-edges, one of each edge. At a vertex they have the order in which they are given.
EdgesAtVertices edgesAtVertices(const Mesh& mesh, const std::vector<Index>& edges);

} // namespace quadrille
