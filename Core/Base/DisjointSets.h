// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which elements hang together, found by many threads at once.
#pragma once

#include "Base/Parallel.h"
#include "Base/Types.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

namespace quadrille
{

/// Union-find without locks, in the manner of [Anderson and Woll 1991]: a root is hung below a lower one by one
/// compare-and-swap, and paths are halved on the way. The lowest element of a set is its root, so what comes out does
/// not depend on the order of the joins.
class DisjointSets
{
public:
  /// Every element alone.
  DisjointSets(std::size_t count, int threads)
    : count_(count), threads_(threads), parent_(new std::atomic<Index>[count])
  {
    parallelForEach(count, kSetChunk, threads,
      [this](std::size_t i)
      { parent_[i].store(static_cast<Index>(i), std::memory_order_relaxed); });
  }

  /// Any number of threads may join at once.
  void join(Index a, Index b)
  {
    for (;;)
    {
      a = find(a);
      b = find(b);
      if (a == b)
      {
        return;
      }
      const Index low = std::min(a, b);
      Index high = std::max(a, b);
      if (parent_[high].compare_exchange_strong(high, low, std::memory_order_relaxed))
      {
        return;
      }
    }
  }

  /// The lowest element of the set, once all joins are done.
  Index find(Index a)
  {
    Index p = parent_[a].load(std::memory_order_relaxed);
    while (p != a)
    {
      const Index next = parent_[p].load(std::memory_order_relaxed);
      if (next == p)
      {
        return p;
      }
      parent_[a].store(next, std::memory_order_relaxed); // an ancestor of a for good
      a = next;
      p = parent_[a].load(std::memory_order_relaxed);
    }
    return a;
  }

  /// Number of sets.
  std::size_t countSets() const
  {
    std::vector<std::size_t> parts((count_ + kSetChunk - 1) / kSetChunk, 0);
    parallelFor(count_, kSetChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        std::size_t roots = 0;
        for (std::size_t i = begin; i < end; ++i)
        {
          roots += parent_[i].load(std::memory_order_relaxed) == i ? 1 : 0;
        }
        parts[begin / kSetChunk] = roots;
      });
    return std::accumulate(parts.begin(), parts.end(), std::size_t{ 0 });
  }

private:
  static constexpr std::size_t kSetChunk = std::size_t{ 1 } << 15;

  std::size_t count_;
  int threads_;
  std::unique_ptr<std::atomic<Index>[]> parent_;
};

} // namespace quadrille
