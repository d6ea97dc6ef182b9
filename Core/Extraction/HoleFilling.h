// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small holes that folds of a map leave in its quad mesh.
#pragma once

#include "Extraction/Extraction.h"

namespace quadrille
{

/// Closes boundary loops of the quads that are not on the input's boundary, have an even number of
/// edges, at most 20, and can be cut into quads along their vertices without a second edge between
/// two points; of all ways the one with the best scaled Jacobians. Returns the number of loops
/// closed. Appends quads; points and lines stay.
std::size_t fillHoles(QuadMesh& quads);

} // namespace quadrille
