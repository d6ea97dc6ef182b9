// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/AxisLines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace quadrille
{

namespace
{

void flagAsCurve(UvMesh& map, Index h)
{
  map.flags[h] |= kUvConstrained;
  if (map.twin[h] != kInvalidIndex)
  {
    map.flags[map.twin[h]] |= kUvConstrained;
  }
}

} // namespace

std::int64_t lengthAlong(FixedVec2 p, int axis)
{
  return rotate(p, -axis).u;
}

LineStop followThrough(const UvMesh& map, UvDirection direction, std::int64_t maximumLength,
  const std::vector<std::uint8_t>& flags, bool stopAtCurves)
{
  LineStop end;
  while (end.length < maximumLength)
  {
    const UvRay ray = followLine(map, direction, maximumLength - end.length, stopAtCurves);
    if (!ray.meetsVertex())
    {
      end.curve = ray.curve;
      return end;
    }
    end.length += ray.length;
    const Index v = map.origin[ray.end.corner];
    const std::optional<UvDirection> on = straightOn(map, ray.end);
    if (flags[v] != 0 || !on)
    {
      end.vertex = v;
      return end;
    }
    direction = *on;
  }
  return end;
}

bool lockParts(UvMesh& map, UvEditor& editor, UvDirection direction, std::int64_t length)
{
  while (true)
  {
    const std::optional<UvDirection> edge = makeEdgeAlong(map, editor, direction, length);
    if (!edge)
    {
      return false;
    }
    flagAsCurve(map, edge->corner);
    length -= lengthAlong(map.vector(edge->corner), edge->axis);
    if (length <= 0)
    {
      return true;
    }
    const std::optional<UvDirection> on = straightOn(map, { Mesh::next(edge->corner), edge->axis });
    if (!on)
    {
      return false;
    }
    direction = *on;
  }
}

} // namespace quadrille
