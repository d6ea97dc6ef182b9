// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Passes over all points of a surface by several threads.
#pragma once

#include "Base/Parallel.h"
#include "Base/Types.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace quadrille
{

/// Which points are the corner of a polygon.
class UsedPoints
{
public:
  /// corners: ids below `points`; kInvalidIndex is passed over.
  UsedPoints(const std::vector<Index>& corners, std::size_t points, int threads)
    : count_(points), used_(new std::atomic<std::uint8_t>[points])
  {
    parallelForEach(points, kLightChunk, threads,
      [&](std::size_t i) { used_[i].store(0, std::memory_order_relaxed); });
    parallelForEach(corners.size(), kLightChunk, threads,
      [&](std::size_t i)
      {
        if (corners[i] != kInvalidIndex)
        {
          used_[corners[i]].store(1, std::memory_order_relaxed);
        }
      });
  }

  bool has(std::size_t i) const { return used_[i].load(std::memory_order_relaxed) != 0; }
  bool hasAll(int threads) const
  {
    return firstRefused(count_, kLightChunk, threads, [this](std::size_t i) { return has(i); }) ==
      count_;
  }

private:
  std::size_t count_;
  std::unique_ptr<std::atomic<std::uint8_t>[]> used_;
};

struct PointBox
{
  Vector3 low = Vector3::Zero();
  Vector3 high = Vector3::Zero();
};

/// Of the points for which isCounted(i) holds; both corners zero where there is none.
template <typename IsCounted>
PointBox boxOfPoints(const std::vector<Vector3>& points, int threads, const IsCounted& isCounted)
{
  const auto extend = [](std::pair<bool, PointBox>& part, const Vector3& low, const Vector3& high)
  {
    PointBox& box = part.second;
    box.low = part.first ? Vector3(box.low.cwiseMin(low)) : low;
    box.high = part.first ? Vector3(box.high.cwiseMax(high)) : high;
    part.first = true;
  };
  const auto parts = parallelParts<std::pair<bool, PointBox>>(points.size(), kLightChunk, threads,
    [&](std::size_t begin, std::size_t end, std::pair<bool, PointBox>& part)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (isCounted(i))
        {
          extend(part, points[i], points[i]);
        }
      }
    });
  std::pair<bool, PointBox> all;
  for (const auto& [any, box] : parts)
  {
    if (any)
    {
      extend(all, box.low, box.high);
    }
  }
  return all.second;
}

inline PointBox boxOfPoints(const std::vector<Vector3>& points, int threads)
{
  return boxOfPoints(points, threads, [](std::size_t) { return true; });
}

} // namespace quadrille
