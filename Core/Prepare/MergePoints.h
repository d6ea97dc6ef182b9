// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Joins what an STL file or a split of normals has taken apart.
#pragma once

#include "Mesh/EdgeRuns.h"

namespace quadrille
{

/// Joins the ends of open edges (of one face) that lie at exactly the same place, and returns how many
/// vertices went. Solids that merely touch, and points that meet without an edge, stay apart. Faces can
/// have a vertex twice afterwards.
std::size_t mergeOpenEdges(Mesh& mesh, const EdgeRuns& runs);

} // namespace quadrille
