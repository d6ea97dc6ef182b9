// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Decimation in the metric of a seamless map: what remains is the Delaunay triangulation, constrained by
/// features and by the straight edges between locked vertices, of the vertices that need an integer position.
#pragma once

#include "GridMap/UvMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The vertices that stay, #V flags: `needed` ones, and where a component or a closed smooth curve has
/// none its vertex of lowest id.
std::vector<std::uint8_t> verticesToKeep(const Mesh& mesh, const std::vector<std::uint8_t>& needed);

/// Removes every vertex that is not kept. Edges of the mesh between two kept vertices stay. All determinants stay
/// positive. A vertex that cannot go (its star touches itself) stays and is flagged in `keep`. Deterministic.
void decimateInUv(UvMesh& mesh, UvEditor& editor, std::vector<std::uint8_t>& keep);

} // namespace quadrille
