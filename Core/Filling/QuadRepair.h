// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a bad shape, inverted ones above all, that no places of their points mend, as where one has a flat corner
/// on a curve: other edges between the points do, or a quad less or more.
#pragma once

#include "Mesh/Mesh.h"
#include "Quads/QuadMesh.h"

#include <functional>
#include <vector>

namespace quadrille
{

/// Chains of edges by their points.
using ChainsOfQuads = std::function<std::vector<std::vector<Index>>(const QuadMesh&)>;

struct QuadRepairOptions
{
  /// Of the mesh, ascending: points on them keep their place and their quads.
  std::vector<Index> fixedVertices;
  ChainsOfQuads
    keptChains; ///< their edges stay, and their points' numbers of quads; asked before each round; or none
  int threads = 1;
};

/// Changes quads round those with a scaled Jacobian below 0.1, between the lines of the mesh, and moves points there,
/// where fewer are inverted then, or as many and fewer are bad. Lines and points on them stay. The quads must be a
/// manifold that lies on the mesh; where there are polygons, nothing is done. New quads have no place in the map
/// (QuadMesh::quadSourceWeights).
void repairQuads(const Mesh& mesh, QuadMesh& quads, const QuadRepairOptions& options);

} // namespace quadrille
