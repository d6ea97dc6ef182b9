// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Names of the edges and vertices of a CAD file, as the CAD reader puts them into field data. Needs no Open CASCADE.
#pragma once

#include "Export/MeshSets.h"

#include <string>
#include <vector>

class vtkDataSet;

namespace quadrille
{

namespace arrays
{
constexpr const char* kCadEdgeNames = "CadEdgeNames";     ///< by id; empty where the file has none
constexpr const char* kCadVertexNames = "CadVertexNames"; ///< the same
constexpr const char* kCadEdgeEnds = "CadEdgeEnds";       ///< by id: two ids of vertices, or -1
constexpr const char* kCadEdgePoints =
  "CadEdgePoints"; ///< polylines of all edges, one after the other
constexpr const char* kCadEdgeCounts =
  "CadEdgeCounts"; ///< by id: how many of the points are of the edge
constexpr const char* kCadVertexPoints = "CadVertexPoints"; ///< by id
constexpr const char* kCadPlace =
  "CadPlace";                           ///< of nodes, as CadPlaceKind: 2 on an edge, 3 on a vertex
constexpr const char* kCadId = "CadId"; ///< of nodes: of that edge or vertex
}

/// Gives sides and nodes of the mesh the names that the file has, by where vtkQuadCADProjection has put the nodes of
/// the data. Nothing happens where the data have no such names or places.
void readCadNames(vtkDataSet* data, ElementMesh& mesh);

/// One sentence of the named edges and vertices that no set is of, as quads do not follow them; empty where there is
/// none.
std::string cadNamesWithoutSet(vtkDataSet* data, const MeshSets& sets);

} // namespace quadrille
