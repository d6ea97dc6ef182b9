// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Cells that the boundary cuts, as polygons.
#pragma once

#include "Extraction/FreeBoundary.h"

#include <array>
#include <optional>
#include <set>
#include <vector>

namespace quadrille
{

/// See treatFreeBoundary().
FreeBoundaryReport addPartialCells(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, std::vector<Index>& pointOf, QuadMesh& mesh);

/// The ports of the four corners of the cell of a port, lowest first; none where it is not whole.
std::optional<std::array<Index, 4>> wholeCell(const CellCorners& cells, Index port);

/// The points of a quad, ascending.
using PointSet = std::array<Index, 4>;

PointSet sortedPoints(PointSet points);

/// Takes quads away by their points. Returns their number.
std::size_t removeQuads(const std::set<PointSet>& removed, QuadMesh& mesh);

PointSet pointsOf(
  const CellCorners& cells, const std::array<Index, 4>& ports, const std::vector<Index>& pointOf);

} // namespace quadrille
