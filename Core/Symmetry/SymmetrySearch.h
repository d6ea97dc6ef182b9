// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The plane about which a surface is nearest to its own mirror image, and the axis round which it is nearest to itself
/// when it is turned by one step.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Symmetry/Isometry.h"

namespace quadrille
{

/// How far the image of a surface is from the surface, in its units.
struct ImageDeviation
{
  double rms = 0; ///< over the area
  double maximum = 0;
  Vector3 place = Vector3::Zero(); ///< whose image is farthest
};

/// Of samples by area, and of up to 20,000 points.
ImageDeviation imageDeviation(
  const NearestTriangle& surface, const Isometry& isometry, int threads);

/// The plane of a mirror image and the axis of a rotation go through the centre of area, and the normal, or the
/// direction, is a principal axis of the inertia. So those through the centre are tried along these axes, along others
/// between two of them, as where two moments are equal any could be one, and some all round. The best few are refined:
/// each sample's image and the nearest place of the surface give an equation for the change of the isometry (point to
/// plane [Chen and Medioni 1992], by Gauss and Newton, with Cauchy's weights, so that parts without a counterpart count
/// less). Of planes that are equally good, such as those of a box, the one across the longest axis is taken. The first
/// component of the direction that is not small is positive. There is always one, which is as good as imageDeviation
/// tells. surface: of triangles with some area. kind: a reflection, or a rotation of the order that is looked for.
Isometry findIsometry(const NearestTriangle& surface, const Isometry& kind, int threads);

} // namespace quadrille
