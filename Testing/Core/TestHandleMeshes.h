// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A closed surface with a handle far smaller than itself.
#pragma once

#include "TestMeshes.h"

namespace quadrille::test
{

struct SphereWithHandle
{
  Mesh mesh;
  double mouthLength; ///< round the mouth of the handle
};

/// The unit sphere with a handle at a place on it: the two triangles nearest to the place that have no vertex in common
/// are taken out and joined by a tube of `rings` rings that bows out by `height`.
inline SphereWithHandle sphereWithHandle(
  int level, const Vector3& place, int rings = 6, double height = 0.1)
{
  const Mesh ball = sphere(level);
  const auto corner = [&](Index f, Index i) { return ball.origin[3 * f + i % 3]; };
  const auto middle = [&](Index f) -> Vector3
  {
    return (ball.position[corner(f, 0)] + ball.position[corner(f, 1)] +
             ball.position[corner(f, 2)]) /
      3;
  };
  const auto nearest = [&](const std::function<bool(Index)>& allowed)
  {
    Index best = kInvalidIndex;
    for (Index f = 0; f < ball.faceCount(); ++f)
    {
      if (allowed(f) &&
        (best == kInvalidIndex || (middle(f) - place).norm() < (middle(best) - place).norm()))
      {
        best = f;
      }
    }
    return best;
  };
  const auto adjacent = [&](Index f, Index g)
  {
    for (Index i = 0; i < 9; ++i)
    {
      if (corner(f, i / 3) == corner(g, i % 3))
      {
        return true;
      }
    }
    return false;
  };
  const Index first = nearest([](Index) { return true; });
  const Index second = nearest([&](Index f) { return !adjacent(f, first); });

  std::vector<Vector3> points = ball.position;
  std::vector<Triangle> triangles;
  for (Index f = 0; f < ball.faceCount(); ++f)
  {
    if (f != first && f != second)
    {
      triangles.push_back({ corner(f, 0), corner(f, 1), corner(f, 2) });
    }
  }
  // The far mouth is met in the opposite sense; begin at the corner that makes the tube turn least.
  Index shift = 0;
  const auto far = [&](Index i, Index s) { return corner(second, s + 3 - i % 3); };
  const auto way = [&](Index s)
  {
    double sum = 0;
    for (Index i = 0; i < 3; ++i)
    {
      sum += (points[corner(first, i)] - points[far(i, s)]).squaredNorm();
    }
    return sum;
  };
  for (const Index s : { Index{ 1 }, Index{ 2 } })
  {
    shift = way(s) < way(shift) ? s : shift;
  }
  std::vector<std::array<Index, 3>> ring{ { corner(first, 0), corner(first, 1),
    corner(first, 2) } };
  for (int k = 1; k < rings; ++k)
  {
    const double t = static_cast<double>(k) / rings;
    std::array<Index, 3> next{};
    for (Index i = 0; i < 3; ++i)
    {
      next[i] = static_cast<Index>(points.size());
      points.push_back((1 - t) * ball.position[corner(first, i)] +
        t * ball.position[far(i, shift)] + 4 * t * (1 - t) * height * place);
    }
    ring.push_back(next);
  }
  ring.push_back({ far(0, shift), far(1, shift), far(2, shift) });
  double mouth = 0;
  for (std::size_t k = 0; k + 1 < ring.size(); ++k)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Index a = ring[k][i], b = ring[k][(i + 1) % 3];
      const Index c = ring[k + 1][i], d = ring[k + 1][(i + 1) % 3];
      triangles.push_back({ a, b, d });
      triangles.push_back({ a, d, c });
      mouth += k == 0 ? (points[b] - points[a]).norm() : 0;
    }
  }
  return { makeMesh(std::move(points), triangles), mouth };
}

} // namespace quadrille::test
