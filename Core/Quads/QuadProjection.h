// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a surface near another one, as of a wrap, put onto that where they belong to it.
#pragma once

#include "Mesh/NearestTriangle.h"

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

struct QuadProjectionOptions
{
  double distance = 0; ///< points farther from the surface stay; in units of the points, > 0
  double angle =
    1.047197551; ///< points stay where the normals differ by more than this; radians, default 60 degrees
  int threads = 0; ///< 0: all
};

/// Counts of points; together they are all.
struct QuadProjectionReport
{
  std::size_t moved = 0;  ///< lie on the surface now
  std::size_t far = 0;    ///< stay, as the surface is farther than the distance
  std::size_t turned = 0; ///< stay, as the surface has another direction there
  std::size_t twoSided =
    0; ///< stay, as the quads have another side there, which would lie on the same place
  std::size_t kept = 0; ///< stay, as a quad would have become inverted
};

/// Sums of the normals of the quads round each point.
std::vector<Vector3> pointNormals(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads);

/// Two triangles a quad.
TriangleList halvesOf(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads);

/// Moves each point to the nearest place of the triangles, whose orientation does not count. No quad with a positive
/// scaled Jacobian gets one that is not: its points stay, as do those of the quads that this makes inverted in turn.
/// The result does not depend on the number of threads. Throws InvalidInput for options out of range.
QuadProjectionReport projectQuads(std::vector<Vector3>& points,
  const std::vector<std::array<Index, 4>>& quads, const NearestTriangle& surface,
  const QuadProjectionOptions& options);

} // namespace quadrille
