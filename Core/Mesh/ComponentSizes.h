// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connected components of a mesh: their area, the smallest block of quads with their topology, and how fine they have
/// to be triangulated.
#pragma once

#include "Mesh/Mesh.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// A component whose area is below that of so many quads is triangulated as if they were smaller: about 60 vertices on
/// all levels are what a cross field with eight irregular vertices needs.
constexpr double kQuadsOfSmallTriangulation = 26;

/// Factor on the edge length s for the triangles of a component with this area (over its sizes); at most 1.
double triangulationScale(double area, double edgeLength);

/// The number of quads of a small block with the topology of a component: six for a sphere (a box), four for a disc, 16
/// for each handle of another closed surface, and eight for each boundary loop after the first and 16 for each handle
/// of an open one.
double quadsOfBlock(long long eulerCharacteristic, std::size_t boundaryLoops);

/// The components of a mesh, in the order of their lowest faces.
struct ComponentSizes
{
  std::vector<Index> componentOfFace; ///< #F
  std::vector<double> area;           ///< over the sizes
  std::vector<double> block;          ///< see quadsOfBlock
};
/// Linear. The mesh passes validate(), but for vertices without faces.
ComponentSizes measureComponents(const Mesh& mesh, int threads = 1);

} // namespace quadrille
