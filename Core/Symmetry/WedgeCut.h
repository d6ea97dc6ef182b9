// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One of n wedges of a surface round an axis.
#pragma once

#include "Symmetry/PlaneCut.h"

#include <optional>

namespace quadrille
{

/// How far places on one side of a wedge may be from images of those on the other side, in units of the mesh.
struct WedgeReach
{
  double ofCuts = 0;     ///< ends and middles of what a half plane cuts
  double ofFeatures = 0; ///< where features end; those without an image end on one side only
};

/// The first half plane of the wedge is at startAngle. None: half planes are tried in the order of the length of the
/// cut, the shortest first, until wedges fit together and no feature ends on one side only; else the one with the
/// fewest of these is taken. Where no wedges fit together, the mismatch of the first one is told. Points that are no
/// farther from a half plane than `tolerance` (units of the mesh) are put into it.
SurfacePart cutWedge(const Mesh& mesh, const Isometry& rotation, double tolerance,
  const WedgeReach& reach, std::optional<double> startAngle = std::nullopt);

} // namespace quadrille
