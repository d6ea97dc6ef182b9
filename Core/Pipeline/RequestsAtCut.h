// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is asked of a surface that faces are cut out of: what is asked of the faces and what of the rest.
#pragma once

#include "Mesh/Surface.h"
#include "Mesh/SurfaceParts.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// opened: cut open round the faces; copied: see cutOpen; isOut: #F, of the faces. Valences at vertices of the cut are
/// asked of the faces, which share them; vertices there that are held are so where the rest has sectors like those.
void moveRequestsToSides(const std::vector<std::uint8_t>& isOut, const std::vector<Index>& copied,
  PreparedSurface& opened);

/// The curves of the whole that pass through the faces, and not only along their boundary, are those of the first part,
/// and the others of the second one. within: a point is so near to what it lies on.
void divideCurves(const PreparedSurface& whole, const std::vector<std::uint8_t>& isOut,
  double within, std::vector<ComponentPart>& parts);

} // namespace quadrille
