// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How many edges of quads a curve of the mesh, of features or of the boundary, has to get: as many as its length is
/// worth, and more where they would leave it, as four edges for a circle do.
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// #H: the edges of quads that each constrained half-edge is worth, the same on both sides; 0 for others. On a curve of
/// curvature k quads of edge length s, times the size there, get edges of sqrt(8 d s / k) at most, whose chords leave
/// the curve by d = 0.05 s.
/// edgeLength: s, in units of the mesh, > 0. smooth: #V flags or empty, vertices that curves are known to pass without
/// a corner; others have one where the edges there bend by more than 60 degrees.
std::vector<double> quadsAlongCurves(
  const Mesh& mesh, double edgeLength, const std::vector<std::uint8_t>& smooth = {});

} // namespace quadrille
