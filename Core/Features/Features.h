// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Feature edges by dihedral angle and by patch ids.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Flags, on both half-edges, the inner edges whose face normals differ by more than `angle` (radians), but for those
/// that do not stand out from their surroundings (see edgesOfFacets): those of the facets of a coarse or noisy sampling
/// of a smooth surface. Where a tenth of the area or more lies in planes, each of a two-hundredth of it or more, the
/// surface is one of designed bodies, and each edge above the angle is a feature. Features that were marked before
/// stay. Slivers, whose normals are rounding noise, count with the normal of the face beyond their longest edge, so
/// that they make no features of their own. precision: see SurfaceInput.
FacetReport markCreases(Mesh& mesh, double angle, int threads, double precision = 0);

/// The normals that count for these half-edges, one each: of their faces, or where these are slivers of the face that
/// stands for them, as in markCreases.
std::vector<Vector3> normalsBeside(
  const Mesh& mesh, const std::vector<Index>& halfEdges, int threads, double precision = 0);

/// Flags, on both half-edges, the edges between faces whose source polygons have different patch ids.
void markFeaturesByPatch(PreparedSurface& surface, const std::vector<std::int64_t>& patchIds);

/// Copies each flag to the twin: an edge is a feature when either of its polygons says so.
void makeFlagsSymmetric(Mesh& mesh);

} // namespace quadrille
