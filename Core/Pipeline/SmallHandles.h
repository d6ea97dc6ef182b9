// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles that are too short for quads, cut and closed on request.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Pipeline/SmallDetails.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Along the edges of the surface a loop may be so much longer than on the intermediate level, which lies inside of it.
constexpr double kLongerAlongEdges = 2;

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
