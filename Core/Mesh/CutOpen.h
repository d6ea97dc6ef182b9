// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mesh that is cut open along edges.
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Half-edges and faces stay what they are; those along cut edges are on the boundary then. A vertex whose faces hang
/// together no more stays with the fan of its lowest half-edge, and has a copy for each of the others. isCut: #H, alike
/// on both sides of an edge. Returns the vertices that the copies are of, which have the ids from the former #V on.
/// Linear.
std::vector<Index> cutOpen(Mesh& mesh, const std::vector<std::uint8_t>& isCut);

/// The same along all features, so that connected components are the faces between them.
std::vector<Index> cutOpenAtFeatures(Mesh& mesh);

} // namespace quadrille
