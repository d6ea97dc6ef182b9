// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shape of one quad.
#pragma once

#include "Base/Types.h"

#include "Base/Lists.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

/// Normal of the quad at its centre, four times as long as its area is large (of the projection along the normal).
inline Vector3 centreNormal(const std::array<Vector3, 4>& p)
{
  return (p[1] - p[0] + p[2] - p[3]).cross(p[2] - p[1] + p[3] - p[0]);
}

/// Of the diagonals, twice as long as the quad's area is large.
inline Vector3 diagonalNormal(const std::array<Vector3, 4>& p)
{
  return (p[2] - p[0]).cross(p[3] - p[1]);
}

/// Scaled Jacobian as in the Verdict library: the smallest of the four normalized corner
/// determinants with respect to the normal of the quad's centre. 1 for a rectangle, <= 0 where the
/// quad is not convex; 0 for a vanishing edge or normal.
inline double scaledJacobian(const std::array<Vector3, 4>& p)
{
  const Vector3 normal = centreNormal(p);
  const double area = normal.norm();
  double worst = 1;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Vector3 in = p[i] - p[(i + 3) % 4];
    const Vector3 out = p[(i + 1) % 4] - p[i];
    const double scale = area * in.norm() * out.norm();
    if (!(scale > 0))
    {
      return 0;
    }
    worst = std::min(worst, normal.dot(in.cross(out)) / scale);
  }
  return worst;
}

/// Quads with a smaller scaled Jacobian are bad: points move to mend them, and what is left of them is replaced.
constexpr double kLeastShape = 0.1;

/// How good some quads are.
struct QuadScore
{
  std::size_t inverted = 0, bad = 0; ///< inverted ones are bad, too
  double worst = 1;                  ///< shape

  bool hasFewerThan(const QuadScore& other) const
  {
    return inverted < other.inverted || (inverted == other.inverted && bad < other.bad);
  }
  bool betterThan(const QuadScore& other) const
  {
    return hasFewerThan(other) ||
      (inverted == other.inverted && bad == other.bad && worst > other.worst);
  }
};

/// The corners of a quad of points.
inline std::array<Vector3, 4> cornersOf(
  const std::vector<Vector3>& points, const std::array<Index, 4>& quad)
{
  return { points[quad[0]], points[quad[1]], points[quad[2]], points[quad[3]] };
}

/// Is the scaled Jacobian <= 0? Without lengths, which only scale the determinants.
inline bool isInverted(const std::array<Vector3, 4>& p)
{
  const Vector3 normal = centreNormal(p);
  for (std::size_t i = 0; i < 4; ++i)
  {
    if (!(normal.dot((p[i] - p[(i + 3) % 4]).cross(p[(i + 1) % 4] - p[i])) > 0))
    {
      return true;
    }
  }
  return false;
}

/// The quads with a scaled Jacobian below kLeastShape, ascending.
inline std::vector<Index> badQuads(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads)
{
  return idsWhere(quads.size(),
    [&](Index q) { return scaledJacobian(cornersOf(points, quads[q])) < kLeastShape; });
}

/// The quads with a scaled Jacobian <= 0, ascending.
inline std::vector<Index> invertedQuads(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads)
{
  return idsWhere(quads.size(), [&](Index q) { return isInverted(cornersOf(points, quads[q])); });
}

} // namespace quadrille
