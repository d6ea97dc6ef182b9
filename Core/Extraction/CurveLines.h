// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The grid vertices along features and boundaries, one after the other.
#pragma once

#include "Extraction/GridVertices.h"

#include <vector>

namespace quadrille
{

/// Two grid vertices that follow each other on a curve of constrained edges.
struct CurveLine
{
  Index a = 0, b = 0; ///< on a boundary in the direction of its half-edges, else ascending
  Index halfEdge = kInvalidIndex; ///< a constrained half-edge between them
  bool boundary = false;
  bool zero = false; ///< the curve turns back in between, so that a and b are copies of one vertex
};

/// Follows the curves themselves, so that folds beside them do not matter; each piece between two grid vertices comes
/// once. A curve ends where it forks.
std::vector<CurveLine> findCurveLines(const ExactMap& map, const GridVertices& grid);

} // namespace quadrille
