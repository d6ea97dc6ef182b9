// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface that needs several attempts, of which the first has quads.
#pragma once

#include "MeshInput.h"
#include "TestMeshes.h"

#include <array>

namespace quadrille::test
{

/// A sphere with a vertex of three triangles that is to become one of seven quads: each triangle has less than two
/// right angles, so three have room for five quads at most. The coarse level has a map, that of the surface has folds
/// there whatever is tried.
inline SurfaceInput sphereWithoutRoom()
{
  SurfaceInput input = test::toInput(test::sphere(3));
  const Index middle = static_cast<Index>(input.points.size());
  const std::array<Index, 3> t{ input.polygonPoints[0], input.polygonPoints[1],
    input.polygonPoints[2] };
  input.points.push_back((input.points[t[0]] + input.points[t[1]] + input.points[t[2]]) / 3);
  input.polygonPoints.edit()[2] = middle;
  for (const std::size_t i : { 1U, 2U })
  {
    input.polygonPoints.append({ t[i], t[(i + 1) % 3], middle });
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
  }
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[middle] = 7;
  return input;
}

} // namespace quadrille::test
