// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What quads must have in common with the surface that they are of.
#pragma once

#include "Mesh/Topology.h"

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace quadrille
{

/// Shape of a graph of curves: what does not change when its edges are cut finer.
struct CurveGraph
{
  std::map<int, std::size_t> nodes; ///< number of vertices per degree other than 2
  long long cycles = 0;             ///< edges - vertices

  /// edges: pairs of vertices, below the number of vertices.
  CurveGraph(const std::vector<std::pair<Index, Index>>& edges, std::size_t vertices);
  bool operator==(const CurveGraph& other) const
  {
    return nodes == other.nodes && cycles == other.cycles;
  }
};

struct SurfaceShape
{
  TopologySummary topology;
  CurveGraph curves; ///< features and boundary
};

/// Parallel; the same for any number of threads.
SurfaceShape shapeOf(const Mesh& mesh, int threads);

} // namespace quadrille
