// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The border of a part of a surface, on its triangles as they are given.
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Surface.h"
#include "Symmetry/Isometry.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Twins by the ids of points; featureEdges become requested features. Half-edge h begins at corner h.
Mesh connectTriangles(const SurfaceInput& input);

/// Per half-edge (#H), whether it is a boundary with both ends within `tolerance` of the plane.
std::vector<std::uint8_t> edgesInPlane(
  const Mesh& mesh, const MirrorPlane& plane, double tolerance);

/// A run of the boundary in one of the planes of a cut.
struct BorderChain
{
  std::vector<Index> edges; ///< half-edges, in the order of the boundary
  bool closed = false;

  /// Of place i along the chain; of an open one the last is at the end of its edges.
  Index vertex(const Mesh& cut, std::size_t i) const
  {
    const std::size_t count = edges.size();
    return i < count ? cut.origin[edges[i]] : cut.target(edges[count - 1]);
  }
  const Vector3& place(const Mesh& cut, std::size_t i) const
  {
    return cut.position[vertex(cut, i)];
  }
};

/// Runs of edges of the boundary with the same number in side (#H; 0: in no plane). Open ones come first, then closed
/// ones; of each kind as their first half-edges come, with closed ones those are the lowest.
std::vector<BorderChain> borderChains(const Mesh& cut, const std::vector<std::uint8_t>& side);

} // namespace quadrille
