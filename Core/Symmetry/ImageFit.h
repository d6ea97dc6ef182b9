// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads and their images on the surface that they are of.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Mesh/Surface.h"
#include "Symmetry/Copies.h"

#include <vector>

namespace quadrille
{

/// A surface with the trees that are asked for its nearest places.
struct SearchedSurface
{
  explicit SearchedSurface(PreparedSurface prepared);

  PreparedSurface surface;
  NearestTriangle faces;    ///< triangle f is face f
  NearestTriangle features; ///< segments; inside
  NearestTriangle boundary; ///< segments

  /// One that faces the same way, where there is one.
  NearestTriangle::Place nearestFace(const Vector3& p, const Vector3& normal) const;
  std::size_t bytes() const;
};

struct FittedImages
{
  std::vector<SourceLocation>
    images; ///< per point behind those of the part: where it lies on the input
  std::vector<Index>
    quadPolygons;        ///< per quad behind those of the part: the input's polygon under it
  std::size_t moved = 0; ///< points that were farther than the tolerance from the surface
  double farthest = 0;   ///< of them, in units of the surface
  Vector3 place = Vector3::Zero(); ///< of that one, before
};

/// Points behind those of the part that are farther than `tolerance` from the surface are put there: those of features
/// and boundaries onto the nearest one of their kind where there is one within `reach`, others onto the nearest place
/// that faces the same way. What points are moved is evened out with their neighbours', so that they keep their order.
/// The rest stays where it is, an exact image.
FittedImages fitImages(
  CopiedQuads& copied, const SearchedSurface& whole, double tolerance, double reach, int threads);

} // namespace quadrille
