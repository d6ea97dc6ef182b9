// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a surface behind loops that are shorter than a quad and cut it in two: stubs of handles that were cut,
/// hairs, drops on a stalk, and bridges between larger parts.
///
/// Where edges are about half a quad, such a place is a tube of three edges round. None of its vertices can be removed
/// without edges becoming double ones, so a coarse level has all of them, and a map has to lay out a tower of triangles
/// in less than the place of a quad.
#pragma once

#include "Mesh/Surface.h"

#include <array>
#include <vector>

namespace quadrille
{

/// The smaller side of three edges that are no face: a disc, or large.
struct ThinPart
{
  std::array<Index, 3> loop{};   ///< vertices of its edge
  double length = 0;             ///< of the three edges, over the sizes
  double girth = 0;              ///< the same in units of the mesh
  double area = 0;               ///< over the sizes
  bool isLarge = false;          ///< as much area as ThinPartLimits says, or more
  Index tip = kInvalidIndex;     ///< of its vertices one that is far from its edge
  double height = 0;             ///< how far that is along edges, in units of the mesh
  Index outside = kInvalidIndex; ///< a vertex of the rest, at least `girth` away
};

/// What is a thin part; all > 0, in units of the mesh over its sizes.
struct ThinPartLimits
{
  double loopOfDisc = 0;  ///< loops in front of discs are shorter
  double loopOfLarge = 0; ///< those between large parts are
  double largeArea = 0;   ///< discs have less area, large parts as much on both sides
};

/// The parts behind three edges that rise at least an eighth as high as the loop is long: of discs within each other
/// the outer one, of loops on the same neck between large parts the shortest one. Discs have no boundary; they come
/// first. The mesh passes validate().
std::vector<ThinPart> findThinParts(const Mesh& mesh, const ThinPartLimits& limits);

/// Cuts the surface along the shortest loop along inner edges through one of the vertices of ThinPart::loop that parts
/// `tip` from `outside`, all of them vertices of the surface, and closes it with fans round the mean of the loop. Of
/// discs the part goes, large ones become a component. A part stays as it is where there is no such loop of less than
/// `longer` times its girth, where another one that was cut is in the way, and a disc where what is beyond the loop is
/// none, has more area than `mostArea` (units of the mesh: the shortest loop may lie far from the part's own, with a
/// limb beyond it), or has something that was asked for (features, valences, sectors). Returns the entries that were
/// cut, ascending; if there are any, the hash is made anew and vertices may have other ids.
std::vector<std::size_t> cutThinParts(
  PreparedSurface& surface, const std::vector<ThinPart>& parts, double longer, double mostArea);

} // namespace quadrille
