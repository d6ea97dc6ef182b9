// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// An open tube of four patches that no map with all their borders has, unless its quads are smaller than a gap.
#pragma once

#include "TestMeshes.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace quadrille::test
{

struct PatchedMesh
{
  Mesh mesh;
  std::vector<std::int64_t> patch; ///< per face
};

/// Two halves of a tube of radius 0.5 round the x axis, from -1 to 1, each cut across in two patches:
///
///    1 | 0        the one half in its middle, the other one askew, from `gap` beyond the middle on the one seam of the
///   ---+-+---     halves to as much before it on the other one. All patches have four corners, so opposite sides are
///     3 / 2       as long as each other in a map: where it leaves the gap room on the one seam, on the other one the
///   -+-+-----     curves end in the wrong order.
///    1 | 0
inline PatchedMesh staggeredTube(double gap)
{
  constexpr Index around = 24, along = 20, middle = along / 2, half = around / 2;
  const auto place = [gap](Index column)
  {
    const double k = static_cast<double>(column) - middle;
    const double beyond = gap + (1 - gap) * (std::abs(k) - 1) / (middle - 1);
    return k == 0 ? 0 : std::copysign(beyond, k);
  };
  // Where the border of the half that is cut askew is, by row.
  const auto border = [](Index row)
  {
    const Index t = row - half, third = half / 3;
    return t <= third ? middle + 1 : t <= 2 * third ? middle : middle - 1;
  };
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  PatchedMesh tube;
  const auto add = [&](Index a, Index b, Index c, std::int64_t patch)
  {
    triangles.push_back({ a, b, c });
    tube.patch.push_back(patch);
  };
  for (Index i = 0; i < around; ++i)
  {
    const double angle = 2 * kPi * i / around;
    for (Index j = 0; j <= along; ++j)
    {
      points.emplace_back(place(j), 0.5 * std::cos(angle), 0.5 * std::sin(angle));
    }
  }
  for (Index i = 0; i < around; ++i)
  {
    for (Index j = 0; j < along; ++j)
    {
      const Index a = i * (along + 1) + j, d = (i + 1) % around * (along + 1) + j;
      if (i < half)
      {
        const std::int64_t patch = j < middle ? 0 : 1;
        add(a, a + 1, d + 1, patch);
        add(a, d + 1, d, patch);
        continue;
      }
      // The diagonal runs as the border does where it changes its column.
      add(a, a + 1, d, j < border(i) ? 2 : 3);
      add(a + 1, d + 1, d, j < border(i + 1) ? 2 : 3);
    }
  }
  tube.mesh = makeMesh(std::move(points), triangles);
  return tube;
}

} // namespace quadrille::test
