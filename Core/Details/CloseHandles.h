// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Removal of small handles: the surface is cut along a short loop, both sides are closed, and what is left of the
/// handle on each goes.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// Along the edges of the surface a loop may be so much longer than on the intermediate level, which lies inside of it.
constexpr double kLongerAlongEdges = 2;
/// What is left of a handle that was cut, and is longer round than so many edge lengths, is no stub but a limb that
/// quads show: the jaw of a skull hangs on two joints, and both may be handles below the limit.
constexpr double kGirthOfLimb = 4.5;

/// For each entry of `places`, vertices near a handle, the shortest loop along edges that goes round or through a
/// handle, that meets one of these vertices, and is shorter than `bound` (units of the mesh), is cut and closed (see
/// cutAndClose); the genus is one lower for each. Left out are places without such a loop away from the boundary, and
/// loops that meet one that was cut before or would, together with these, cut the surface in two: another call may find
/// them. Pits and stubs behind the caps are taken out where they can be (see removeStub). Returns the entries whose
/// handles were closed, ascending; if there are any, the hash is made anew and vertices may have other ids. Never
/// makes two components of one.
/// opening: see removeStub. threads: 0: all.
std::vector<std::size_t> closeHandles(PreparedSurface& surface,
  const std::vector<std::vector<Index>>& places, double bound, double opening = kInfinity,
  int threads = 1);

} // namespace quadrille
