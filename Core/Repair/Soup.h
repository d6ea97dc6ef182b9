// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The triangles of a surface that is none: as they are handed in, nothing merged, nothing turned round.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// Triangles may repeat, cross each other and have no common points.
struct Soup
{
  TriangleList triangles;     ///< points: all of the input
  std::vector<Index> polygon; ///< #triangles; the input's polygon
  std::size_t degenerate = 0; ///< polygons without three different corners, which have no triangle
  double area = 0;            ///< of all triangles
  double diagonal =
    0; ///< of the box round all points of triangles; of all points where there is no triangle
};

/// Polygons are triangulated. Without polygons the points alone are taken. Throws InvalidInput, naming the element, for
/// no point, ids out of range and coordinates that are not finite.
Soup soupOf(const SurfaceInput& input, int threads = 1);

} // namespace quadrille
