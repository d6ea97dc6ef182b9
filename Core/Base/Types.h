// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Ids and small vectors that every module shares.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry> // cross(): declared by Core, defined only here

#include <cstddef>
#include <cstdint>
#include <limits>

namespace quadrille
{

/// Id of a vertex, face or half-edge. 32 bits hold half-edges of 1.4 billion faces.
using Index = std::uint32_t;

/// "No such element": the twin of a boundary half-edge, a removed face, ...
constexpr Index kInvalidIndex = std::numeric_limits<Index>::max();

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kInfinityOfSingle = std::numeric_limits<float>::infinity();

/// What rounding may leave of a length, an area or a weight that is zero, over the largest of its kind, or of the
/// difference of two that are equal.
constexpr double kRounding = 1e-9;
/// The same where coordinates may have been stored in single precision on the way.
constexpr double kRoundingOfSingle = 1e-6;
/// The last digits of a double, over its size: what a few operations with it may change.
constexpr double kLastDigits = 1e-12;

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// Signed area of the parallelogram of two vectors; positive where b lies counterclockwise of a.
inline double parallelogram(const Vector2& a, const Vector2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

} // namespace quadrille
