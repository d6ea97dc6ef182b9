// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the ranks of a spread surface agree on: the arrays of its pieces, and the points that several pieces have.
#pragma once

#include "Ranks/Spread.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Gives all pieces the same arrays in the same order. Where a piece lacks one that others have, 0 stands for it (1 for
/// factors); arrays that differ in type or components, that have no name or cannot be sent are left behind. Both are
/// told. Returns the arrays without tuples. Collective.
vtkSmartPointer<vtkPolyData> agreeOnArrays(
  const Ranks& ranks, std::vector<SpreadPiece>& pieces, std::vector<std::string>& notices);

/// A number for a point that is the same on all pieces that have it: of its global id where the model has these, else
/// of its rounded place. Two of a billion places have the same one with a probability of three per cent; both then
/// stay, and where they were shared would be joined, which the filter would tell as a surface that is no manifold.
std::int64_t pointNumber(const SpreadPiece& piece, vtkIdType point, bool byIds, double unit);

/// numbers: of each piece. 1 where another piece, of any rank, has the number, too. A number is sent to the rank that
/// it names modulo their number, which answers, so that no rank gets all of them. Collective.
std::vector<std::vector<std::uint8_t>> findShared(
  const Ranks& ranks, const std::vector<std::vector<std::uint64_t>>& numbers);

/// The patch beside an edge that a thinned piece has in common with others.
struct BorderPatch
{
  Index triangle = kInvalidIndex;
  Index corner = 0; ///< the edge runs from this corner to the next one
  std::int64_t patch = 0;
};

/// Of the edges of the piece's level between points of piece.kept that one polygon only has; nothing where the piece
/// has no patch array.
std::vector<BorderPatch> borderPatches(const SpreadPiece& piece);

/// Makes edges between two patches features of the joined surface. patches: of each piece.
void markPatchBorders(const std::vector<std::vector<BorderPatch>>& patches, JoinedPieces& joined);

} // namespace quadrille
