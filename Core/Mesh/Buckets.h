// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Elements sorted into buckets by all threads, as the first step of a sort: each bucket is then sorted by itself.
#pragma once

#include "Base/LargeArray.h"
#include "Base/Parallel.h"

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

/// What was sorted into buckets.
template <typename Item>
struct Buckets
{
  std::vector<Item> items;        ///< of a bucket in the order of the elements
  std::vector<std::size_t> begin; ///< where each bucket begins, and the number of all
};

/// bucketOf(i): of an element below count; kBuckets where it is left out. itemOf(i): what is put there for it. The same
/// for any number of threads.
template <std::size_t kBuckets, typename Item, typename BucketOf, typename ItemOf>
Buckets<Item> sortIntoBuckets(
  std::size_t count, int threads, const BucketOf& bucketOf, const ItemOf& itemOf)
{
  using Counts = std::array<std::size_t, kBuckets + 1>;
  auto next = parallelParts<Counts>(count, kLightChunk, threads,
    [&](std::size_t first, std::size_t last, Counts& counts)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        ++counts[bucketOf(i)];
      }
    });
  Buckets<Item> buckets;
  std::size_t sum = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket)
  {
    buckets.begin.push_back(sum);
    for (Counts& chunk : next)
    {
      sum += chunk[bucket];
      chunk[bucket] = sum - chunk[bucket];
    }
  }
  buckets.begin.push_back(sum);
  growLarge(buckets.items, sum);
  parallelFor(count, kLightChunk, threads,
    [&](std::size_t first, std::size_t last)
    {
      Counts& place = next[first / kLightChunk];
      for (std::size_t i = first; i < last; ++i)
      {
        const std::size_t bucket = bucketOf(i);
        if (bucket < kBuckets)
        {
          buckets.items[place[bucket]++] = itemOf(i);
        }
      }
    });
  return buckets;
}

} // namespace quadrille
