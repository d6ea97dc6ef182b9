// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One of n wedges of a surface round an axis.
#pragma once

#include "Mesh/RotationAxis.h"
#include "Mesh/Surface.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// Between two half planes that end in the axis, the second one the first turned by one step.
struct SurfaceWedge
{
  using CornerWeights = std::array<std::array<double, 3>, 3>;

  /// Triangles only, with requested features, and seams: what lies in the first half plane, and what in the second.
  /// Where the axis meets the surface there is a point. No guides, valences or sizes.
  SurfaceInput input;
  std::vector<Index> face; ///< per triangle: the face of the surface that it is a part of
  std::vector<CornerWeights>
    weights;                  ///< per triangle: its corners in weights of the corners of that face
  std::vector<Vector3> poles; ///< where the axis meets the surface
  double startAngle = 0;      ///< of the first half plane, from the axis' own, radians
  /// Empty, or why the wedges do not fit together, with a place.
  std::string mismatch;
};

/// Half planes are tried in the order of the length of the cut, the shortest first, until wedges fit together; where
/// none do, the mismatch of the first one is told. Points that are no farther from a half plane than `tolerance` (units
/// of the mesh) are put into it; places on one side of the wedge and images of those on the other are the same within
/// `reach` (>= tolerance). order: at least 2.
SurfaceWedge cutWedge(
  const Mesh& mesh, const RotationAxis& axis, int order, double tolerance, double reach);

} // namespace quadrille
