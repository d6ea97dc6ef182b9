// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Guides along the principal curvature, where that is a direction.
#pragma once

#include <cstddef>

namespace quadrille
{

struct PreparedSurface;

/// Gives polygons without a guide one along the principal direction of the larger curvature over about `edgeLength`
/// (> 0), where the anisotropy |k1 - k2| / (|k1| + |k2|) is above `leastAnisotropy`, in [0, 1). The weight grows from
/// there to 1, and is less where the surface bends by less than a tenth of a radian over an edge, as noise has
/// directions, too. Returns how many polygons have got one.
std::size_t addCurvatureGuides(
  PreparedSurface& surface, double edgeLength, double leastAnisotropy, int threads);

} // namespace quadrille
