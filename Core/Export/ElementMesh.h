// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads as elements for simulation, as the file formats take them.
///
///   3 --- 6 --- 2      corners, middles of the edges 01 12 23 30, centre: the order of VTK, Exodus II, Abaqus, Gmsh.
///   |           |      Side i runs from corner i to corner i + 1.
///   7     8     5
///   |           |
///   0 --- 4 --- 1
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// What the patch array says of some elements.
struct MeshPatch
{
  std::int64_t number = 0;
  std::string
    name; ///< as the user wrote it; empty: it has none. Patches with the same name are one set
};

/// A node with a name of its own, as a vertex of a CAD file.
struct NamedNode
{
  Index node = 0;
  std::string name;
};

struct ElementMesh
{
  std::vector<Vector3> nodes;
  int nodesPerElement = 4;                ///< 4, 8 or 9
  std::vector<Index> elements;            ///< #E * nodesPerElement
  std::vector<MeshPatch> patches;         ///< at least one where there are elements
  std::vector<Index> patchOf;             ///< #E, in `patches`; empty: all are of the first one
  std::vector<std::uint8_t> featureEdges; ///< #E or empty; bit i: side i is on a feature
  std::vector<std::string>
    curveNames; ///< of curves with names of their own, as edges of a CAD file
  /// #E * 4 or empty: of which one of curveNames side i of element e is, kInvalidIndex: of none. Those of the boundary
  /// and of features count; one of the two sides of an edge is enough.
  std::vector<Index> curveOf;
  std::vector<NamedNode> namedNodes;
  std::vector<double> thickness; ///< #E or empty; > 0, in units of the nodes
  std::vector<Vector3>
    axis; ///< #E or empty; unit vectors in the elements' planes, zero: the element has none

  std::size_t elementCount() const
  {
    return elements.size() / static_cast<std::size_t>(nodesPerElement);
  }
  const Index* element(std::size_t e) const
  {
    return elements.data() + e * static_cast<std::size_t>(nodesPerElement);
  }
  Index corner(std::size_t e, std::size_t i) const { return element(e)[i % 4]; }
  /// The node in the middle of side i; kInvalidIndex for elements of first order.
  Index middle(std::size_t e, std::size_t i) const
  {
    return nodesPerElement == 4 ? kInvalidIndex : element(e)[4 + i];
  }
  Index patch(std::size_t e) const { return patchOf.empty() ? 0 : patchOf[e]; }
};

/// Throws InvalidInput, naming the element or node that is at fault, unless sizes fit each other, ids are in range, no
/// element has a node twice, coordinates are finite, thicknesses above 0 and axes of length 1 or 0 (to 1e-6).
void requireValid(const ElementMesh& mesh);

/// "writing 12 elements".
std::string writingText(const ElementMesh& mesh);

/// Twice the vector area of an element, by its diagonals.
Vector3 elementAreaVector(const ElementMesh& mesh, std::size_t element);

/// The unit normal of an element, by its diagonals; zero where they are parallel.
Vector3 elementNormal(const ElementMesh& mesh, std::size_t element);

} // namespace quadrille
