// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The symmetries of quads: reflections about a plane, and rotations by a step round an axis.
#pragma once

#include "Base/Angles.h"
#include "Base/Types.h"

#include <cmath>

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
};

/// One of both. It and its powers are a group: the reflection and nothing, or the turns by 0 to order - 1 steps. What
/// of a surface has no point in common with its images, but for its border, is a part of it, and the images of a part
/// are the whole: what lies in front of the plane, or in a wedge between two half planes that end in the axis.
struct Isometry
{
  Vector3 origin = Vector3::Zero();     ///< in the plane, or on the axis
  Vector3 direction = Vector3::UnitX(); ///< unit; the normal, or that of the axis
  int order = 2;                        ///< as many times it is nothing
  bool isReflection = true;

  static Isometry of(const MirrorPlane& plane) { return { plane.origin, plane.normal, 2, true }; }
  static Isometry of(const RotationAxis& axis, int order)
  {
    return { axis.origin, axis.direction, order, false };
  }

  /// Of a reflection.
  MirrorPlane plane() const { return { origin, direction }; }
  /// Of a rotation.
  RotationAxis axis() const { return { origin, direction }; }

  /// power: how often it is applied, below zero its inverse.
  Vector3 image(const Vector3& p, int power = 1) const
  {
    return power == 0   ? p
      : !isReflection   ? Vector3(origin + axis().turned(p - origin, angle(power)))
      : reverses(power) ? plane().image(p)
                        : p;
  }
  /// Of a vector.
  Vector3 imageOf(const Vector3& vector, int power = 1) const
  {
    return power == 0   ? vector
      : !isReflection   ? axis().turned(vector, angle(power))
      : reverses(power) ? plane().imageOf(vector)
                        : vector;
  }
  /// Whether this power of it turns faces over.
  bool reverses(int power) const { return isReflection && power % 2 != 0; }
  /// The nearest point that is its own image.
  Vector3 foot(const Vector3& p) const { return isReflection ? plane().foot(p) : axis().foot(p); }
  /// Whether a point is its own image, up to the tolerance.
  bool fixes(const Vector3& p, double tolerance) const
  {
    return (isReflection ? std::abs(plane().height(p)) : axis().radial(p).norm()) <= tolerance;
  }

private:
  double angle(int steps) const { return 2 * kPi * steps / order; }
};

} // namespace quadrille
