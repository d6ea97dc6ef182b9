// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of the boundary that are images of each other, as those of a wedge that n copies of make a whole: quads fit
/// together there where both have the same number of edges.
#pragma once

#include "Mesh/Requests.h"

#include <vector>

namespace quadrille
{

struct Mesh;

/// The half-edges of the two parts, each in the order of the boundary, so against each other. A seam whose ends are not
/// joined by the boundary has none.
struct SeamEdges
{
  std::vector<Index> left, right;

  bool empty() const { return left.empty() || right.empty(); }
};

/// Per request its half-edges on this mesh, which may be a coarser level, or run the other way round.
std::vector<SeamEdges> findSeams(const Mesh& mesh, const std::vector<SeamRequest>& requests);

/// The boundary vertices nearest to all ends, ascending, each once. Empty where the mesh has no boundary.
std::vector<Index> seamVertices(const Mesh& mesh, const std::vector<SeamRequest>& requests);

/// Quarter turns of sectors (#H, see CrossFieldOptions::sectorTurns; may be empty) with those of seams: between their
/// ends the boundary runs straight, so that what lies on one side is the image of the other. Where a feature ends, or
/// a vertex has a single triangle, they are left as they are.
std::vector<int> seamSectors(
  const Mesh& mesh, const std::vector<SeamEdges>& seams, std::vector<int> sectorTurns);

} // namespace quadrille
