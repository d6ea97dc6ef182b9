// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/DisjointSets.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace quadrille
{

TEST(DisjointSets, RootIsTheLowest)
{
  DisjointSets sets(6, 1);
  EXPECT_EQ(sets.countSets(), 6u);
  sets.join(5, 3);
  sets.join(4, 5);
  sets.join(3, 4);
  sets.join(1, 0);
  EXPECT_EQ(sets.countSets(), 3u);
  EXPECT_EQ(sets.find(4), 3u);
  EXPECT_EQ(sets.find(1), 0u);
  EXPECT_EQ(sets.find(2), 2u);
  EXPECT_EQ(DisjointSets(0, 2).countSets(), 0u);
}

// Sets of 1 to 1000 elements, each joined along a random tree in random order by all threads.
TEST(DisjointSets, SameForAnyNumberOfThreads)
{
  std::mt19937 random(5);
  std::vector<Index> shuffled(300000);
  std::iota(shuffled.begin(), shuffled.end(), Index{ 0 });
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  std::vector<std::pair<Index, Index>> pairs;
  std::vector<Index> lowest(shuffled.size());
  std::size_t count = 0;
  for (std::size_t first = 0; first < shuffled.size(); ++count)
  {
    const std::size_t size = std::min<std::size_t>(1 + random() % 1000, shuffled.size() - first);
    Index low = shuffled[first];
    for (std::size_t i = 1; i < size; ++i)
    {
      pairs.emplace_back(shuffled[first + i], shuffled[first + random() % i]);
      low = std::min(low, shuffled[first + i]);
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      lowest[shuffled[first + i]] = low;
    }
    first += size;
  }
  std::shuffle(pairs.begin(), pairs.end(), random);
  for (const int threads : { 1, 2, 5 })
  {
    DisjointSets sets(shuffled.size(), threads);
    parallelFor(pairs.size(), 100, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          sets.join(pairs[i].first, pairs[i].second);
        }
      });
    EXPECT_EQ(sets.countSets(), count);
    std::size_t wrong = 0;
    for (Index i = 0; i < lowest.size(); ++i)
    {
      wrong += sets.find(i) == lowest[i] ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
  }
}

} // namespace quadrille
