// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How the surface that a coarse triangle stands for is stretched against the flat triangle: the metric that carries
/// the distortion of the decimation to the coarse level [the paper's Section 10 names it as future work].
///
/// The log of phase 2 backwards lays the intermediate level out on the coarse triangles, which are a flat surface but
/// for cones at their vertices; no removed vertex is one, so a star is laid out in the plane and its vertex put back
/// there by its weights.
/// With the Jacobian J of the map from a coarse triangle to an intermediate one, U = sqrt(J^T J) is what it stretches,
/// without a rotation. U is averaged over the area of the coarse triangle: along a wave its mean is the length of the
/// wave over that of its chord, where the mean of J^T J would be more.
#pragma once

#include "Hierarchy/Hierarchy.h"

#include <vector>

namespace quadrille
{

/// #F of the coarse level, against the intermediate one: symmetric and positive, in the plane of the face whose first
/// axis is half-edge 3f. Its determinant is the area of the surface that was laid out there over the area that it
/// covers; the identity where nothing was. Throws InvalidInput when the levels are not of the log's surface.
std::vector<Eigen::Matrix2d> measureStretch(
  const Level& intermediate, const Level& coarse, const DecimationLog& log);

/// Guides of the coarse level (#F, or empty) from those of the intermediate faces that a face stands for: the mean of
/// their crosses, each carried to the coarse triangle by the inverse of J. Its weight is their sum over the triangle's
/// area: a stroke that covers a third of a triangle, or turns within it, has so much less of a say there. Throws as
/// measureStretch does.
std::vector<Guide> gatherGuides(
  const Level& intermediate, const Level& coarse, const DecimationLog& log);

} // namespace quadrille
