// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Compact pieces in place of pieces with long boundaries, as of faces that were dealt out at random.
#pragma once

#include "Convert/Pieces.h"
#include "Ranks/Spread.h"

#include <string>
#include <vector>

class vtkDataSetAttributes;
class vtkPolyData;

namespace quadrille
{

/// About how many points the piece has on its boundary, by a part of its edges; points at the same place count as one.
std::size_t estimatedBorder(const SpreadPiece& piece, bool byIds, double unit);

/// Sends each polygon, with its arrays, to the rank that has its part of a space-filling curve through the centres of
/// polygons; the parts have about the same number of them. Points at the same place, rounded to multiples of `unit`, or
/// with the same global id where `model` has these, become one. pieces: with the arrays of `model`; their SurfacePieces
/// go. Returns this rank's piece, or none where it gets no polygon. Collective.
std::vector<SpreadPiece> redistributeCells(const Ranks& ranks, std::vector<SpreadPiece> pieces,
  vtkPolyData* model, double unit, SpreadFigures& figures);

/// A tuple for each origin, as gatherArrays, of sources that all have the arrays of `model`: in its order, with those
/// active that are so there.
void gatherInModelsOrder(const std::vector<vtkDataSetAttributes*>& sources,
  const std::vector<TupleOrigin>& origins, vtkDataSetAttributes* model,
  vtkDataSetAttributes* target);

} // namespace quadrille
