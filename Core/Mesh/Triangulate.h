// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Polygons to triangles, by ear clipping in the plane of the polygon.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Fills mesh.origin (input point ids), mesh.flags (explicit features), sourcePolygon and sourcePoints of an empty
/// surface, whose mesh.position is left to the caller, and counts triangulated and degenerate polygons. Corners that
/// repeat their predecessor are dropped before. The input's sizes and ids must have been checked. threads: 0: all.
void triangulate(const SurfaceInput& input, PreparedSurface& surface, int threads = 1);

} // namespace quadrille
