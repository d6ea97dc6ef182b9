// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a polygon soup to the prepared surface: validation, repair, order along a space-filling curve, features.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Surface.h"

#include <optional>

namespace quadrille
{

struct PrepareOptions
{
  /// Edges whose face normals differ by more than this are features; radians in (0, pi]; none: off.
  std::optional<double> featureAngle;
  int threads = 0; ///< 0: all
  ProgressCallback progress;
};

/// Validates, repairs and orders. Throws InvalidInput for an empty input, a non-finite coordinate
/// (names the point), a corner id out of range (names the polygon), a non-orientable component (names
/// a face of it), when nothing is left after repair, and for guides, valences and sizes as
/// checkRequests, collectRequests and checkSizing do.
PreparedSurface prepareSurface(const SurfaceInput& input, const PrepareOptions& options);

/// The same without a copy: the points and polygons of the input are used up.
PreparedSurface prepareSurface(SurfaceInput&& input, const PrepareOptions& options);

} // namespace quadrille
