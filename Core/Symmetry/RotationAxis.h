// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The axis of a rotational symmetry.
#pragma once

#include "Base/Angles.h"
#include "Base/Types.h"

#include <cmath>

namespace quadrille
{

struct RotationAxis
{
  Vector3 origin = Vector3::Zero();
  Vector3 direction = Vector3::UnitZ(); ///< unit

  /// Along the axis, from its origin.
  double height(const Vector3& p) const { return direction.dot(p - origin); }
  /// From the nearest point of the axis to p.
  Vector3 radial(const Vector3& p) const
  {
    const Vector3 arm = p - origin;
    return arm - direction.dot(arm) * direction;
  }
  Vector3 foot(const Vector3& p) const { return origin + height(p) * direction; }
  /// A vector turned counterclockwise, seen against the direction.
  Vector3 turned(const Vector3& vector, double angle) const
  {
    const Vector3 along = direction.dot(vector) * direction;
    const Vector3 across = vector - along;
    return along + std::cos(angle) * across + std::sin(angle) * direction.cross(across);
  }
  /// A point turned by so many steps of order n.
  Vector3 image(const Vector3& p, int steps, int order) const
  {
    return steps == 0 ? p : Vector3(origin + turned(p - origin, stepAngle(steps, order)));
  }
  Vector3 imageOf(const Vector3& vector, int steps, int order) const
  {
    return steps == 0 ? vector : turned(vector, stepAngle(steps, order));
  }

private:
  static double stepAngle(int steps, int order) { return 2 * kPi * steps / order; }
};

} // namespace quadrille
