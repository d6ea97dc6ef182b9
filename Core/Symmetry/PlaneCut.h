// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A part of a surface whose images make the whole, and the cut of a surface along a plane.
#pragma once

#include "Mesh/Surface.h"
#include "Symmetry/Isometry.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// Of a triangle: its corners in weights of the corners of a face.
using FaceWeights = std::array<std::array<double, 3>, 3>;
constexpr FaceWeights kWholeFace{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
/// Of a triangle in one whose corners have weights in a third one.
FaceWeights composed(const FaceWeights& inner, const FaceWeights& outer);

/// In front of a mirror plane, or between two half planes, the second one the first turned by one step.
struct SurfacePart
{
  /// Triangles only, with points in the planes to the last bits, and requested features; those of the whole surface
  /// that lie in a plane are features here, too. Of a wedge seams: what lies in the first half plane, and what in the
  /// second. No guides, valences or sizes.
  SurfaceInput input;
  std::vector<Index>
    vertex; ///< per point: of the surface; kInvalidIndex for one where an edge was cut
  std::vector<Index> face;          ///< per triangle: the face of the surface that it is a part of
  std::vector<FaceWeights> weights; ///< per triangle, of the corners of that face
  std::vector<MirrorPlane>
    planes; ///< one, or those of two half planes; their normals point into the part

  // Of a wedge.
  std::vector<Vector3> poles; ///< where the axis meets the surface; there is a point
  double startAngle = 0;      ///< of the first half plane, from the axis' own, radians
  /// Features that end on one side of the wedge only.
  std::size_t loneFeatures = 0;
  /// Empty, or why the wedges do not fit together, with a place.
  std::string mismatch;
};

/// Features that meet the plane count as requested, up to where they end or meet others: each half of one may be too
/// short for the quads though it is not as a whole.
void requestCutFeatures(Mesh& mesh, const MirrorPlane& plane, double tolerance);

/// What is in front. Vertices that are no farther from the plane than `tolerance` (units of the mesh, >= 0) are put
/// into it; edges that cross it are cut, once for both of their faces. Faces in the plane belong to neither side.
SurfacePart cutByPlane(const Mesh& mesh, const MirrorPlane& plane, double tolerance);

} // namespace quadrille
