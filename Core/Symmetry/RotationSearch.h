// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The axis round which a surface, turned by one step of an order, is nearest to itself.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Symmetry/MirrorSearch.h"
#include "Symmetry/RotationAxis.h"

namespace quadrille
{

/// How far the surface turned by one step is from the surface. Of samples by area, and of up to 20,000 points.
MirrorDeviation rotationDeviation(
  const NearestTriangle& surface, const RotationAxis& axis, int order, int threads);

/// As findMirrorPlane, which see: axes through the centre of area, refined by place and direction. The first component
/// of the direction that is not small is positive. There is always one, which is as good as rotationDeviation tells.
/// order: at least 2.
RotationAxis findRotationAxis(const NearestTriangle& surface, int order, int threads);

} // namespace quadrille
