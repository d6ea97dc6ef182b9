// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Walks along the isolines of a map, and the corner-to-corner relation of its unit cells.
///
/// The walk from a port follows the line moved to its left by an infinitesimal amount. That line
/// meets no vertex of the mesh and never runs along an edge, so there are no special cases: a
/// vertex is to the left when its distance is > 0 and to the right otherwise, and the line leaves a
/// positive triangle through the one edge that goes from a right to a left vertex:
///
///              left
///              .  .
///    . . . . / . . \ . . . > moved line
///    -------/-------\------> isoline
///          /_________\  .
///       right      right
///
/// The moved line is inside the cell on its left, so walking one unit, turning left, walking one
/// unit, ... goes round this cell. Through an inverted or degenerate triangle the line goes on
/// across the other edge whose ends differ; the coordinate runs back in an inverted one and catches
/// up in a later positive one.
#pragma once

#include "Extraction/GridVertices.h"

#include <utility>

namespace quadrille
{

/// A walk on the moved line: the point to reach and the direction, in the chart of the current
/// face.
struct Walk
{
  Index face = kInvalidIndex;
  FixedVec2 target;
  int direction = 0;
  Index entry = kInvalidIndex; ///< half-edge of face that was crossed last; none at the start
};

/// Walks on from walk.face, which must contain the start and be positive, until the positive
/// triangle that contains the target. False when the line ends before (boundary, images that do not
/// match) or after maximumSteps triangles.
bool follow(const ExactMap& map, Walk& walk, std::size_t maximumSteps);

/// For each port the port at the other end of its side, that is, the next corner of the same cell.
struct CellCorners
{
  std::vector<Index> next;   ///< per port; kInvalidIndex where the line could not be followed
  std::vector<Index> vertex; ///< per port: the grid vertex it leaves
  /// Pairs of grid vertices that are one vertex of the unfolded map; none for a valid map.
  std::vector<std::pair<Index, Index>> merged;
  /// The lines of a tolerant run are so long that the map must be folded all over; then the lists
  /// above are not complete.
  bool exhausted = false;
};

/// Follows every port by one unit. tolerant: also looks for further copies of each port's vertex
/// behind folds. Parallel; the result does not depend on the number of threads.
CellCorners traceCells(const ExactMap& map, const GridVertices& grid, bool tolerant, int threads);

struct CellCentre
{
  Index face = kInvalidIndex;
  FixedVec2 uv; ///< in the chart of face
};

/// The centre of the cell to the left of a port; none where it cannot be reached.
std::optional<CellCentre> findCentre(
  const ExactMap& map, const Sector& sector, int direction, std::size_t maximumSteps);

} // namespace quadrille
