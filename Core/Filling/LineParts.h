// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Points that divide a line of quads, an edge on a feature or boundary, along its curve.
#pragma once

#include "Mesh/Mesh.h"
#include "Quads/QuadMesh.h"
#include "Quads/SurfaceWalk.h"

#include <vector>

namespace quadrille
{

/// Dividing the way along the curve of constrained edges into so many equal parts, from the line's first point on. Empty
/// where that way is not found, as from line.halfEdge on the curve forks before it comes to a point of the line.
std::vector<CurvePoint> partLine(
  const Mesh& mesh, const QuadMesh& quads, const QuadLine& line, std::size_t parts);

} // namespace quadrille
