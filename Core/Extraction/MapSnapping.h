// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a floating-point integer-grid map of another program to an exact one on the fixed-point
/// grid.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct SnapOptions
{
  /// A feature or boundary edge is put on the nearest integer isoline when both ends are nearer
  /// than this; in quads, in [0, 0.5).
  double isolineTolerance = 1e-3;
};

struct SnapResult
{
  std::vector<FixedVec2> uv; ///< #H
  double largestMove = 0;    ///< in quads
  std::size_t snappedToFixedPoint =
    0;                          ///< vertices whose transitions do not compose to the identity
  std::size_t inconsistent = 0; ///< vertices whose transitions compose to a translation
};

/// Transitions are taken from the two images of each edge: the nearest quarter turn and the nearest
/// whole translation. Each vertex is then rounded once, in the chart of one corner, to the fixed
/// point of the transitions round it where these are not the identity, and copied to its other
/// corners exactly [Ebke et al. 2013, Section 4]. Afterwards the two images of every edge agree but
/// at the vertices counted as inconsistent.
/// uv: #H. Throws InvalidInput for a wrong size, a value that is not finite or one beyond 2^20.
SnapResult snapMap(
  const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options = {});

} // namespace quadrille
