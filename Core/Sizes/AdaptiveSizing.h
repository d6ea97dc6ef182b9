// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Edge lengths of quads that the shape of the surface asks for: small where it is curved, or where another sheet of it
/// is near.
#pragma once

#include "Mesh/Mesh.h"
#include "Sizes/AdaptiveSizes.h"
#include "Sizes/CornerCurvatures.h"

#include <vector>

namespace quadrille
{

/// #V, units of the mesh: the smaller of two lengths, as far as they are asked for.
/// - sqrt(8 e / k) with the chord error e and a / k with the turn a, where k is the largest absolute normal curvature:
///   the known one, and along features and boundaries that of the curve; where none is known that of the triangles over
///   about `edgeLength`. Infinite in a plane.
/// - The distance to the opposite sheet, inside or outside, over the quads across a gap; infinite where none is near
///   enough to matter. A sheet is opposite where a ray along the normal meets it and the two normals are at most 45
///   degrees from opposite.
/// edgeLength: about that of the quads, the scale over which the surface is looked at; the largest one that may be
/// asked for is `reach` times it.
std::vector<float> adaptiveLengths(const Mesh& mesh, const AdaptiveSizes& sizes, double edgeLength,
  double reach, int threads, const CornerCurvatures& known = {});

/// Gives the mesh sizes: the smaller of `asked` (multiples of edgeLength, #V or empty) and of the lengths, kept within
/// the range of `sizes`.
void setAdaptiveSizes(Mesh& mesh, const std::vector<float>& asked,
  const std::vector<float>& lengths, const AdaptiveSizes& sizes, double edgeLength);

/// How a number of quads is shared.
struct DistributedSizes
{
  double edgeLength = 0;   ///< s
  double lengthFactor = 1; ///< by which the lengths are to be multiplied, at least 1
};

/// The edge length with which the sizes make `quads` quads: larger than that without sizes, where these are smaller
/// than 1. Where so few quads are asked for that the smallest size would stop the lengths on more than a twentieth of
/// the area, these are multiplied by the least factor with which it does not, as the quads would be all alike there.
/// Growth is not limited.
DistributedSizes distributeSizes(const Mesh& mesh, const std::vector<float>& asked,
  const std::vector<float>& lengths, const AdaptiveSizes& sizes, double quads);

/// The share of the area on which the mesh's sizes times edgeLength are at most 5 % above the lengths.
double shareOfLengthsMet(const Mesh& mesh, const std::vector<float>& lengths, double edgeLength);

} // namespace quadrille
