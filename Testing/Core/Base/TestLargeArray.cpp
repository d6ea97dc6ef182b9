// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LargeArray.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <thread>

using namespace quadrille;

namespace
{

/// Two steps and a half.
constexpr std::size_t kCount = 5 * kLargeArrayStep / (2 * sizeof(std::uint32_t));

} // namespace

TEST(LargeArray, GrowsFillsAndCopiesAsTheVectorDoes)
{
  std::vector<std::uint32_t> values{ 3, 4 };
  growLarge(values, kCount);
  EXPECT_EQ(values.size(), kCount);
  EXPECT_EQ(std::accumulate(values.begin(), values.end(), std::uint64_t{ 0 }), 7U);
  fillLarge(values, kCount, 2U);
  EXPECT_EQ(values, std::vector<std::uint32_t>(kCount, 2));
  std::iota(values.begin(), values.end(), 0U);
  std::vector<std::uint32_t> copy{ 1, 2, 3 };
  copyLarge(values, copy);
  EXPECT_EQ(copy, values);
  fillLarge(values, 0, 1U);
  EXPECT_TRUE(values.empty());
}

TEST(LargeArray, StopsOnRequest)
{
  const std::vector<std::uint32_t> source(kCount, 1);
  std::vector<std::uint32_t> values;
  PollScope scope([](double, const std::string&) { return false; });
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(growLarge(values, kCount), Cancelled);
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(fillLarge(values, kCount, 1U), Cancelled);
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(copyLarge(source, values), Cancelled);
}
