// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Attempts as values, for tests of what is chosen of them and tried after them.
#pragma once

#include "Pipeline/Attempt.h"

#include <memory>
#include <utility>
#include <vector>

namespace quadrille::test
{

inline Plan planOf(const char* step)
{
  Plan plan;
  plan.step = step;
  return plan;
}

/// A map that reached the surface, with so many triangles that are not positive there.
inline std::shared_ptr<MapAttempt> carriedMap(std::size_t defects)
{
  auto map = std::make_shared<MapAttempt>();
  map->certificate.notPositive = defects;
  return map;
}

/// No map of the coarse level. failedAt: vertices of the surface.
inline std::shared_ptr<MapAttempt> failedMap(std::vector<Index> failedAt = {})
{
  auto map = std::make_shared<MapAttempt>();
  map->status = { StatusCode::NotConverged, "no valid map of the coarse mesh" };
  map->failedAt = std::move(failedAt);
  return map;
}

inline std::shared_ptr<QuadAttempt> quadsWith(std::size_t inverted)
{
  auto quads = std::make_shared<QuadAttempt>();
  quads->invertedQuads = inverted;
  quads->invertedAtFolds = inverted > 0;
  return quads;
}

inline std::shared_ptr<QuadAttempt> failedQuads(StatusCode code = StatusCode::NotConverged)
{
  auto quads = std::make_shared<QuadAttempt>();
  quads->status = { code, "no valid quad mesh" };
  return quads;
}

} // namespace quadrille::test
