// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quads of a map with folds: outlines of cells without what folds add to them.
#pragma once

#include "Extraction/CurveLines.h"
#include "Extraction/GridTracing.h"

#include <array>
#include <vector>

namespace quadrille
{

struct FoldedCells
{
  std::vector<Index> root; ///< per grid vertex the one that stands for all its copies
  std::vector<std::array<Index, 4>>
    corners;                      ///< per quad: such grid vertices, counterclockwise on the surface
  std::vector<Index> port;        ///< per quad: a port of it, each of another quad
  std::size_t mergedVertices = 0; ///< grid vertices that are not their root
  std::size_t zippedSides = 0;    ///< pairs of sides that were closed on each other
  std::size_t cancelled = 0;      ///< quads that lay over others in the sheets of a fold
  std::size_t dropped = 0;        ///< outlines that are no quads
};

/// The outline of a cell is a closed walk on the four sides of a unit square. (1) Grid vertices that sides of length
/// zero, triangles without area or curves that turn back join are one vertex [Ebke et al. 2013, Section 5]. (2) A side
/// walked in an upright sheet and then the same side back in an inverted one are closed on each other like a zip, which
/// makes one vertex of both ends; where there is a choice, of the two that are nearest in space. What is left of the
/// outline goes round the square as often as the cell covers it: once for a quad, never for a fold that
/// lies within one cell, and twice or more only if the map winds round a point that is no grid vertex. (3) Of quads
/// over the same vertices as many are left as upright sheets are more than inverted ones, at most one.
FoldedCells findFoldedCells(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
  const std::vector<CurveLine>& curves);

} // namespace quadrille
