// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/Sight.h"

#include <algorithm>

namespace quadrille
{

Sight::Sight(const UvMesh& map, Index from, Index to, double maximumLength)
  : map_(map), to_(to), maximumLength_(maximumLength)
{
  for (const Index h : map.star(from))
  {
    const FixedVec2 eye = map.uv[h];
    first_ = h;
    meet(Mesh::next(h), { eye, map.uv[Mesh::next(h)] - eye, map.uv[Mesh::previous(h)] - eye });
  }
}

Int128 Sight::cross(FixedVec2 a, FixedVec2 b)
{
  return Int128{ a.u } * b.v - Int128{ a.v } * b.u;
}

void Sight::meet(Index out, const View& view)
{
  if (map_.twin[out] == kInvalidIndex || (map_.flags[out] & kUvConstrained) != 0 ||
    ++steps_ > kMostCurveSteps || isFar(out, view.eye))
  {
    return;
  }
  const Transition change = map_.transition(out);
  const View next{ change.apply(view.eye), rotate(view.right, change.rotation),
    rotate(view.left, change.rotation) };
  const Index g = map_.twin[out];
  const Index corner = Mesh::previous(g);
  const FixedVec2 there = map_.uv[corner] - next.eye;
  crossed_.push_back(out);
  rotation_ += change.rotation;
  const bool leftOfRight = cross(next.right, there) > 0;
  const bool rightOfLeft = cross(there, next.left) > 0;
  if (leftOfRight && rightOfLeft && map_.origin[corner] == to_)
  {
    lines_.push_back({ first_, corner, crossed_, rotate(there, -rotation_) });
  }
  // The face's other sides: next(g) lies right of the corner, as seen, previous(g) left of it.
  if (leftOfRight)
  {
    meet(Mesh::next(g), { next.eye, next.right, rightOfLeft ? there : next.left });
  }
  if (rightOfLeft)
  {
    meet(Mesh::previous(g), { next.eye, leftOfRight ? there : next.right, next.left });
  }
  rotation_ -= change.rotation;
  crossed_.pop_back();
}

bool Sight::isFar(Index h, FixedVec2 eye) const
{
  return std::min(toDouble(map_.uv[h] - eye).norm(),
           toDouble(map_.uv[Mesh::next(h)] - eye).norm()) > maximumLength_;
}

} // namespace quadrille
