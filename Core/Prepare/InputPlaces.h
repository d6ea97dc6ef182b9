// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places on what the user hands in, and ways between them, for as long as its points and polygons stay the same.
#pragma once

#include "Prepare/SurfacePaths.h"
#include "Requests/SurfacePlaces.h"

namespace quadrille
{

/// The points and polygons of an input, with which it shares their arrays.
inline SurfaceInput shapeOf(const SurfaceInput& input)
{
  SurfaceInput shape;
  shape.points = input.points;
  shape.polygonOffsets = input.polygonOffsets;
  shape.polygonPoints = input.polygonPoints;
  return shape;
}

/// Both remember what their first questions have made, so only one thread at a time may ask.
struct InputPlaces
{
  /// Throws as SurfacePlaces does.
  InputPlaces(const SurfaceInput& input, int threads)
    : shape(shapeOf(input)), places(shape, threads), paths(shape, threads)
  {
  }
  InputPlaces(const InputPlaces&) = delete;
  InputPlaces& operator=(const InputPlaces&) = delete;

  const SurfaceInput shape;
  const SurfacePlaces places;
  const SurfacePaths paths;
};

} // namespace quadrille
