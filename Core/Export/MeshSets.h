// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sets of a mesh for loads and supports: elements and nodes by patch, boundary loops, feature curves and corners, from
/// the mesh alone.
///
/// Edges of one element are boundary, marked edges between elements are features. Corners are the nodes where other
/// than two of both meet (a feature ends, branches, or runs into the boundary), and those where a loop or curve bends
/// by more than 40 degrees and the elements do not go on straight: not two of them at a node of the boundary, on a
/// feature not two on each side. A round hole of few edges thus has no corners, a rectangular plate has four. Where
/// curves or nodes have names of their own, so are their ends and the nodes.
#pragma once

#include "Export/ElementMesh.h"

#include <string>
#include <vector>

namespace quadrille
{

struct ElementSide
{
  Index element = 0;
  Index side = 0; ///< 0 to 3, see ElementMesh.h
};

/// Edges between two corners, or all round where there is none.
struct EdgeChain
{
  bool closed = false;
  std::vector<Index>
    nodes; ///< corners of elements in their order; a closed chain does not repeat the first one
  std::vector<Index> middles;     ///< of each edge; empty for elements of first order
  std::vector<ElementSide> sides; ///< of each edge: the element with the lowest id, and its side
  std::vector<Index> patches;     ///< in MeshSets::patches, ascending: those that it is a border of
  Index startCorner = kInvalidIndex; ///< in MeshSets::corners; both are there or none
  Index endCorner = kInvalidIndex;
};

struct ElementSet
{
  std::string name;
  std::int64_t number = 0;     ///< of its first patch
  std::vector<Index> elements; ///< ascending
  bool isNamed = false;        ///< by MeshPatch::name
};

/// A boundary loop, a feature curve, or all edges of a name of its own.
struct CurveSet
{
  std::string name;
  std::vector<Index> chains; ///< in MeshSets::chains; of a loop one after the other
  bool isNamed = false;      ///< by ElementMesh::curveNames
};

struct CornerSet
{
  std::string name;
  Index node = 0;
};

struct MeshSets
{
  std::vector<ElementSet> patches; ///< in the order of the numbers; no empty ones
  std::vector<EdgeChain> chains;
  std::vector<CurveSet>
    boundaries; ///< BOUNDARY_1, ...: by the lowest sides of elements. Elements are on their left
  /// CURVE_1, ...: the same; one chain each. Then those with names of their own, which may have several chains, and
  /// have chains of the boundary that are in its loop, too.
  std::vector<CurveSet> curves;
  std::vector<CornerSet> corners; ///< CORNER_1, ...: by ids of nodes; named ones by their name

  std::size_t edgeCount() const; ///< of all chains
};

/// Patches without a name are PATCH_n by their number (PATCH_MINUS_n below 0). Deterministic, n log n at worst. Looks
/// out for a stop. Throws InvalidInput as requireValid does.
MeshSets setsOf(const ElementMesh& mesh);

/// #E: the set in MeshSets::patches.
std::vector<Index> patchSetOfElements(const ElementMesh& mesh, const MeshSets& sets);
/// All nodes of a curve in their order, with those in the middle of edges, each once.
std::vector<Index> nodesOf(const MeshSets& sets, const CurveSet& curve);
/// All nodes of the elements of a patch, with those in the middle of edges and of elements, ascending, each once. Looks
/// out for a stop.
std::vector<Index> nodesOf(const ElementMesh& mesh, const ElementSet& patch);
/// All edges of a curve in their order.
std::vector<ElementSide> sidesOf(const MeshSets& sets, const CurveSet& curve);

} // namespace quadrille
