// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a floating-point integer-grid map of another program to an exact one on the fixed-point
/// grid.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct SnapOptions
{
  /// How far the values may be from what was meant, in quads, in [0, 0.02]; widens the tolerances.
  /// Single precision has 2^-24 times the largest value.
  double valueError = 0;
  /// #H, or empty: quarter turns from the chart of the half-edge's face to that of its twin's,
  /// modulo 4. Empty: taken from the images.
  std::vector<std::int8_t> matching;
  int threads = 0;
};

struct SnapResult
{
  std::vector<FixedVec2> uv;               ///< #H
  double largestMove = 0;                  ///< in quads; 0 for a map that was exact already
  Index largestMoveCorner = kInvalidIndex; ///< where; none when nothing moved
  std::size_t snappedToFixedPoint =
    0;                          ///< vertices whose transitions do not compose to the identity
  std::size_t inconsistent = 0; ///< vertices whose transitions compose to a translation
  Index inconsistentCorner = kInvalidIndex; ///< a corner of the first of them
};

/// A map on the grid whose edges fit exactly, by whole transitions, with its features and
/// boundaries on isolines, comes back bit for bit. For any other the transition over each edge is
/// the rotation under which its two images agree, with the nearest whole translation; where the
/// images are too short to tell, the rotation whose translation is nearest to whole. Each vertex is
/// then rounded once, in the chart of one corner, to the fixed point of the transitions round it
/// where these are not the identity, and copied to its other corners exactly [Ebke et al. 2013,
/// Section 4]. Afterwards the two images of every edge agree but at the vertices counted as
/// inconsistent. Linear; the result does not depend on the number of threads.
/// uv: #H. Throws InvalidInput for a wrong size, a value that is not finite or beyond 2^20, images
/// that no quarter turn and translation takes to each other within 0.1 quads, translations that are
/// not whole within 0.1, and a matching that is not opposite on the two sides of an edge or is not
/// that of the images.
SnapResult snapMap(
  const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options = {});

} // namespace quadrille
