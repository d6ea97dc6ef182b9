// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Isosurfaces on coarse grids, as visualization tools make them: triangles of all shapes, facets with angles of all
/// sizes, islands.
#pragma once

#include "TestMeshes.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace quadrille::test
{

/// Marching tetrahedra: where `field` is 0 between points of the cubic grid with spacing 1 and coordinates -extent to
/// extent. Outwards is where the field is positive; open where the surface meets the sides of the grid.
inline Mesh isosurface(int extent, const std::function<double(const Vector3&)>& field)
{
  const int side = 2 * extent + 1;
  const auto idOf = [&](int x, int y, int z) { return (z * side + y) * side + x; };
  const auto placeOf = [&](int id) -> Vector3
  { return Vector3(id % side - extent, id / side % side - extent, id / side / side - extent); };
  std::vector<double> value;
  for (int id = 0; id < side * side * side; ++id)
  {
    value.push_back(field(placeOf(id)));
  }
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  std::map<std::pair<int, int>, Index> cuts;
  const auto cut = [&](int a, int b)
  {
    const std::pair<int, int> key = std::minmax(a, b);
    const auto found = cuts.try_emplace(key, static_cast<Index>(points.size()));
    if (found.second)
    {
      const double t = value[key.first] / (value[key.first] - value[key.second]);
      points.push_back(placeOf(key.first) + t * (placeOf(key.second) - placeOf(key.first)));
    }
    return found.first->second;
  };
  const auto add = [&](Index a, Index b, Index c, const Vector3& outwards)
  {
    const Vector3 normal = (points[b] - points[a]).cross(points[c] - points[a]);
    triangles.push_back(normal.dot(outwards) > 0 ? Triangle{ a, b, c } : Triangle{ a, c, b });
  };
  const auto addTetrahedron = [&](const std::array<int, 4>& t)
  {
    std::vector<int> in, out;
    for (const int v : t)
    {
      (value[v] < 0 ? in : out).push_back(v);
    }
    if (in.size() == 1 || out.size() == 1)
    {
      const int tip = in.size() == 1 ? in[0] : out[0];
      const std::vector<int>& rest = in.size() == 1 ? out : in;
      const Vector3 away =
        (placeOf(rest[0]) + placeOf(rest[1]) + placeOf(rest[2])) / 3 - placeOf(tip);
      add(cut(tip, rest[0]), cut(tip, rest[1]), cut(tip, rest[2]),
        in.size() == 1 ? away : Vector3(-away));
    }
    else if (in.size() == 2)
    {
      const Vector3 away =
        (placeOf(out[0]) + placeOf(out[1]) - placeOf(in[0]) - placeOf(in[1])) / 2;
      const Index a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]),
                  d = cut(in[1], out[0]);
      add(a, b, c, away);
      add(a, c, d, away);
    }
  };
  constexpr std::array<std::array<int, 3>, 6> orders{ { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 },
    { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } } };
  for (int z = 0; z + 1 < side; ++z)
  {
    for (int y = 0; y + 1 < side; ++y)
    {
      for (int x = 0; x + 1 < side; ++x)
      {
        for (const std::array<int, 3>& order : orders)
        {
          std::array<int, 3> at{ x, y, z };
          std::array<int, 4> t{ idOf(x, y, z), 0, 0, 0 };
          for (std::size_t i = 0; i < 3; ++i)
          {
            ++at[static_cast<std::size_t>(order[i])];
            t[i + 1] = idOf(at[0], at[1], at[2]);
          }
          addTetrahedron(t);
        }
      }
    }
  }
  return makeMesh(std::move(points), triangles);
}

/// A field of waves that a grid of spacing 1 hardly resolves, like ParaView's Wavelet.
inline double waves(const Vector3& p)
{
  return 1.6 * std::sin(1.1 * p.x() + 0.3) + 1.3 * std::sin(0.9 * p.y() + 0.7) +
    1.1 * std::cos(0.7 * p.z() + 0.2) - 0.011 * p.squaredNorm() + 0.35;
}

} // namespace quadrille::test
