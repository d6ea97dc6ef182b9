// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Boxes of many small things in a tree, to find the nearest one. The things are put along a Hilbert curve, and boxes
/// of consecutive ones make the tree, so that it is built in linear time and is flat arrays.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace quadrille
{

class BoxTree
{
public:
  struct Box
  {
    Vector3 low = Vector3::Zero(), high = Vector3::Zero();

    /// From p to the box, squared; 0 inside.
    double squaredDistance(const Vector3& p) const
    {
      return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
    }
  };

  BoxTree() = default;
  /// boxes: one an item, finite.
  BoxTree(const std::vector<Box>& boxes, int threads);

  /// The item with the least squaredDistance(item), of equal ones that with the lowest id; kInvalidIndex where there
  /// are none. What squaredDistance says must not be less than the distance to the item's box.
  template <class SquaredDistance>
  Index nearest(const Vector3& p, const SquaredDistance& squaredDistance) const
  {
    Nearest best;
    if (!levels_.empty())
    {
      search(p, levels_.size() - 1, 0, squaredDistance, best);
    }
    return best.item;
  }

private:
  /// Boxes, and items, below one box.
  static constexpr std::size_t kBoxChildren = 8;

  struct Nearest
  {
    double squared = std::numeric_limits<double>::infinity();
    Index item = kInvalidIndex;
  };

  template <class SquaredDistance>
  void search(const Vector3& p, std::size_t level, std::size_t box,
    const SquaredDistance& squaredDistance, Nearest& best) const
  {
    const std::size_t begin = kBoxChildren * box;
    if (level == 0)
    {
      for (std::size_t i = begin; i < std::min(begin + kBoxChildren, items_.size()); ++i)
      {
        const double squared = squaredDistance(items_[i]);
        if (squared < best.squared || (squared == best.squared && items_[i] < best.item))
        {
          best = { squared, items_[i] };
        }
      }
      return;
    }
    const std::vector<Box>& below = levels_[level - 1];
    std::array<std::pair<double, std::size_t>, kBoxChildren> order;
    std::size_t count = 0;
    for (std::size_t i = begin; i < std::min(begin + kBoxChildren, below.size()); ++i)
    {
      order[count++] = { below[i].squaredDistance(p), i };
    }
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i)
    {
      // Rounding must not hide an item at the same distance with a lower id.
      constexpr double kSlack = 1 - 1e-12;
      if (kSlack * order[i].first <= best.squared)
      {
        search(p, level - 1, order[i].second, squaredDistance, best);
      }
    }
  }

  std::vector<Index> items_;             ///< along the curve
  std::vector<std::vector<Box>> levels_; ///< 0: of items_; the last one has one box
};

} // namespace quadrille
