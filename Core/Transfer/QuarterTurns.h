// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The rotation of a transition from the two images of an edge.
#pragma once

#include "Base/FixedPoint.h"

namespace quadrille
{

/// Quarter turns that carry `from` to `to`, exactly; -1 when none does, or all of them (zero length).
inline int quarterTurns(FixedVec2 from, FixedVec2 to)
{
  if (from == to)
  {
    return from == FixedVec2{} ? -1 : 0;
  }
  for (int r = 1; r < 4; ++r)
  {
    if (rotate(from, r) == to)
    {
      return r;
    }
  }
  return -1;
}

} // namespace quadrille
