// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Validation and repair of the user's surface.
#pragma once

#include "Base/Refuse.h"
#include "Mesh/EdgeRuns.h"
#include "Mesh/Surface.h"

namespace quadrille
{

/// Throws InvalidInput, naming the element, for empty input, arrays of wrong size, ids out of range and
/// coordinates that are not finite; and as checkRequests does.
void checkInput(const SurfaceInput& input, int threads);

/// Of these, the arrays that stand beside points and polygons: their sizes, and what checkRequests and checkSizing ask.
void checkArrays(const SurfaceInput& input);

/// Throws InvalidInput where a polygon's corner is none of so many points.
inline void requirePoint(std::size_t polygon, Index point, std::size_t points)
{
  if (point >= points)
  {
    refuse("polygon ", polygon, " uses point ", point, ", but there are only ", points,
      " points: remove the polygon or add the point.");
  }
}

/// Throws InvalidInput where a coordinate of the point is not finite, or so large that lengths overflow.
inline void requireCoordinates(std::size_t point, const Vector3& place)
{
  constexpr double kLargestCoordinate = 1e150; // the squared size of the box must be finite, too
  if (!(place.cwiseAbs().maxCoeff() < kLargestCoordinate) || !place.allFinite())
  {
    refuse("point ", point,
      " has a coordinate that is not finite or exceeds 1e150: remove the point and the polygons "
      "at it, or correct it.");
  }
}

/// Makes a surface whose corners are set, and whose vertices and faces are in order, an oriented manifold
/// with twins (`runs` are its edges); counts what it changed, and the components. Linear, and little more than the
/// pairing of half-edges where nothing has to be changed. Throws InvalidInput when a component is not orientable.
void repairSurface(PreparedSurface& surface, EdgeRuns runs, int threads);

} // namespace quadrille
