// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One check in place of all passes of the repair, for a surface that needs none.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Connects a surface whose corners are set and which orderSurface has put in order, where repairSurface would leave it
/// as it is, but for vertices with several fans: an oriented manifold without coincident boundary points, duplicate and
/// degenerate faces. Such vertices, as pieces of a surface have them along their borders, are split as there. Fills the
/// twins and counts the components then. False where something is to be repaired; twins mean nothing in that case.
/// Corners of a face differ. threads: 0: all; the result does not depend on it.
///
/// Half-edges are sorted by their edges in blocks of vertices that fit a second level cache. All but the third edge of
/// some faces, which is passed on, is in the block of the face's lowest vertex.
bool connectCleanSurface(PreparedSurface& surface, int threads);

} // namespace quadrille
