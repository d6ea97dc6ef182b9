// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface that needs several attempts, of which the first has quads.
#pragma once

#include "MeshInput.h"
#include "TestMeshes.h"

#include <algorithm>
#include <cmath>

namespace quadrille::test
{

/// A sphere with connections that all cross each other at its pole, where quads have edges in two directions only: of
/// some 100 quads no map has all of them while the other irregular vertices stay. angle: from the pole to the ends.
inline SurfaceInput sphereWithoutRoom(double angle = 0.85)
{
  constexpr int kConnections = 3;
  SurfaceInput input = test::toInput(test::sphere(3));
  for (int k = 0; k < kConnections; ++k)
  {
    CurveRequest connection;
    for (const double side : { -1.0, 1.0 })
    {
      const double around = M_PI * k / kConnections;
      const Vector3 end(side * std::sin(angle) * std::cos(around),
        side * std::sin(angle) * std::sin(around), std::cos(angle));
      connection.points.push_back(*std::min_element(input.points.begin(), input.points.end(),
        [&](const Vector3& a, const Vector3& b)
        { return (a - end).squaredNorm() < (b - end).squaredNorm(); }));
    }
    input.curves.push_back(connection);
  }
  return input;
}

} // namespace quadrille::test
