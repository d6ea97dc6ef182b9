// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/UvRays.h"

namespace quadrille
{
namespace
{

/// Flips that a line may take: each lessens its crossings or is one of a few that only prepare one.
constexpr std::size_t kFlipsPerCrossing = 16;

FixedVec2 unitAlong(int axis)
{
  return rotate(FixedVec2{ 1, 0 }, axis);
}

std::int64_t dot(FixedVec2 a, FixedVec2 b)
{
  return a.u * b.u + a.v * b.v;
}

/// Of a unit vector along an axis and any other: exact in 64 bits.
std::int64_t side(FixedVec2 unit, FixedVec2 p)
{
  return unit.u * p.v - unit.v * p.u;
}

/// From the half-edge at the corner, which counts, counterclockwise to the other side of the face, which does not.
bool liesInSector(const UvMesh& mesh, UvDirection direction)
{
  const FixedVec2 unit = unitAlong(direction.axis);
  const FixedVec2 first = mesh.vector(direction.corner);
  const FixedVec2 last = -mesh.vector(Mesh::previous(direction.corner));
  return side(unit, first) <= 0 && side(unit, last) > 0;
}

/// A line that has entered a face through `entry`, and where it began, in the chart of that face.
struct Front
{
  Index entry;
  FixedVec2 start;
  int axis;
};

Front enterThrough(const UvMesh& mesh, Index h, FixedVec2 start, int axis)
{
  const Transition change = mesh.transition(h);
  return { mesh.twin[h], change.apply(start), (axis + change.rotation) & 3 };
}

bool isCurve(const UvMesh& mesh, Index h)
{
  return mesh.twin[h] == kInvalidIndex || (mesh.flags[h] & kUvConstrained) != 0;
}

/// Through one face: to its third corner, or out of one of the two other sides.
Index sideOut(const UvMesh& mesh, const Front& front)
{
  const Index third = Mesh::previous(front.entry);
  const std::int64_t s = side(unitAlong(front.axis), mesh.uv[third] - front.start);
  return s == 0 ? kInvalidIndex : s > 0 ? Mesh::next(front.entry) : third;
}

/// Whether both ends of the half-edge lie farther along the line than that.
bool isBeyond(const UvMesh& mesh, Index h, const Front& front, std::int64_t length)
{
  const FixedVec2 unit = unitAlong(front.axis);
  return dot(unit, mesh.uv[h] - front.start) > length &&
    dot(unit, mesh.uv[Mesh::next(h)] - front.start) > length;
}

/// Where the line begins after a flip of an edge of its first face; `other` is the new corner at the same vertex.
bool findStart(const UvMesh& mesh, UvDirection other, UvDirection& start)
{
  if (liesInSector(mesh, start))
  {
    return true;
  }
  const bool sameVertex = mesh.origin[other.corner] == mesh.origin[start.corner];
  start = other;
  return sameVertex && liesInSector(mesh, other);
}

} // namespace

std::vector<UvDirection> axisDirections(const UvMesh& mesh, Index v)
{
  std::vector<UvDirection> result;
  for (const Index h : mesh.star(v))
  {
    for (int axis = 0; axis < 4; ++axis)
    {
      if (liesInSector(mesh, { h, axis }))
      {
        result.push_back({ h, axis });
      }
    }
  }
  return result;
}

UvRay followLine(
  const UvMesh& mesh, UvDirection start, std::int64_t maximumLength, bool stopAtCurves)
{
  UvRay ray;
  const FixedVec2 first = mesh.vector(start.corner);
  if (side(unitAlong(start.axis), first) == 0)
  {
    ray.end = { Mesh::next(start.corner), start.axis };
    ray.length = dot(unitAlong(start.axis), first);
    return ray;
  }
  Front front{ start.corner, mesh.uv[start.corner], start.axis };
  for (Index out = Mesh::next(start.corner); out != kInvalidIndex;)
  {
    if (mesh.twin[out] == kInvalidIndex || (stopAtCurves && isCurve(mesh, out)))
    {
      ray.curve = out;
      return ray;
    }
    if (isBeyond(mesh, out, front, maximumLength))
    {
      return ray;
    }
    ray.crossed.push_back(out);
    front = enterThrough(mesh, out, front.start, front.axis);
    out = sideOut(mesh, front);
  }
  const Index corner = Mesh::previous(front.entry);
  const std::int64_t length = dot(unitAlong(front.axis), mesh.uv[corner] - front.start);
  if (length <= maximumLength)
  {
    ray.end = { corner, front.axis };
    ray.length = length;
  }
  return ray;
}

std::optional<UvDirection> straightOn(const UvMesh& mesh, UvDirection end)
{
  UvDirection on = end;
  do
  {
    if (liesInSector(mesh, on))
    {
      return on;
    }
    const Index h = Mesh::previous(on.corner);
    if (mesh.twin[h] == kInvalidIndex)
    {
      return std::nullopt;
    }
    on = { mesh.twin[h], (on.axis + mesh.rotation[h]) & 3 };
  } while (on.corner != end.corner);
  return std::nullopt;
}

std::optional<UvDirection> makeEdgeAlong(
  UvMesh& mesh, UvEditor& editor, UvDirection start, std::int64_t maximumLength)
{
  UvRay ray = followLine(mesh, start, maximumLength, true);
  std::size_t budget = kFlipsPerCrossing * (ray.crossed.size() + 1);
  std::size_t turn = 0;
  while (ray.meetsVertex() && !ray.crossed.empty() && budget-- > 0)
  {
    // Those that can be flipped one after the other, so that none goes back and forth for ever.
    Index chosen = kInvalidIndex;
    for (std::size_t i = 0; i < ray.crossed.size() && chosen == kInvalidIndex; ++i)
    {
      const Index h = ray.crossed[(turn + i) % ray.crossed.size()];
      const Index g = mesh.twin[h];
      mesh.flags[h] = mesh.flags[g] = static_cast<std::uint8_t>(mesh.flags[h] & ~kUvKept);
      if (editor.canFlip(h))
      {
        chosen = h;
        turn = (turn + i) % ray.crossed.size();
      }
    }
    if (chosen == kInvalidIndex)
    {
      return std::nullopt;
    }
    const std::size_t before = ray.crossed.size();
    const Index twin = mesh.twin[chosen];
    // The corner that the flip makes at the vertex opposite to the edge, seen from the line's first face.
    const bool fromTwin = twin == Mesh::next(start.corner);
    const int rotation = mesh.rotation[fromTwin ? twin : chosen];
    editor.flip(chosen);
    if (!findStart(
          mesh, { Mesh::next(fromTwin ? chosen : twin), (start.axis + rotation) & 3 }, start))
    {
      return std::nullopt;
    }
    ray = followLine(mesh, start, maximumLength, true);
    turn += ray.crossed.size() < before ? 0 : 1;
  }
  if (!ray.meetsVertex() || !ray.crossed.empty())
  {
    return std::nullopt;
  }
  return start;
}

} // namespace quadrille
