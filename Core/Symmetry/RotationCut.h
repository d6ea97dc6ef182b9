// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One of n wedges of a surface round an axis.
#pragma once

#include "Mesh/Surface.h"
#include "Symmetry/MirrorPlane.h"
#include "Symmetry/RotationAxis.h"

#include <array>
#include <optional>
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
  /// Features that end on one side of the wedge only.
  std::size_t loneFeatures = 0;
  std::array<MirrorPlane, 2> planes; ///< of the two half planes; their normals point into the wedge
  /// Empty, or why the wedges do not fit together, with a place.
  std::string mismatch;
};

/// How far places on one side of a wedge may be from images of those on the other side, in units of the mesh.
struct WedgeReach
{
  double ofCuts = 0;     ///< ends and middles of what a half plane cuts
  double ofFeatures = 0; ///< where features end; those without an image end on one side only
};

/// The first half plane of the wedge is at startAngle. None: half planes are tried in the order of the length of the
/// cut, the shortest first, until wedges fit together and no feature ends on one side only; else the one with the
/// fewest of these is taken. Where no wedges fit together, the mismatch of the first one is told. Points that are no
/// farther from a half plane than `tolerance` (units of the mesh) are put into it. order: at least 2.
SurfaceWedge cutWedge(const Mesh& mesh, const RotationAxis& axis, int order, double tolerance,
  const WedgeReach& reach, std::optional<double> startAngle = std::nullopt);

} // namespace quadrille
