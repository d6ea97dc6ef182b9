// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/StarCache.h"

#include <gtest/gtest.h>

using namespace quadrille;

namespace
{

StarCache::Words keyOf(std::uint32_t i)
{
  return StarCache::Words(3 + i % 5, i); // of several lengths
}

} // namespace

TEST(StarCache, FindsEveryEntryAfterItHasGrown)
{
  StarCache cache;
  EXPECT_EQ(cache.find(keyOf(0)), nullptr);
  const std::uint32_t count = 20000;
  StarCache::Batch batch;
  for (std::uint32_t i = 0; i < count; ++i)
  {
    batch.add(keyOf(i), { i, i + 1 });
    if (i % 100 == 99)
    {
      cache.add(batch);
      batch.clear();
    }
  }
  EXPECT_EQ(cache.entries(), count);
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const std::uint32_t* value = cache.find(keyOf(i));
    ASSERT_NE(value, nullptr);
    EXPECT_EQ(value[0], i);
    EXPECT_EQ(value[1], i + 1);
  }
  EXPECT_EQ(cache.find(keyOf(count)), nullptr);
  EXPECT_EQ(cache.find({ 7, 7 }), nullptr) << "the beginning of a key is another key";
  cache.clear();
  EXPECT_EQ(cache.find(keyOf(1)), nullptr);
  EXPECT_EQ(cache.entries(), 0U);
}
