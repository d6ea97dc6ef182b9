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

/// Where a line leaves a face. Vertices on it count as left of it, which makes the way unique.
Index wayOut(const UvMesh& map, Index f, FixedVec2 p, int axis)
{
  const FixedVec2 unit = rotate(FixedVec2{ 1, 0 }, axis);
  const auto isLeft = [&](Index corner)
  {
    const FixedVec2 d = map.uv[corner] - p;
    return unit.u * d.v - unit.v * d.u >= 0;
  };
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (!isLeft(h) && isLeft(Mesh::next(h)))
    {
      return h;
    }
  }
  return kInvalidIndex;
}

/// Whether the line through p, along an axis of a face's chart, comes back to itself within the length.
bool closesOnItself(
  const UvMesh& map, Index face, FixedVec2 start, int axis, std::int64_t maximumLength)
{
  Index f = face;
  FixedVec2 p = start;
  int k = axis;
  for (std::size_t steps = 0; steps < 4 * map.alive.size(); ++steps)
  {
    const Index out = wayOut(map, f, p, k);
    if (out == kInvalidIndex || map.twin[out] == kInvalidIndex ||
      lengthAlong(map.uv[out] - p, k) > maximumLength)
    {
      return false;
    }
    const Transition change = map.transition(out);
    p = change.apply(p);
    k = (k + change.rotation) & 3;
    f = Mesh::face(map.twin[out]);
    if (f == face && k == axis && rotate(p - start, -axis).v == 0)
    {
      return true;
    }
  }
  return false;
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

bool hasClosedGridLine(const UvMesh& map, const Isoline& line, std::int64_t maximumLength)
{
  int axis = line.axis;
  Index f = Mesh::face(line.start);
  for (const Index h : line.crossed)
  {
    // In coordinates whose u runs along the line.
    const std::array<FixedVec2, 3> corner{ rotate(map.uv[3 * f], -axis),
      rotate(map.uv[3 * f + 1], -axis), rotate(map.uv[3 * f + 2], -axis) };
    const auto [low, high] = std::minmax({ corner[0].v, corner[1].v, corner[2].v });
    for (std::int64_t v = unitAbove(low - 1); v <= high; v += kOne)
    {
      for (const std::int64_t beside : { v - 1, v + 1 })
      {
        const FixedVec2 p = rotate(FixedVec2{ corner[0].u, beside }, axis);
        if (beside > low && beside < high && closesOnItself(map, f, p, axis, maximumLength))
        {
          return true;
        }
      }
    }
    axis = (axis + map.rotation[h]) & 3;
    f = Mesh::face(map.twin[h]);
  }
  return false;
}

} // namespace quadrille
