// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How long something takes.
#pragma once

#include <chrono>
#include <ctime>

namespace quadrille
{

/// Seconds since a moment that stays the same while the program runs, on a clock that never goes back: only differences
/// mean something.
inline double secondsNow()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Seconds that all threads of the process have computed.
inline double processorSecondsNow()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

class Stopwatch
{
public:
  /// Seconds since it was made, or since the last lap.
  double seconds() const { return secondsNow() - start_; }

  /// The same; the next lap begins.
  double lap()
  {
    const double time = secondsNow();
    const double passed = time - start_;
    start_ = time;
    return passed;
  }

private:
  double start_ = secondsNow();
};

/// Adds the seconds of its life, on the clock and of the processor.
class TimedScope
{
public:
  TimedScope(double& seconds, double& processorSeconds)
    : seconds_(seconds), processorSeconds_(processorSeconds)
  {
  }
  ~TimedScope()
  {
    seconds_ += watch_.seconds();
    processorSeconds_ += processorSecondsNow() - processorStart_;
  }
  TimedScope(const TimedScope&) = delete;
  TimedScope& operator=(const TimedScope&) = delete;

private:
  double& seconds_;
  double& processorSeconds_;
  Stopwatch watch_;
  double processorStart_ = processorSecondsNow();
};

} // namespace quadrille
