// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where isolines meet the boundary of the mesh.
#pragma once

#include "Extraction/GridVertices.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// A crossing of an isoline with a boundary edge is told to 2^-56 quads where polygons are compared.
constexpr std::int64_t kFine = std::int64_t{ 1 } << 32;

/// Number of axis directions from the right side of corner h on, before its left side.
int axesInCorner(const ExactMap& map, Index h);

/// The most counterclockwise direction of an isoline through the vertex of corner h in its sector.
std::optional<int> lastIsoline(const ExactMap& map, Index h);

/// A place on the boundary where an isoline meets it.
struct BoundaryNode
{
  Index h = kInvalidIndex;          ///< boundary half-edge
  Index gridVertex = kInvalidIndex; ///< when it is an integer point
  FixedVec2 uv;   ///< in the chart of h; the coordinate along a crossing isoline is rounded down
  FixedVec2 fine; ///< what is left of it, in units of 1 / kFine of the fixed-point grid
  std::int64_t numerator = 0;   ///< place on h as a fraction, 0 at the origin
  std::int64_t denominator = 1; ///< > 0
  bool onU = false;             ///< lies on an isoline u = const, in the chart of h
  bool onV = false;

  bool atOrigin() const { return numerator == 0; }
  double place() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// All boundary half-edges with their nodes in order; the origin of a half-edge belongs to it.
class Boundary
{
public:
  Boundary(const ExactMap& map, const GridVertices& grid);

  const std::vector<Index>& halfEdges() const { return halfEdges_; }
  const std::vector<BoundaryNode>& nodes() const { return nodes_; }
  Index firstNode(Index h) const { return first_[rank_[h]]; }
  Index lastNode(Index h) const { return first_[rank_[h] + 1]; } ///< one past
  /// The boundary half-edge that leaves vertex v; none inside.
  Index leaving(Index v) const { return leaving_[v]; }

  /// The node at the origin of boundary half-edge h, if an isoline meets it there.
  std::optional<Index> nodeAtOrigin(Index h) const;

  /// The node where a line with this target and direction, in the chart of h, crosses h.
  std::optional<Index> nodeOnLine(Index h, FixedVec2 target, int direction) const;

  /// The boundary half-edge that ends where h begins.
  Index before(Index h) const;

private:
  /// The vertex is a node where an isoline leaves it into the surface, or came along the boundary.
  void addOrigin(Index h);

  /// The isolines of one axis across h, each strictly inside of it.
  void addAxis(Index h, bool u, std::vector<BoundaryNode>& list) const;

  void addCrossings(Index h);

  const ExactMap& map_;
  const GridVertices& grid_;
  std::vector<Index> rank_;    ///< per half-edge, in halfEdges_
  std::vector<Index> leaving_; ///< per vertex
  std::vector<Index> halfEdges_;
  std::vector<Index> first_;
  std::vector<BoundaryNode> nodes_;
};

using BoundaryLoop = std::vector<Index>;

/// The boundary loops that no isoline meets.
std::vector<BoundaryLoop> loopsWithoutNodes(const ExactMap& map, const Boundary& boundary);

/// The transition from the chart of each half-edge of a boundary loop to that of the first; false
/// where the loop does not close in one chart.
bool developLoop(const ExactMap& map, const BoundaryLoop& loop, std::vector<Transition>& toFirst);

} // namespace quadrille
