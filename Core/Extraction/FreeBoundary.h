// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Unit cells that a boundary off the isolines cuts: left out, or kept as polygons.
///
/// The isolines and the boundary together divide the surface into faces. A face that the boundary
/// does not touch is a quad. Any other is followed along its sides with the surface on the left:
/// along isolines as GridTracing does it, and where a line meets the boundary along the boundary,
/// until an isoline leads inwards again:
///
///      q4........x2 ___            a cell q1 q2 q3 q4 of which the boundary keeps
///      .     ___--                 q1, x1, x2, q4; x1 and x2 are the exact
///      . __x1  (boundary)          crossings of its sides with boundary edges
///      q1
#pragma once

#include "Extraction/Extraction.h"
#include "Extraction/GridTracing.h"

#include <vector>

namespace quadrille
{

/// What has become of the cells at a free boundary.
struct FreeBoundaryReport
{
  /// Polygons: cells without a simple polygon, or that could not be followed.
  std::size_t dropped = 0;
  /// Boundary loops inside of one cell, met by no isoline: one half-edge of each.
  std::vector<Index> loopsInCells;
};

/// Treats the cells that the boundary cuts, of a result that holds the whole ones. pointOf: the
/// point of each grid vertex (see assembleQuads).
///
/// Trimmed: whole cells with a boundary loop inside, which no isoline meets, go, too. Points where
/// only corners of quads touch are given to each fan as a copy of its own, so that the mesh is a
/// manifold and no whole cell is lost.
///
/// Polygons: for a map with det > 0 everywhere and whole transitions. The corners of a polygon are
/// grid vertices, crossings of isolines with boundary edges, boundary vertices on isolines, and of
/// the other boundary vertices those where the boundary bends by more than 30 degrees in space or a
/// feature ends, and those without which the polygon would be degenerate, cross itself or stay
/// more than a tenth of a quad away from the boundary [Douglas and Peucker 1973]. A whole cell with a boundary vertex
/// on a side becomes a polygon, too. A boundary loop inside of one cell stays covered by it. All
/// decisions are exact, but crossings are rounded to 2^-56 quads where it is asked whether a
/// polygon crosses itself. pointOf is completed.
FreeBoundaryReport treatFreeBoundary(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, BoundaryMode mode, std::vector<Index>& pointOf,
  ExtractionResult& result);

} // namespace quadrille
