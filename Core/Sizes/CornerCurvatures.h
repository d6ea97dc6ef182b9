// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curvatures that are known of the input, at the corners and sides of the faces that it has become.
#pragma once

#include "Mesh/Surface.h"

#include <cmath>
#include <vector>

namespace quadrille
{

/// 1 over the unit of the mesh; NaN where it is not known.
struct CornerCurvatures
{
  std::vector<float>
    atCorner; ///< #H or empty: the surface's, in the face where the half-edge begins
  std::vector<float>
    along; ///< #H or empty: of the feature or boundary that the half-edge is part of

  bool isKnownAt(Index h) const { return !atCorner.empty() && !std::isnan(atCorner[h]); }
};

/// Linear between the corners of the triangles of the input; along their sides that of the side. Empty where
/// PreparedSurface::curvatures is.
CornerCurvatures cornerCurvatures(const PreparedSurface& surface, int threads);

} // namespace quadrille
