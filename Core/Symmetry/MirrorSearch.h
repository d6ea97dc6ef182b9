// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The plane about which a surface is nearest to its own mirror image.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Symmetry/MirrorPlane.h"

namespace quadrille
{

/// How far the mirror image of a surface is from the surface, in its units.
struct MirrorDeviation
{
  double rms = 0; ///< over the area
  double maximum = 0;
  Vector3 place = Vector3::Zero(); ///< whose image is farthest
};

/// Of samples by area, and of up to 20,000 points.
MirrorDeviation mirrorDeviation(
  const NearestTriangle& surface, const MirrorPlane& plane, int threads);

/// The plane of a mirror image goes through the centre of area, and its normal is a principal axis of the inertia. So
/// planes through the centre are tried whose normals are those axes, others between two of them, as where two moments
/// are equal any could be one, and some all round. The best few are refined: each sample's image and the nearest place
/// of the surface give an equation for the plane (point to plane [Chen and Medioni 1992], by Gauss and Newton, with
/// Cauchy's weights, so that parts without a counterpart count less). Of planes that are equally good, such as those of
/// a box, the one across the longest axis is taken. The first component of the normal that is not small is positive.
/// There is always one, which is as good as mirrorDeviation tells. surface: of triangles with some area.
MirrorPlane findMirrorPlane(const NearestTriangle& surface, int threads);

} // namespace quadrille
