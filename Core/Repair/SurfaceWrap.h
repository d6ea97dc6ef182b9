// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A closed surface round whatever the user has: a soup of triangles, or points.
///
/// CGAL's 3D alpha wrapping (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022, "Alpha wrapping with an
/// offset"): a ball of radius alpha carves a Delaunay tetrahedrization from outside until it meets the offset surface
/// of the input. What comes is closed, orientable, manifold, without self-intersections, and has the input strictly
/// inside.
#pragma once

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Repair/Soup.h"

#include <optional>

namespace quadrille
{

struct WrapOptions
{
  /// Radius of the ball, in units of the points, > 0: gaps and holes that it does not fit through are closed, and it
  /// bounds the size of the triangles. None: the diagonal / 100.
  std::optional<double> alpha;
  /// Distance of the wrap from the input, in units of the points, > 0. None: the diagonal / 600, at most alpha / 6.
  std::optional<double> offset;
  /// Asked at each step of the carving; the tree before it and the extraction after it run to their end.
  ProgressCallback progress;
};

struct WrappedSurface
{
  Status status; ///< not ok: there is no surface, and why
  TriangleList surface;
  double alpha = 0;  ///< as it was used
  double offset = 0; ///< the same
};

/// The least alpha over the diagonal: below, the tetrahedra would be more than memory holds.
constexpr double kLeastRelativeAlpha = 1e-4;

/// Throws InvalidInput for values that are not positive and finite, an alpha below kLeastRelativeAlpha of the diagonal,
/// and a soup without extent; Cancelled where the callback asks to stop.
WrappedSurface wrapSurface(const Soup& soup, const WrapOptions& options);

} // namespace quadrille
