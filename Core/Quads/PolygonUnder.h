// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which polygon of the input is under a quad.
#pragma once

#include "Mesh/Surface.h"
#include "Quads/QuadMesh.h"

#include <cstddef>

namespace quadrille
{

/// The polygon of the input under the centre of quad q. surface: that the quads were made on.
inline Index polygonUnder(const PreparedSurface& surface, const QuadMesh& quads, std::size_t q)
{
  const Index face = quads.quadSourceFace[q];
  const std::array<double, 3>& weights = quads.quadSourceWeights[q];
  const bool isKnown = weights != std::array<double, 3>{};
  return isKnown && surface.isFlipped(face) ? surface.locate(face, weights).polygon
                                            : surface.sourcePolygon[face];
}

} // namespace quadrille
