// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places on a level of the hierarchy, carried to the finest mesh without a map: the log backwards on the level's
/// triangles laid out flat, star by star, as in [Lee et al. 1998], whose parametrization goes the other way.
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/Hierarchy.h"
#include "Quads/SurfaceWalk.h"

#include <array>
#include <vector>

namespace quadrille
{

/// places: on faces of `level`, which the rounds [0, rounds) of the log lead to. Returns the same on the finest mesh,
/// one each, without weights below 0. Where a star has no room for its vertex, a place goes to the triangle that it is
/// least far outside of. The result does not depend on the number of threads (0: all). Throws InvalidInput where the
/// level or the places are not of the log.
std::vector<SurfacePoint> carryPlaces(const Level& level, const DecimationLog& log,
  std::size_t rounds, const std::vector<SurfacePoint>& places, int threads,
  const ProgressCallback& progress);

} // namespace quadrille
