// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles that are too short for quads, cut and closed on request.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Pipeline/SmallDetails.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Along the edges of the surface a loop may be so much longer than on the intermediate level, which lies inside of it.
constexpr double kLongerAlongEdges = 2;
/// What is left of a handle that was cut, and is longer round than so many edge lengths, is no stub but a limb that
/// quads show: the jaw of a skull hangs on two joints, and both may be handles below the limit.
constexpr double kGirthOfLimb = 4.5;

/// Vertices of the level on the finest mesh.
std::vector<Index> onFinest(const std::vector<Index>& vertices, const Level& level);

struct ClosedHandles
{
  std::string notice;
  std::vector<SmallDetail> details; ///< those that were closed
  int decimations = 0;              ///< runs of phase 1
};

/// Handles that are shorter round, or through, than options.closeHandles edge lengths are found on the intermediate
/// level and cut on the surface, until there is no shorter one, see closeHandles. The surface is refined afterwards.
ClosedHandles closeSmallHandles(
  PreparedSurface& surface, double edgeLength, const RemeshOptions& options);

} // namespace quadrille
