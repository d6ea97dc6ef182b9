// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes of vertices as phase 1 of the hierarchy has them (see Hierarchy/Hierarchy.h): of the mesh, and smaller ones on
/// components that are small.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// Factors on s.
struct VertexScales
{
  std::vector<float>
    scale; ///< #V; empty where no size is asked for and no component is small against s
  bool anySmallComponent = false; ///< else they are the sizes that are asked for
};

/// isConnected: known to be, so that a large mesh needs no look at its components.
VertexScales vertexScales(const Mesh& fine, double edgeLength, bool isConnected, int threads);

/// The vertices at which the mesh has smaller sizes than these, ascending.
std::vector<Index> smallerThan(const Mesh& fine, const std::vector<float>& sizes);

} // namespace quadrille
