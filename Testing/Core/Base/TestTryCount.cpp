// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/TryCount.h"

#include "Base/Parallel.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

std::size_t takenOf(const TryCounts& counts, Try which)
{
  return counts.taken[static_cast<std::size_t>(which)];
}

std::size_t ledOf(const TryCounts& counts, Try which)
{
  return counts.led[static_cast<std::size_t>(which)];
}

TEST(TryCount, EachRowHasANameOfItsOwnInItsRoom)
{
  std::set<std::pair<std::string, std::string>> names;
  for (const TryRow& row : tryTable())
  {
    ASSERT_NE(row.name, nullptr); // else a value of Try has no row
    EXPECT_TRUE(names.emplace(row.room, row.name).second) << row.room << ": " << row.name;
    EXPECT_FALSE(std::string(row.changes).empty()) << row.name;
    EXPECT_FALSE(std::string(row.bound).empty()) << row.name;
  }
  EXPECT_STREQ(tryRow(Try::MoreFreedom).name, "more freedom");
  EXPECT_STREQ(tryRow(Try::FinerScale).room, "integers");
  EXPECT_STREQ(tryRow(Try::WithoutSymmetry).name, "without the symmetry"); // the last one
}

TEST(TryCount, WithoutAScopeNothingIsCounted)
{
  countTry(Try::Breakout);
  const TryScope scope;
  EXPECT_EQ(takenOf(scope.counts(), Try::Breakout), 0U);
}

TEST(TryCount, AScopeInsideOfAnotherOneTakesItsCountsForItself)
{
  const TryScope outer;
  countTry(Try::Breakout);
  {
    const TryScope inner;
    countTry(Try::Breakout, 2);
    countTryLed(Try::Breakout);
    EXPECT_EQ(takenOf(inner.counts(), Try::Breakout), 2U);
    EXPECT_EQ(ledOf(inner.counts(), Try::Breakout), 1U);
  }
  countTry(Try::FinerScale);
  EXPECT_EQ(takenOf(outer.counts(), Try::Breakout), 1U);
  EXPECT_EQ(ledOf(outer.counts(), Try::Breakout), 0U);
  EXPECT_EQ(takenOf(outer.counts(), Try::FinerScale), 1U);
}

TEST(TryCount, ThreadsOfALoopCountForTheScopeRoundIt)
{
  for (const int threads : { 1, 2, 7 })
  {
    const TryScope scope;
    parallelFor(1000, 10, threads,
      [](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          countTry(Try::NodeFurther, i % 3 == 0 ? 1 : 0);
        }
      });
    EXPECT_EQ(takenOf(scope.counts(), Try::NodeFurther), 334U) << threads;
  }
}

TEST(TryCount, CountsAreAddedByTakenByLedOrBoth)
{
  TryCounts one, other;
  other.taken[0] = 3;
  other.led[0] = 1;
  one.addTaken(other);
  EXPECT_EQ(one.taken[0], 3U);
  EXPECT_EQ(one.led[0], 0U);
  one.addLed(other);
  one.add(other);
  EXPECT_EQ(one.taken[0], 6U);
  EXPECT_EQ(one.led[0], 2U);
}

} // namespace
} // namespace quadrille
