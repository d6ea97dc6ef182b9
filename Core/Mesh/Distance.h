// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Distances of points.
#pragma once

#include "Base/Types.h"

#include <algorithm>

namespace quadrille
{

/// From p to the segment from a to b, which may be a point.
inline double distanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

} // namespace quadrille
