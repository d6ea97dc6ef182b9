// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Maps of known meshes and exact checks of maps.
#pragma once

#include "Base/FixedPoint.h"
#include "BothPhases.h"
#include "GridMap/MapCheck.h"
#include "Hierarchy/Hierarchy.h"
#include "TestMeshes.h"

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace quadrille::test
{

constexpr double kFeatureAngle = 0.7; // radians, 40 degrees

inline Hierarchy decimate(const Mesh& mesh, double edgeLength, Index vertices, int threads = 1)
{
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = vertices;
  options.threads = threads;
  return buildHierarchy(mesh, 1, options);
}

/// uv of every corner from its position.
inline std::vector<FixedVec2> mapByPosition(
  const Mesh& mesh, const std::function<Vector2(const Vector3&)>& map)
{
  std::vector<FixedVec2> uv;
  for (const Index v : mesh.origin)
  {
    uv.push_back(toFixed(map(mesh.position[v])));
  }
  return uv;
}

/// Quarter turns round each vertex of a map without inverted triangles.
inline std::vector<int> turnsOf(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<int> turns(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    turns[mesh.origin[h]] += quadrantsEntered(&uv[3 * (h / 3)], static_cast<int>(h % 3), 1);
  }
  return turns;
}

/// Edges whose two images are not related by a quarter turn: must be none, exactly.
inline std::size_t seamResiduals(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      continue;
    }
    const Index g = mesh.twin[h];
    const FixedVec2 here = uv[Mesh::next(h)] - uv[h];
    const FixedVec2 there = uv[g] - uv[Mesh::next(g)];
    bool matches = false;
    for (int r = 0; r < 4; ++r)
    {
      matches = matches || rotate(here, r) == there;
    }
    count += matches ? 0 : 1;
  }
  return count;
}

inline std::size_t constrainedEdgesOffAxis(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const FixedVec2 edge = uv[Mesh::next(h)] - uv[h];
    count += mesh.isConstrained(h) && edge.u != 0 && edge.v != 0 ? 1 : 0;
  }
  return count;
}

inline std::size_t notPositive(const std::vector<FixedVec2>& uv)
{
  std::size_t count = 0;
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    count += determinant(uv[h], uv[h + 1], uv[h + 2]) > 0 ? 0 : 1;
  }
  return count;
}

/// Torus whose angles are its map: uv by unwrapping each triangle from its first corner, so that transitions
/// are translations by the periods.
inline std::vector<FixedVec2> torusMap(const Mesh& mesh, double radius, std::int64_t periodU,
  std::int64_t periodV, const std::function<FixedVec2(Index)>& offset)
{
  const auto angles = [&](const Vector3& p)
  {
    const double r = p.head<2>().norm();
    return FixedVec2{ static_cast<std::int64_t>(
                        std::llround(std::atan2(p.y(), p.x()) / (2 * kPi) * double(periodU))),
      static_cast<std::int64_t>(
        std::llround(std::atan2(p.z(), r - radius) / (2 * kPi) * double(periodV))) };
  };
  const auto wrapTo = [](std::int64_t value, std::int64_t reference, std::int64_t period)
  {
    const double turns = std::round(double(reference - value) / double(period));
    return value + static_cast<std::int64_t>(turns) * period;
  };
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const FixedVec2 base = angles(mesh.position[mesh.origin[h - h % 3]]);
    FixedVec2 p = angles(mesh.position[mesh.origin[h]]);
    p = { wrapTo(p.u, base.u, periodU), wrapTo(p.v, base.v, periodV) };
    uv[h] = p + offset(mesh.origin[h]);
  }
  return uv;
}

/// The flat map of each side of the unit cube in a chart of its own, turned by as many quarters as the number
/// of the side: transitions between sides are rotations with translations.
/// `moved`: positions to map instead of the cube's own, each still on its sides.
inline std::vector<FixedVec2> cubeMap(
  const Mesh& mesh, double scale, const std::vector<Vector3>* moved = nullptr)
{
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 n = faceNormal(mesh, f);
    Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const int side = static_cast<int>(2 * axis) + (n[axis] > 0 ? 0 : 1);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Vector3& p = (moved != nullptr ? *moved : mesh.position.vector())[mesh.origin[h]];
      Vector2 flat(p[(axis + 1) % 3], p[(axis + 2) % 3]);
      if (n[axis] < 0)
      {
        std::swap(flat.x(), flat.y()); // keeps the orientation of the side seen from outside
      }
      uv[h] = rotate(toFixed(Vector2(flat * scale)), side) + FixedVec2{ side * 7 * kOne, 0 };
    }
  }
  return uv;
}

} // namespace quadrille::test
