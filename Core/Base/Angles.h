// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Angles are radians in Core; degrees appear at the user's surface only.
#pragma once

#include "Base/Types.h"

#include <cmath>

namespace quadrille
{

constexpr double kPi = 3.14159265358979323846;
/// A quarter turn, by which charts and crosses differ.
constexpr double kRightAngle = kPi / 2;

constexpr double radians(double degrees)
{
  return degrees * kPi / 180;
}

/// Direction change above which a curve of features or on the boundary has a corner at a vertex inside it.
constexpr double kCornerAngle = radians(40);

/// In [0, pi]. Unlike acos, atan2 stays accurate for nearly parallel vectors.
inline double angleBetween(const Vector3& a, const Vector3& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

} // namespace quadrille
