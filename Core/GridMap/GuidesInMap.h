// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether a map follows the guides that users have asked for. The field does, but a map that has to have other things
/// as well may be sheared against it.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"
#include "Requests/Guides.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Radians, on average over the area of a region.
constexpr double kFollowedAngle = 0.045;

/// How many regions, that is connected sets of guided faces, the isolines leave by more than that. guides: empty or #F;
/// uv: #H.
std::size_t unfollowedRegions(
  const Mesh& mesh, const std::vector<Guide>& guides, const std::vector<FixedVec2>& uv);

} // namespace quadrille
