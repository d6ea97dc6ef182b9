// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Polygons to triangles, by ear clipping in the plane of the polygon.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Fills mesh.position (all input points), mesh.origin (input point ids), mesh.flags (explicit
/// features), sourcePolygon and sourcePoints of an empty surface, and counts triangulated and
/// degenerate polygons. Corners that repeat their predecessor are dropped before. The input's sizes
/// and ids must have been checked.
void triangulate(const SurfaceInput& input, PreparedSurface& surface);

} // namespace quadrille
