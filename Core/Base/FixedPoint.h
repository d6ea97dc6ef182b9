// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parameter-space points on a 2^-24 grid, exact transitions between charts, exact orientation.
/// One unit (kOne) is one quad. Coordinates stay below 2^44 in magnitude, so that a determinant of
/// differences needs at most 91 bits and __int128 is exact.
#pragma once

#include "Base/Types.h"

#include <cmath>
#include <cstdint>

namespace quadrille
{

constexpr int kFractionBits = 24;
constexpr std::int64_t kOne = std::int64_t{ 1 } << kFractionBits;
/// The determinant of a unit square.
constexpr double kUnitArea = static_cast<double>(kOne) * static_cast<double>(kOne);

// GCC spells its 128-bit type as an extension; the keyword keeps -Wpedantic builds of users quiet.
__extension__ typedef __int128 Int128;

/// The quotient rounded down; b is not 0.
inline Int128 floorDivide(Int128 a, Int128 b)
{
  const Int128 q = a / b;
  return q - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0);
}

/// The first whole coordinate above x.
inline std::int64_t unitAbove(std::int64_t x)
{
  return (x & ~(kOne - 1)) + kOne;
}

/// A point or vector of the parameter domain in units of 2^-24 quads.
struct FixedVec2
{
  std::int64_t u = 0;
  std::int64_t v = 0;

  friend FixedVec2 operator+(FixedVec2 a, FixedVec2 b) { return { a.u + b.u, a.v + b.v }; }
  friend FixedVec2 operator-(FixedVec2 a, FixedVec2 b) { return { a.u - b.u, a.v - b.v }; }
  friend FixedVec2 operator-(FixedVec2 a) { return { -a.u, -a.v }; }
  friend bool operator==(FixedVec2 a, FixedVec2 b) { return a.u == b.u && a.v == b.v; }
  friend bool operator!=(FixedVec2 a, FixedVec2 b) { return !(a == b); }
};

/// Rotates by r quarter turns counterclockwise; r may be any integer.
inline FixedVec2 rotate(FixedVec2 p, int r)
{
  switch (r & 3)
  {
    case 1:
      return { -p.v, p.u };
    case 2:
      return { -p.u, -p.v };
    case 3:
      return { p.v, -p.u };
    default:
      return p;
  }
}

/// Twice the signed area of (a, b, c) in units of 2^-48; positive when counterclockwise. Exact.
inline Int128 determinant(FixedVec2 a, FixedVec2 b, FixedVec2 c)
{
  const FixedVec2 p = b - a;
  const FixedVec2 q = c - a;
  return Int128{ p.u } * q.v - Int128{ p.v } * q.u;
}

/// +1, 0 or -1 as (a, b, c) is counterclockwise, degenerate or clockwise. Exact.
inline int orientation(FixedVec2 a, FixedVec2 b, FixedVec2 c)
{
  const Int128 d = determinant(a, b, c);
  return (d > 0) - (d < 0);
}

/// A chart change p -> R90^rotation p + translation. Exact under composition and inversion.
struct Transition
{
  int rotation = 0; ///< quarter turns counterclockwise, 0..3
  FixedVec2 translation;

  FixedVec2 apply(FixedVec2 p) const { return rotate(p, rotation) + translation; }
  Transition inverse() const { return { (4 - rotation) & 3, -rotate(translation, 4 - rotation) }; }
  /// this after first: p -> this(first(p)).
  Transition after(const Transition& first) const
  {
    return { (rotation + first.rotation) & 3, apply(first.translation) };
  }
  bool isIdentity() const { return rotation == 0 && translation == FixedVec2{}; }
  friend bool operator==(const Transition& a, const Transition& b)
  {
    return a.rotation == b.rotation && a.translation == b.translation;
  }
};

inline bool isInteger(std::int64_t x)
{
  return (x & (kOne - 1)) == 0;
}
inline bool isInteger(FixedVec2 p)
{
  return isInteger(p.u) && isInteger(p.v);
}

/// Nearest grid value of a coordinate given in quads.
inline std::int64_t toFixed(double x)
{
  return static_cast<std::int64_t>(std::llround(x * static_cast<double>(kOne)));
}
inline FixedVec2 toFixed(const Vector2& p)
{
  return { toFixed(p.x()), toFixed(p.y()) };
}
inline double toDouble(std::int64_t x)
{
  return static_cast<double>(x) / static_cast<double>(kOne);
}
inline Vector2 toDouble(FixedVec2 p)
{
  return { toDouble(p.u), toDouble(p.v) };
}

} // namespace quadrille
