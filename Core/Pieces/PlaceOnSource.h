// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a mapped surface back to the triangles that it was made of.
#pragma once

#include "Mesh/Surface.h"
#include "Pieces/CarriedPlaces.h"

#include <array>
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
std::optional<FacePlace> placeOnSource(const PreparedSurface& mapped, Index face,
  const std::array<double, 3>& weights, const SourceTriangles& source, const Vector3* point);

/// The same of the middle of a quad; weights: all zero where the quad is no unit square of the map, and its face is all
/// that is known.
std::optional<FacePlace> middleOnSource(const PreparedSurface& mapped, Index face,
  const std::array<double, 3>& weights, const SourceTriangles& source);

} // namespace quadrille
