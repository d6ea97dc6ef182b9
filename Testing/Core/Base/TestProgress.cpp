// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Parallel.h"
#include "Base/Progress.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace quadrille
{

TEST(Progress, AnEmptyCallbackNeverCancels)
{
  EXPECT_NO_THROW(report({}, 0.5, "half"));
}

TEST(Progress, TheCallbackGetsFractionAndTextAndMayCancel)
{
  double fraction = 0;
  std::string text;
  const ProgressCallback go = [&](double f, const std::string& t)
  {
    fraction = f;
    text = t;
    return true;
  };
  report(go, 0.25, "quarter");
  EXPECT_EQ(fraction, 0.25);
  EXPECT_EQ(text, "quarter");
  EXPECT_THROW(report([](double, const std::string&) { return false; }, 0, ""), Cancelled);
}

TEST(Progress, APartIsSeenAsSuchFromOutside)
{
  double fraction = 0;
  std::string text;
  bool goOn = true;
  const ProgressCallback whole = [&](double f, const std::string& t)
  {
    fraction = f;
    text = t;
    return goOn;
  };
  const ProgressCallback part = subProgress(whole, 0.5, 0.75, "Mapping: ");
  EXPECT_TRUE(part(0.5, "field"));
  EXPECT_EQ(fraction, 0.625);
  EXPECT_EQ(text, "Mapping: field");
  part(1.5, "");
  EXPECT_EQ(fraction, 0.75);
  part(-1, "");
  EXPECT_EQ(fraction, 0.5);
  const ProgressCallback partOfPart = subProgress(part, 0.5, 1);
  partOfPart(0, "integers");
  EXPECT_EQ(fraction, 0.625);
  EXPECT_EQ(text, "Mapping: integers");
  goOn = false;
  EXPECT_FALSE(partOfPart(0.5, ""));
  EXPECT_FALSE(subProgress({}, 0, 1)); // nobody listens
}

TEST(Progress, PollRepeatsTheLastReportAfterAWhile)
{
  std::vector<double> seen;
  PollScope scope(
    [&](double fraction, const std::string&)
    {
      seen.push_back(fraction);
      return seen.size() < 3;
    });
  report(scope.callback(), 0.5, "half");
  poll(); // at once: nothing to say
  EXPECT_EQ(seen.size(), 1U);
  std::this_thread::sleep_for(PollScope::kInterval);
  poll();
  EXPECT_EQ(seen, (std::vector<double>{ 0.5, 0.5 }));
  std::this_thread::sleep_for(PollScope::kInterval);
  EXPECT_THROW(poll(), Cancelled);
}

TEST(Progress, TheInnermostRunIsAskedAndOtherThreadsHaveNone)
{
  int outerCalls = 0;
  int innerCalls = 0;
  PollScope outer([&](double, const std::string&) { return ++outerCalls < 100; });
  std::this_thread::sleep_for(PollScope::kInterval);
  {
    PollScope inner([&](double, const std::string&) { return ++innerCalls < 100; });
    std::this_thread::sleep_for(PollScope::kInterval);
    poll();
    std::thread([] { poll(); }).join();
  }
  EXPECT_EQ(innerCalls, 1);
  EXPECT_EQ(outerCalls, 0);
  poll();
  EXPECT_EQ(outerCalls, 1);
}

TEST(Progress, AParallelLoopStopsOnRequest)
{
  for (const int threads : { 1, 2, 4 })
  {
    PollScope scope([](double, const std::string&) { return false; });
    std::atomic<int> chunks{ 0 };
    const auto slow = [&](std::size_t, std::size_t)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ++chunks;
    };
    EXPECT_THROW(parallelFor(1000, 1, threads, slow), Cancelled);
    EXPECT_LT(chunks, 1000);
  }
}

TEST(Progress, AStatusIsOkUnlessToldOtherwise)
{
  EXPECT_TRUE(Status().ok());
  EXPECT_FALSE((Status{ StatusCode::Infeasible, "no" }.ok()));
}

} // namespace quadrille
