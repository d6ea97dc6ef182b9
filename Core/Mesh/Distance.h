// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Distances of points, and nearest places.
#pragma once

#include "Mesh/Mesh.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

/// The place on the segment from a to b nearest to p; the segment may be a point.
inline Vector3 nearestOnSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
  return a + t * ab;
}

/// From p to the segment from a to b, which may be a point.
inline double distanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

/// From p to face f of the mesh: over its inside, else to the nearest side.
inline double distanceToFace(const Mesh& mesh, Index f, const Vector3& p)
{
  const Vector3 normal = mesh.doubleAreaNormal(f);
  bool inside = normal.squaredNorm() > 0;
  double toSides = kInfinity;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    const Vector3& a = mesh.position[mesh.origin[h]];
    toSides = std::min(toSides, distanceToSegment(p, a, mesh.position[mesh.target(h)]));
    inside = inside && normal.dot(mesh.edgeVector(h).cross(p - a)) >= 0;
  }
  return inside ? std::abs(normal.normalized().dot(p - mesh.position[mesh.origin[3 * f]]))
                : toSides;
}

/// The place on the triangle a b c nearest to p; the triangle may have no area.
inline Vector3 nearestOnTriangle(
  const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c)
{
  const Vector3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  const double u = normal.dot((c - b).cross(p - b));
  const double v = normal.dot((a - c).cross(p - c));
  const double w = normal.dot((b - a).cross(p - a));
  if (area > 0 && u >= 0 && v >= 0 && w >= 0)
  {
    return (u * a + v * b + w * c) / (u + v + w);
  }
  Vector3 nearest = nearestOnSegment(p, a, b);
  for (const Vector3& other : { nearestOnSegment(p, b, c), nearestOnSegment(p, c, a) })
  {
    nearest = (p - other).squaredNorm() < (p - nearest).squaredNorm() ? other : nearest;
  }
  return nearest;
}

} // namespace quadrille
