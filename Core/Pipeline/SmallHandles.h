// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles that are too short for quads, cut and closed on request.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Options.h"

#include <string>

namespace quadrille
{

struct ClosedHandles
{
  std::string notice;
  int decimations = 0; ///< runs of phase 1
};

/// Handles that are shorter round, or through, than options.closeHandles edge lengths are found on the intermediate
/// level and cut on the surface, until there is no shorter one, see closeHandles. The surface is refined afterwards.
ClosedHandles closeSmallHandles(
  PreparedSurface& surface, double edgeLength, const RemeshOptions& options);

} // namespace quadrille
