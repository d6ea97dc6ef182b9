// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <vector>

namespace quadrille
{

TEST(Parallel, AtLeastOneThread)
{
  EXPECT_GE(resolveThreads(0), 1);
  EXPECT_EQ(resolveThreads(5), 5);
}

TEST(Parallel, EveryElementComesOnce)
{
  for (const std::size_t count : { 0u, 1u, 7u, 64u, 1000u })
  {
    for (const std::size_t chunk : { 0u, 1u, 7u, 64u, 5000u })
    {
      for (const int threads : { 0, 1, 2, 7 })
      {
        std::vector<std::atomic<int>> visits(count);
        parallelFor(count, chunk, threads,
          [&](std::size_t begin, std::size_t end)
          {
            for (std::size_t i = begin; i < end; ++i)
            {
              ++visits[i];
            }
          });
        for (const std::atomic<int>& visit : visits)
        {
          EXPECT_EQ(visit, 1);
        }
      }
    }
  }
}

TEST(Parallel, ChunksDoNotDependOnTheNumberOfThreads)
{
  const auto chunks = [](int threads)
  {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    std::mutex mutex;
    parallelFor(1000, 33, threads,
      [&](std::size_t begin, std::size_t end)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        seen.emplace(begin, end);
      });
    return seen;
  };
  EXPECT_EQ(chunks(1), chunks(4));
  EXPECT_EQ(chunks(1).size(), 31u); // 30 whole ones and a rest of 10
}

TEST(Parallel, SumsByChunkAreTheSameForAnyNumberOfThreads)
{
  const auto sum = [](int threads)
  {
    constexpr std::size_t kChunk = 100;
    std::vector<double> parts(100, 0);
    parallelFor(10000, kChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          parts[begin / kChunk] += 1.0 / static_cast<double>(i + 1);
        }
      });
    double total = 0;
    for (const double part : parts)
    {
      total += part;
    }
    return total;
  };
  EXPECT_EQ(sum(1), sum(2));
  EXPECT_EQ(sum(1), sum(5));
}

TEST(Parallel, AnExceptionReachesTheCallerAndStopsTheRest)
{
  for (const int threads : { 1, 3 })
  {
    std::atomic<int> chunks{ 0 };
    EXPECT_THROW(parallelFor(1000000, 1, threads,
                   [&](std::size_t begin, std::size_t)
                   {
                     ++chunks;
                     if (begin == 10)
                     {
                       throw std::runtime_error("ten");
                     }
                   }),
      std::runtime_error);
    EXPECT_LT(chunks, 1000000);
  }
}

} // namespace quadrille
