// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The half of a surface in front of a plane.
#pragma once

#include "Mesh/Surface.h"
#include "Symmetry/MirrorPlane.h"

#include <array>
#include <vector>

namespace quadrille
{

/// A point of the half: the vertex `from` of the surface, or, where `to` is another one, the place on the edge between
/// them, (1 - share) from + share to.
struct CutPoint
{
  Index from = kInvalidIndex;
  Index to = kInvalidIndex;
  double share = 0;

  bool isVertex() const { return from == to; }
};

struct MirrorHalf
{
  /// Triangles only, with points in the plane to the last bits, and requested features; those of the whole surface that
  /// lie in the plane are features here, too. No guides, valences or sizes.
  SurfaceInput input;
  std::vector<CutPoint> origin; ///< per point
  std::vector<Index> face;      ///< per triangle: the face of the surface that it is a part of

  /// Corners of triangle t in weights of the corners of its face.
  std::array<std::array<double, 3>, 3> cornerWeights(const Mesh& mesh, Index t) const;
};

/// Vertices that are no farther from the plane than `tolerance` (units of the mesh, >= 0) are put into it; edges that
/// cross it are cut, once for both of their faces. Faces in the plane belong to neither side.
MirrorHalf cutByMirror(const Mesh& mesh, const MirrorPlane& plane, double tolerance);

} // namespace quadrille
