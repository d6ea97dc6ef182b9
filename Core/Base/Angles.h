// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Angles are radians in Core; degrees appear at the user's surface only.
#pragma once

namespace quadrille
{

constexpr double kPi = 3.14159265358979323846;
/// A quarter turn, by which charts and crosses differ.
constexpr double kRightAngle = kPi / 2;

constexpr double radians(double degrees)
{
  return degrees * kPi / 180;
}

} // namespace quadrille
