// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connected components that are smaller than a few quads: the islands of isosurfaces and noisy scans.
#pragma once

#include "Mesh/ComponentSizes.h"
#include "Mesh/Surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// One of them.
struct SmallComponent
{
  double area = 0;                 ///< over the sizes
  double block = 0;                ///< quads, see quadsOfBlock
  Vector3 place = Vector3::Zero(); ///< the middle of its corners
};

/// Components with less area than the quads of their smallest block have.
struct SmallComponents
{
  std::size_t components = 0;        ///< of the surface
  std::size_t count = 0;             ///< small ones among them
  double area = 0;                   ///< of the small ones, over the sizes
  double quads = 0;                  ///< of their blocks
  double largest = 0;                ///< area of the largest small one
  Vector3 place = Vector3::Zero();   ///< the middle of its vertices
  std::vector<std::uint8_t> isSmall; ///< #F; empty where count is 0
  std::vector<SmallComponent> each;  ///< by their lowest faces
};
/// For quads of edge length s > 0; mostQuads: only those with less area than so many quads. Linear, and next to nothing
/// for a large connected surface. threads: 0: all.
SmallComponents findSmallComponents(
  const PreparedSurface& surface, double edgeLength, double mostQuads = kInfinity, int threads = 1);

/// Removes the faces that are marked (#F), which are so many whole components and not all. Area, components and hash
/// follow, and requests at their vertices go.
void removeComponents(
  PreparedSurface& surface, const std::vector<std::uint8_t>& isRemoved, std::size_t count);

/// Removes the small components; at least one component stays, so where all are small all stay. Returns how many
/// went.
std::size_t removeSmallComponents(PreparedSurface& surface, const SmallComponents& small);

} // namespace quadrille
