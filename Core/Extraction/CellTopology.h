// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connectivity of a mesh of quads and polygons.
#pragma once

#include "Extraction/Extraction.h"
#include "Quads/QuadTopology.h"

namespace quadrille
{

/// As analyzeQuads, for the quads and the polygons together; a half-edge that is not unique counts
/// as non-manifold. twin stays empty. Linear for bounded valence. Throws InvalidInput for a corner
/// beyond the points.
QuadTopology analyzeCells(const QuadMesh& mesh);

/// Whether a line is an edge of a cell, per line.
std::vector<std::uint8_t> linesOnEdges(const QuadMesh& mesh);

} // namespace quadrille
