// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a mapped surface back to the triangles that it was made of.
#pragma once

#include "Mesh/Surface.h"
#include "Pieces/CarriedPlaces.h"
#include "Quads/QuadMesh.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

/// Triangles that were the input of a surface.
struct SourceTriangles
{
  const std::vector<Index>& corners; ///< 3 each
  const std::vector<Vector3>& points;
};

/// The place with these weights in a face of `mapped`, on a triangle of its source. None where it lies on no triangle,
/// as where a handle was closed, or, with `point`, where the place is elsewhere than there.
std::optional<SurfacePoint> placeOnSource(const PreparedSurface& mapped, Index face,
  const std::array<double, 3>& weights, const SourceTriangles& source, const Vector3* point);

/// Of points and middles of quads.
struct PlacesOfQuads
{
  std::vector<SurfacePoint> places;
  std::vector<std::size_t> whose; ///< points, then quads: those that have a place
};

/// The places of points where they are, and of the middles of quads.
PlacesOfQuads placesOfQuads(
  const PreparedSurface& mapped, const QuadMesh& quads, const SourceTriangles& source);

} // namespace quadrille
