// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quarter turns between charts: of vectors, and from the two images of an edge.
#pragma once

#include "Base/FixedPoint.h"

#include <optional>

namespace quadrille
{

/// Rotates by r quarter turns counterclockwise; r may be any integer.
inline Vector2 turned(const Vector2& p, int r)
{
  switch (r & 3)
  {
    case 1:
      return { -p.y(), p.x() };
    case 2:
      return -p;
    case 3:
      return { p.y(), -p.x() };
    default:
      return p;
  }
}

/// How many quarter turns carry `from` to `to`, 0 to 3, exactly; none where no number does, or where all do (length
/// zero).
inline std::optional<int> rotationBetween(FixedVec2 from, FixedVec2 to)
{
  if (from == to)
  {
    return from == FixedVec2{} ? std::nullopt : std::optional<int>(0);
  }
  for (int r = 1; r < 4; ++r)
  {
    if (rotate(from, r) == to)
    {
      return r;
    }
  }
  return std::nullopt;
}

} // namespace quadrille
