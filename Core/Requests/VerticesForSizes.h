// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Vertices for the irregular ones that drawn sizes need.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// Vertices that the coarse level keeps where sizes are asked for at places: spread over each radius and over the reach
/// beyond it within which sizes pass to those around, off features and boundaries. More quads on one side than on the
/// other take irregular vertices between them, and those of the level are the only ones that can be irregular; on parts
/// with many features all that its budget has may lie on these. Ascending. edgeLength: s.
std::vector<Index> verticesForSizes(const PreparedSurface& surface, double edgeLength);

} // namespace quadrille
