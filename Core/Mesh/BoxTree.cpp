// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BoxTree.h"

#include "Base/Parallel.h"
#include "Mesh/SpaceFillingOrder.h"

namespace quadrille
{
BoxTree::BoxTree(const std::vector<Box>& boxes, int threads)
{
  if (boxes.empty())
  {
    return;
  }
  std::vector<Vector3> centres(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    centres[i] = 0.5 * (boxes[i].low + boxes[i].high);
  }
  items_ = spaceFillingOrder(centres, threads);
  const auto addLevel = [&](std::size_t count, const auto& boxOf)
  {
    std::vector<Box> level((count + kBoxChildren - 1) / kBoxChildren);
    parallelForEach(level.size(), kMediumChunk, threads,
      [&](std::size_t k)
      {
        level[k] = boxOf(kBoxChildren * k);
        for (std::size_t i = kBoxChildren * k + 1; i < std::min(kBoxChildren * (k + 1), count); ++i)
        {
          const Box& box = boxOf(i);
          level[k].low = level[k].low.cwiseMin(box.low);
          level[k].high = level[k].high.cwiseMax(box.high);
        }
      });
    levels_.push_back(std::move(level));
  };
  addLevel(boxes.size(), [&](std::size_t i) -> const Box& { return boxes[items_[i]]; });
  while (levels_.back().size() > 1)
  {
    const std::vector<Box> below = levels_.back();
    addLevel(below.size(), [&](std::size_t i) -> const Box& { return below[i]; });
  }
}

std::size_t BoxTree::bytes() const
{
  std::size_t bytes = items_.size() * sizeof(Index);
  for (const std::vector<Box>& level : levels_)
  {
    bytes += level.size() * sizeof(Box);
  }
  return bytes;
}

} // namespace quadrille
