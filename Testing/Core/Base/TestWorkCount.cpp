// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Work is counted by all scopes of the thread, and ends the innermost run whose bound is reached.
#include "Base/WorkCount.h"

#include <gtest/gtest.h>

#include <limits>

#include <thread>

namespace quadrille
{
namespace
{

TEST(WorkCount, CountsInAllScopesOfTheThread)
{
  countWork(1000); // nobody asks
  WorkScope outer;
  countWork(3);
  {
    const WorkScope inner;
    countWork(4);
    EXPECT_EQ(inner.done(), 4U);
  }
  countWork(5);
  EXPECT_EQ(outer.done(), 12U);
  std::thread([] { countWork(100); }).join();
  EXPECT_EQ(outer.done(), 12U);
}

TEST(WorkCount, MayTakeAllOfTheBoundAndNoMore)
{
  const WorkScope scope(10);
  countWork(10);
  EXPECT_THROW(countWork(1), WorkSpent);
  EXPECT_EQ(scope.done(), 11U);
}

TEST(WorkCount, TheBoundOfAnOuterScopeHoldsInside)
{
  const WorkScope outer(10);
  const WorkScope inner(100);
  countWork(10);
  EXPECT_THROW(countWork(1), WorkSpent);
}

} // namespace
TEST(WorkCount, WhatIsLeftIsThatOfTheNarrowestScope)
{
  EXPECT_EQ(workLeft(), std::numeric_limits<std::size_t>::max());
  const WorkScope outer(10);
  countWork(4);
  EXPECT_EQ(workLeft(), 6U);
  {
    const WorkScope inner(3);
    EXPECT_EQ(workLeft(), 3U);
    countWork(3);
    EXPECT_EQ(workLeft(), 0U);
  }
  EXPECT_EQ(workLeft(), 3U);
}

} // namespace quadrille
