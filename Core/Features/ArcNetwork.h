// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The constrained edges of a mesh as a network of curves.
#pragma once

#include "Base/Progress.h"
#include "Features/EdgesAtVertices.h"
#include "Mesh/Mesh.h"

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

/// A curve between two nodes.
struct NetworkArc
{
  std::vector<Index> halfEdges; ///< one of each edge, in their order
  std::array<Index, 2> ends{};  ///< nodes
  double length = 0;            ///< in edge lengths of the quads there
  bool removable = true;
};

/// Constrained edges as arcs between nodes. Closed curves without nodes are none.
class ArcNetwork
{
public:
  ArcNetwork(const Mesh& mesh, double edgeLength);

  const std::vector<NetworkArc>& arcs() const { return arcs_; }
  /// Arcs that end at a node; one that does so with both ends is there twice.
  std::vector<Index> arcsAt(Index node) const;

  /// Whether two arcs that end at a node make one curve that goes straight on there.
  bool goStraightOn(Index node, Index a, Index b) const;

private:
  void traceAll();

  void trace(Index start, Index h);

  /// Direction from a node along an arc, over half an edge length.
  Vector3 courseFrom(Index node, const NetworkArc& arc) const;

  const Mesh& mesh_;
  double edgeLength_;
  std::vector<Index> edges_;
  EdgesAtVertices at_;
  std::vector<Index> arcOf_; ///< #H, of one half-edge of each edge
  std::vector<NetworkArc> arcs_;
};

} // namespace quadrille
