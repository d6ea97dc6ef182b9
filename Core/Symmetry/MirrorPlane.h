// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The plane of a mirror symmetry.
#pragma once

#include "Base/Types.h"

namespace quadrille
{

/// What the quads have where a mirror plane cuts the surface.
enum class PlaneCurve
{
  Isoline, ///< edges in the plane
  MidLine  ///< quads across the plane, each its own image
};

struct MirrorPlane
{
  Vector3 origin = Vector3::Zero();
  Vector3 normal = Vector3::UnitX(); ///< unit

  /// Signed distance of a point, above zero in front.
  double height(const Vector3& p) const { return normal.dot(p - origin); }
  /// The mirror image of a point. One in the plane is its own image, up to rounding.
  Vector3 image(const Vector3& p) const { return p - 2 * height(p) * normal; }
  /// The mirror image of a vector.
  Vector3 imageOf(const Vector3& direction) const
  {
    return direction - 2 * normal.dot(direction) * normal;
  }
  /// The nearest point in the plane.
  Vector3 foot(const Vector3& p) const
  {
    const Vector3 once = p - height(p) * normal;
    return once - height(once) * normal; // what rounding has left
  }
};

} // namespace quadrille
