// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Makes an oriented manifold of any triangle list: edges of more than two faces and vertices of more
/// than one fan are split into sheets, faces are reversed to agree with their component.
#pragma once

#include "Mesh/EdgeRuns.h"
#include "Mesh/Surface.h"

namespace quadrille
{

/// Fills mesh.twin from the edge runs of mesh.origin. Where more than two faces share an edge, they are
/// paired so that the result stays orientable: around solids that touch, across the solid; elsewhere
/// the flattest pairs first; what is left over becomes boundary. Then faces are reversed to the
/// orientation that most faces of their component have. Throws InvalidInput, naming a polygon, when a
/// component is not orientable.
void pairIntoSheets(PreparedSurface& surface, const EdgeRuns& runs);

/// Gives each fan of faces around a vertex a vertex of its own; returns the number of vertices that had
/// more than one. Needs twins and consistent orientation; removed faces are left out.
std::size_t splitVertexFans(Mesh& mesh);

/// Where several edges join the same two vertices, all but one get a vertex in their middle. False when
/// there are none. Needs a surface without removed faces.
bool splitDoubleEdges(PreparedSurface& surface);

} // namespace quadrille
