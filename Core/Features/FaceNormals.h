// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Normals of faces by which features are judged.
#pragma once

#include "Base/Angles.h"
#include "Mesh/Mesh.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

/// Faces whose normals differ by less lie in one plane: a degree over ten is far below what noise does to triangles of
/// a scan, and far above what rounding to single precision does to those that count. Radians.
constexpr double kOnePlane = radians(0.1);

/// Normals, computed when they are asked for: an array of them would be the largest of all. Those of slivers are
/// rounding noise; the face beyond their longest edge stands for them.
class FaceNormals
{
public:
  /// The mesh must outlive the normals. precision: see SurfaceInput.
  FaceNormals(const Mesh& mesh, double precision, int threads);

  /// A unit vector; not finite where no face that stands for f has an area.
  Vector3 of(Index f) const
  {
    const FaceNormal own = ownOf(f);
    return own.isReliable ? own.direction : ownOf(beyondSlivers(f)).direction;
  }

private:
  struct FaceNormal
  {
    Vector3 direction; ///< unit
    bool isReliable;
  };

  FaceNormal ownOf(Index f) const
  {
    const Vector3& p = mesh_.position[mesh_.origin[3 * f]];
    const Vector3& q = mesh_.position[mesh_.origin[3 * f + 1]];
    const Vector3& r = mesh_.position[mesh_.origin[3 * f + 2]];
    const Vector3 a = q - p, b = r - q, c = p - r;
    const Vector3 n = a.cross(b);
    const double doubleArea = n.norm();
    const double longest =
      std::sqrt(std::max({ a.squaredNorm(), b.squaredNorm(), c.squaredNorm() }));
    return { n / doubleArea, doubleArea > height_ * longest };
  }

  Index beyondSlivers(Index f) const;

  const Mesh& mesh_;
  double height_;
};

} // namespace quadrille
