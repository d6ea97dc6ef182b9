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
    parallelForEach(count, kLightChunk, threads,
      [&](std::size_t i) { parent_[i].store(static_cast<Index>(i), std::memory_order_relaxed); });
  }

  /// True when the two were in different sets. Any number of threads may join at once.
  bool join(Index a, Index b)
  {
    for (;;)
    {
      a = find(a);
      b = find(b);
      if (a == b)
      {
        return false;
      }
      const Index low = std::min(a, b);
      Index high = std::max(a, b);
      if (parent_[high].compare_exchange_strong(high, low, std::memory_order_relaxed))
      {
        return true;
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
    return parallelCount(count_, kLightChunk, threads_,
      [&](std::size_t i) { return parent_[i].load(std::memory_order_relaxed) == i; });
  }

private:
  std::size_t count_;
  int threads_;
  std::unique_ptr<std::atomic<Index>[]> parent_;
};

} // namespace quadrille
