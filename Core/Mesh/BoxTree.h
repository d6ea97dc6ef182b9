// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Boxes of many small things in a tree, to find the nearest one. The things are put along a Hilbert curve, and boxes
/// of consecutive ones make the tree, so that it is built in linear time and is flat arrays.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <array>
#include <cstddef>
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
  /// is none within a distance. What squaredDistance says must not be less than the distance to the item's box;
  /// infinite: the item does not count.
  template <class SquaredDistance>
  Index nearest(
    const Vector3& p, const SquaredDistance& squaredDistance, double within = kInfinity) const
  {
    Nearest best;
    best.squared = within * within;
    if (!levels_.empty())
    {
      search(p, levels_.size() - 1, 0, squaredDistance, best);
    }
    return best.item;
  }

  /// Calls visit(item) for all that may be no farther away, and for some others, in the order of the curve.
  template <class Visit>
  void visitWithin(const Vector3& p, double distance, const Visit& visit) const
  {
    visitWhere(
      [&](const Box& box) { return box.squaredDistance(p) <= distance * distance; }, visit);
  }

  /// Calls visit(item) for the items in boxes for which counts(box), and for all boxes round it, is true, in the order
  /// of the curve.
  template <class Counts, class Visit>
  void visitWhere(const Counts& counts, const Visit& visit) const
  {
    if (!levels_.empty())
    {
      visitBelow(counts, levels_.size() - 1, 0, visit);
    }
  }

  std::size_t bytes() const;

private:
  /// Boxes, and items, below one box.
  static constexpr std::size_t kBoxChildren = 4;

  struct Nearest
  {
    double squared = kInfinity;
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
        const bool isFirst =
          squared == best.squared && items_[i] < best.item && squared < kInfinity;
        if (squared < best.squared || isFirst)
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
      if ((1 - kLastDigits) * order[i].first <= best.squared)
      {
        search(p, level - 1, order[i].second, squaredDistance, best);
      }
    }
  }

  template <class Counts, class Visit>
  void visitBelow(
    const Counts& counts, std::size_t level, std::size_t box, const Visit& visit) const
  {
    if (!counts(levels_[level][box]))
    {
      return;
    }
    const std::size_t count = level == 0 ? items_.size() : levels_[level - 1].size();
    const std::size_t begin = kBoxChildren * box;
    for (std::size_t i = begin; i < std::min(begin + kBoxChildren, count); ++i)
    {
      level == 0 ? visit(items_[i]) : visitBelow(counts, level - 1, i, visit);
    }
  }

  std::vector<Index> items_;             ///< along the curve
  std::vector<std::vector<Box>> levels_; ///< 0: of items_; the last one has one box
};

} // namespace quadrille
