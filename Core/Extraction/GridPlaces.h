// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where points of the map lie on the mesh.
#pragma once

#include "Extraction/GridVertices.h"
#include "Quads/SurfaceWalk.h"

namespace quadrille
{

/// Barycentric coordinates of a point in the chart of a face with area.
std::array<double, 3> weightsInFace(const ExactMap& map, Index face, FixedVec2 uv);

/// The place of a grid vertex; weights are exactly 0 and 1 on edges and vertices where they must be.
SurfacePoint placeOf(const ExactMap& map, const GridVertex& vertex);

} // namespace quadrille
