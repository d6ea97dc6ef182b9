// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Decimation in the metric of a seamless map: what remains is the Delaunay triangulation, constrained by
/// features and by the straight edges between kept vertices, of the vertices to keep (see LockedVertices.h).
#pragma once

#include "Integers/UvMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Removes every vertex that is not kept. Edges of the mesh between two kept vertices stay. All determinants stay
/// positive. A vertex that cannot go (its star touches itself) stays and is flagged in `keep`. Deterministic.
void decimateInUv(UvMesh& mesh, UvEditor& editor, std::vector<std::uint8_t>& keep);

} // namespace quadrille
