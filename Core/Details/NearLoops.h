// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Short loops round handles, or through them, near places that are known.
#pragma once

#include "Details/LoopNeighbourhood.h"
#include "Details/LoopSearch.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// Searches a surface near some places, on the part of it where the loops run if that is small.
class NearLoops
{
public:
  /// places: vertices near a handle, a few each. bound: loops are shorter, in units of the mesh (> 0). threads: 0: all.
  NearLoops(const Mesh& mesh, const std::vector<std::vector<Index>>& places, double bound,
    LoopSearch::Moves moves, int threads);

  /// The shortest loop below the bound that meets a vertex of the place; in terms of what is searched.
  std::optional<LoopSearch::Loop> shortestNear(const std::vector<Index>& place);
  const LoopSearch& search() const { return search_; }
  /// The same loop in vertices and half-edges of the surface.
  LoopSearch::Loop onSurface(LoopSearch::Loop loop) const;

private:
  std::optional<LoopNeighbourhood> part_;
  LoopSearch search_;
  double bound_;
};

/// For each of the places the length of the shortest loop near it that is below the bound, along edges and straight
/// across pairs of triangles, in units of the mesh; 0 where there is none. Nothing where what would have to be searched
/// is no small part of the surface.
std::optional<std::vector<double>> lengthsNear(
  const Mesh& mesh, const std::vector<std::vector<Index>>& places, double bound, int threads);

} // namespace quadrille
