// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Who is beside whom among elements. Half-edge 4e + i is side i of element e. Neighbours may be oriented against each
/// other, and more than two elements may share an edge.
#pragma once

#include "Export/ElementMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

class ElementEdges
{
public:
  /// Linear for bounded valence. Looks out for a stop. The mesh must outlive it and be valid.
  explicit ElementEdges(const ElementMesh& mesh);

  Index halfEdgeCount() const { return static_cast<Index>(twin_.size()); }
  Index start(Index h) const { return mesh_.corner(h / 4, h % 4); }
  Index end(Index h) const { return mesh_.corner(h / 4, h % 4 + 1); }
  Index otherEnd(Index h, Index node) const { return start(h) == node ? end(h) : start(h); }
  /// The same edge in the other element; kInvalidIndex where there is none, or more than one.
  Index twin(Index h) const { return twin_[h]; }
  bool isBoundary(Index h) const { return (kinds_[h] & kBoundary) != 0; }
  /// On a feature and not on the boundary. An edge of more than two elements counts as one.
  bool isFeature(Index h) const { return (kinds_[h] & kFeature) != 0; }
  /// Whether it is the lowest half-edge of its edge, so that each edge is visited once.
  bool isLowest(Index h) const { return (kinds_[h] & kLowestHalfEdge) != 0; }
  /// The other side of the same element at one end of h.
  Index otherSide(Index h, Index node) const;

private:
  static constexpr std::uint8_t kBoundary = 1, kFeature = 2, kLowestHalfEdge = 4;

  void joinRun(const Index* begin, const Index* end);

  const ElementMesh& mesh_;
  std::vector<Index> twin_;
  std::vector<std::uint8_t> kinds_;
};

} // namespace quadrille
