// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Clock.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace quadrille
{

constexpr std::chrono::milliseconds kNap{ 20 };
constexpr double kNapSeconds = 0.02;

TEST(Clock, LapsAddUpToTheTimeThatPassed)
{
  const double begin = secondsNow();
  Stopwatch watch;
  std::this_thread::sleep_for(kNap);
  const double seen = watch.seconds();
  EXPECT_GE(seen, kNapSeconds);
  const double first = watch.lap();
  EXPECT_GE(first, seen);
  std::this_thread::sleep_for(kNap);
  const double second = watch.lap();
  EXPECT_GE(second, kNapSeconds);
  EXPECT_LE(first + second, secondsNow() - begin);
}

TEST(Clock, AScopeAddsItsTimeToWhatIsThere)
{
  double seconds = 1, processor = 2;
  {
    const TimedScope timed(seconds, processor);
    // Works until the clock of the processor, which may be coarse, has moved.
    const double begin = processorSecondsNow();
    while (processorSecondsNow() - begin < kNapSeconds)
    {
    }
  }
  EXPECT_GE(seconds, 1 + 0.5 * kNapSeconds); // one thread works, perhaps with others of the process
  EXPECT_GE(processor, 2 + kNapSeconds);
}

} // namespace quadrille
