// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of the boundary that are one straight side of the map: no corner and no irregular vertex lies on them. Such a
/// side can be moved by half a quad without turning anything, see GridMap/RelaxMap.h.
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"

#include <vector>

namespace quadrille
{

/// The half-edges of each request on this mesh, maybe a coarser level, or one that runs the other way round, in the
/// order of the boundary. None where the boundary does not join the ends.
std::vector<std::vector<Index>> findStraightParts(
  const Mesh& mesh, const std::vector<StraightRequest>& requests);

/// The boundary vertices at all three places of the requests, ascending, each once.
std::vector<Index> straightVertices(const Mesh& mesh, const std::vector<StraightRequest>& requests);

struct OutsetMesh
{
  Mesh mesh;
  std::vector<StraightRequest> requests; ///< with the places that their vertices have in it
};
/// The mesh with the vertices of parts moved outward by `length`, times the size there: what a map sees of a surface
/// that goes on so far, and will lose a strip of that width again.
OutsetMesh withOutset(Mesh mesh, const std::vector<StraightRequest>& requests, double length);

/// Quarter turns of sectors (#H, see CrossFieldOptions::sectorTurns; may be empty) with those of straight parts: two in
/// all at a vertex inside a part, one at its ends. Vertices where features leave fewer turns than they need are left as
/// they are.
std::vector<int> straightSectors(
  const Mesh& mesh, const std::vector<std::vector<Index>>& parts, std::vector<int> sectorTurns);

} // namespace quadrille
