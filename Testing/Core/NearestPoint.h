// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <vector>

namespace quadrille::test
{

inline Index nearestPoint(const std::vector<Vector3>& points, const Vector3& p)
{
  const auto nearer = [&](const Vector3& a, const Vector3& b)
  { return (a - p).norm() < (b - p).norm(); };
  return static_cast<Index>(
    std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

} // namespace quadrille::test
