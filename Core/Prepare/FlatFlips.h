// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Flat parts of a surface in other triangles. A part of CAD has a plane with holes as long needles between them;
/// halved again and again these are a hundred times as many triangles, in which no map has room. The triangles are not
/// the shape: where several lie in a plane, others in it are the same surface.
#pragma once

#include "Mesh/Surface.h"
#include "Mesh/SurfaceEdit.h"

#include <memory>
#include <vector>

namespace quadrille
{

/// Delaunay flips of edges that are flat [Lawson 1977]: not constrained, and with both diagonals of the two faces at
/// one place, but for what single precision leaves of the coordinates (four of its roundings, at the length of the
/// diagonal of the bounding box). What is asked of polygons has no part in it, as the surface is kept for other
/// requests: where a flipped face comes from several polygons, the one under its centroid counts.
class FlatFlips
{
public:
  /// edges: one half-edge each, those that may be flipped to begin with. Where none of them is flat, nothing ever is,
  /// and nothing is kept.
  FlatFlips(PreparedSurface& surface, const std::vector<Index>& edges);

  bool any() const { return before_ != nullptr; }

  /// Flips `edges`, and those that this makes flippable, until none is left; calls changed(h) for each edge that got
  /// another name or another place.
  template <typename Changed>
  void flip(std::vector<Index> edges, const Changed& changed)
  {
    while (any() && !edges.empty())
    {
      const Index h = edges.back();
      edges.pop_back();
      if (!isFlippable(h))
      {
        continue;
      }
      const Index g = surface_.mesh.twin[h];
      flipFlat(surface_, h, level_);
      changed(Mesh::next(h));
      for (const Index side : { h, Mesh::previous(h), g, Mesh::previous(g) })
      {
        changed(side);
        edges.push_back(side);
      }
    }
  }

  /// Sets the sources of the faces that were flipped. To be called once, before the surface is ordered.
  void finish();

private:
  bool isFlat(Index h) const;
  bool isFlippable(Index h) const;

  PreparedSurface& surface_;
  double tolerance_;
  Index level_;
  std::unique_ptr<PreparedSurface> before_; ///< null where nothing is flat
};

} // namespace quadrille
