// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way round one face into which the isolines and the boundary divide the surface.
#pragma once

#include "Extraction/BoundaryNodes.h"

#include <optional>
#include <vector>

namespace quadrille
{

enum class StopKind : std::uint8_t
{
  Grid,   ///< id: grid vertex
  Node,   ///< id: boundary node that is no grid vertex
  Vertex, ///< id: the boundary half-edge that leaves the boundary vertex; may be left out
};

struct Stop
{
  StopKind kind;
  Index id;
  FixedVec2 uv;              ///< in the chart where the trace began
  Index via = kInvalidIndex; ///< the constrained half-edge along which the way goes on, if any
  FixedVec2 fine{};          ///< see BoundaryNode

  bool isSame(const Stop& other) const { return kind == other.kind && id == other.id; }
};

/// Where a chart lies against the one of the start.
struct Place
{
  Index face = kInvalidIndex;
  Transition toStart;
};

/// A side of a cell: a walk along the line moved to its left (see GridTracing.h).
struct Side
{
  Place place;
  FixedVec2 target;
  int direction = 0;
  std::int64_t length = 0; ///< from the beginning to the target, or more where nothing lies before
  std::int64_t noted = 0;  ///< distance to the target of the last vertex that was noted
  Index hit = kInvalidIndex; ///< the boundary half-edge where it ends before the target
  bool arrived = false;      ///< at the target
};

/// A way along the sides of one face, the surface on the left.
class FaceTrace
{
public:
  FaceTrace(const ExactMap& map, const GridVertices& grid, const Boundary& boundary);

  std::vector<Stop> stops;
  std::vector<Index> startedAt; ///< nodes from which the way followed the boundary

  /// From a boundary node along the boundary, back to it.
  bool fromNode(Index first);

  /// From a port, round a cell that is whole.
  bool fromPort(const Sector& sector, int direction);

  /// The side from an exact point in the closed face, which is on the left of its beginning.
  Side sideFrom(const Place& place, FixedVec2 from, int direction) const;

  /// Walks to the target or the boundary; false where neither is reached.
  bool followSide(Side& side, bool noteVertices = true);

private:
  /// Crosses half-edge h of the place's face.
  void cross(Place& place, Index h, const Transition& t) const;

  void addStop(const Stop& stop);

  void closeUp();

  Stop stopAt(Index node, const Place& place, Index via) const;

  // ---------------------------------------------------------------- along isolines

  /// Notes the grid vertex at the target and turns into the next side.
  bool turnLeft(Side& side);

  bool followSidesToBoundary(Side& side);

  /// The node where the side has met the boundary.
  std::optional<Index> nodeHit(const Side& side) const;

  /// Boundary vertices on the line, which the faces on its other side have as corners.
  void noteVerticesOn(Side& side);

  void noteVertex(const Side& side, Index corner);

  /// Does the boundary run straight along an isoline at the origin of boundary half-edge out?
  bool isStraight(Index out) const;

  // ---------------------------------------------------------------- along the boundary

  /// From a node along the boundary until an isoline leads inwards: the side there.
  bool followBoundary(Place& place, Index node, Side& side);

  bool turnClockwise(Place& place, Index& corner) const;

  /// The isoline that leads inwards from a node inside a boundary half-edge.
  void startInside(const Place& place, Index node, Side& side);

  /// The first isoline clockwise from the boundary that arrives at a vertex.
  bool startAtVertex(Place& place, Index corner, Index out, Side& side);

  const ExactMap& map_;
  const GridVertices& grid_;
  const Boundary& boundary_;
  std::size_t stepLimit_;
};

} // namespace quadrille
