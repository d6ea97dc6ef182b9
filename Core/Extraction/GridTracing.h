// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Walks along the isolines of a map, and the corner-to-corner relation of its unit cells.
///
/// A walk follows an isoline moved into one of the cells beside it by an infinitesimal amount. That line
/// meets no vertex of the mesh and never runs along an edge, so there are no special cases: a
/// vertex is inside when its distance is > 0 and outside otherwise. On the surface the walk has the inside to its
/// left; it leaves a triangle, of either orientation, through the one half-edge that goes from an outer to an inner
/// vertex:
///
///              inner
///              .  .
///    . . . . / . . \ . . . > moved line
///    -------/-------\------> isoline
///          /_________\  .
///       outer      outer
///
/// The moved lines of a cell are the sides of a square a little smaller than it. Walking to the end of a side, turning
/// left, ... goes round the preimage of its outline. In an inverted triangle the same line is walked the other way
/// round, towards the corner where it came from: a walk that a fold has turned back ends at another copy of the corner
/// where it began, in a sheet of the other orientation. Such a side has length zero [Ebke et al. 2013]. The image of a
/// triangle without area is crossed at one point.
///
/// As the preimage of a closed curve that meets no vertex consists of closed curves, every walk ends and each
/// corner is the end of one walk only, but where two images of an edge do not match or a boundary crosses the isoline.
#pragma once

#include "Extraction/GridVertices.h"

#include <utility>

namespace quadrille
{

/// A walk on a moved line, in the chart of the current face.
struct Walk
{
  Index face = kInvalidIndex;
  FixedVec2 origin; ///< the ends of the side, on the isoline
  FixedVec2 target; ///< the one ahead
  int direction = 0;
  int orientation = 1; ///< of the last face with area

  /// Axis from the isoline to the inside.
  int inside() const { return direction + orientation; }
  /// The port that is the corner at the target.
  int arrivalPort() const { return orientation > 0 ? direction + 1 : direction + 2; }
};

/// The side that starts at the port of the sector with this direction.
Walk startOf(const Sector& sector, int direction);

/// The half-edge of the walk's face through which the moved line leaves it.
inline Index exitEdge(const ExactMap& map, const Walk& walk)
{
  const Index h = 3 * walk.face;
  const int axis = walk.inside();
  const std::int64_t isoline = along(walk.target, axis);
  const std::array<bool, 3> inner{ along(map.at(h), axis) > isoline,
    along(map.at(h + 1), axis) > isoline, along(map.at(h + 2), axis) > isoline };
  for (Index i = 0; i < 3; ++i)
  {
    if (!inner[i] && inner[(i + 1) % 3])
    {
      return h + i;
    }
  }
  return kInvalidIndex;
}

/// Does the corner at the target lie before that half-edge h?
inline bool isBefore(const ExactMap& map, const Walk& walk, Index h)
{
  const int side = walk.orientation * orientation(map.at(h), map.at(Mesh::next(h)), walk.target);
  if (side != 0)
  {
    return side > 0;
  }
  // The edge's line passes through the target. In an inverted triangle the corner is e before it and e^2 inside of the
  // isoline, and the edge crosses the isoline. Otherwise it is e inside and e^2 before it.
  return walk.orientation < 0 || along(map.edge(h), walk.direction) >= 0;
}

/// For each port the port at the other end of its side, that is, the next corner of the same cell with the cell to the
/// left on the surface.
struct CellCorners
{
  std::vector<Index> next;   ///< per port; kInvalidIndex where the line has no end
  std::vector<Index> vertex; ///< per port: the grid vertex it leaves
  std::vector<std::int8_t>
    orientation; ///< per port: of its triangle's image; empty when all are positive
  /// Pairs of grid vertices that are one vertex of the unfolded map; none for a valid map.
  std::vector<std::pair<Index, Index>> merged;
  std::size_t zeroSides = 0; ///< sides of length zero
  /// The walks together crossed more than maximumSteps triangles; the lists above are not complete. Walks wind round
  /// the surface where transitions are not whole.
  bool exhausted = false;

  /// Does the side lead back to a copy of its own grid vertex?
  bool isZero(Index port) const
  {
    return !orientation.empty() && orientation[port] != orientation[next[port]];
  }
};

struct TracingOptions
{
  bool folded =
    false; ///< triangles may be inverted or without area; otherwise all must be positive
  /// No triangle, edge or transition has a defect: both cells beside a side are known from one walk.
  bool valid = false;
  std::size_t maximumSteps = 0; ///< triangles that the walks may cross together
  int threads = 0;
};

/// The ports of the four corners of the cell of a port, from it on; false where it is not whole. isLowest: nor where
/// the port is not the lowest one.
bool cellOf(const CellCorners& cells, Index port, bool isLowest, std::array<Index, 4>& ports);

/// Follows every port to the end of its side. Linear in the triangles that lines cross; parallel; the result does not
/// depend on the number of threads.
CellCorners traceCells(
  const ExactMap& map, const GridVertices& grid, const TracingOptions& options);

struct CellCentre
{
  Index face = kInvalidIndex;
  FixedVec2 uv; ///< in the chart of face
};

/// The centre of the cell of a port; none where it cannot be reached.
std::optional<CellCentre> findCentre(
  const ExactMap& map, const Sector& sector, int direction, bool folded, std::size_t maximumSteps);

} // namespace quadrille
