// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Edges that follow each other.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// Runs of these edges in their order, through vertices where two of them meet and no constrained edge, by the first
/// half-edge of each. halfEdges: one of each edge, none of them constrained.
std::vector<std::vector<Index>> curvesOfEdges(
  const Mesh& mesh, const std::vector<Index>& halfEdges);

} // namespace quadrille
