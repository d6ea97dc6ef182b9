// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Progress and cancel are one callback.
///
/// A stage reports where it stands with report(). Between two reports a long loop calls poll(), which costs a look at
/// the clock and repeats the last report of the run when a while has passed; parallelFor() does so before each chunk.
/// So a run stops soon after the callback asks for it, without every inner loop being given the callback.
#pragma once

#include "Base/Error.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace quadrille
{

/// Called by a stage on the caller's thread with its own fraction in [0, 1] and a short text.
/// Returning false asks the stage to stop.
using ProgressCallback = std::function<bool(double fraction, const std::string& text)>;

/// Reports progress; throws Cancelled when the callback returns false. An empty callback never
/// cancels.
inline void report(const ProgressCallback& callback, double fraction, const std::string& text)
{
  if (callback && !callback(fraction, text))
  {
    throw Cancelled();
  }
}

/// A stage reports its own fraction; whoever calls it knows what part of all that is: the callback for a stage that is
/// the part [begin, end] of all, whose texts get a prefix. A fraction outside of [0, 1] counts as the nearest one in
/// it. Empty where `callback` is.
ProgressCallback subProgress(
  const ProgressCallback& callback, double begin, double end, const std::string& prefix = {});

/// The run of the thread that makes it, for poll(). Scopes nest; the innermost one is asked.
class PollScope
{
public:
  /// Time that must pass between two calls of the callback by poll().
  static constexpr std::chrono::milliseconds kInterval{ 20 };

  explicit PollScope(ProgressCallback callback);
  ~PollScope();
  PollScope(const PollScope&) = delete;
  PollScope& operator=(const PollScope&) = delete;

  /// The callback that the stages of the run must use, so that poll() knows the last report. Empty where the scope's
  /// own callback is. Lives as long as the scope.
  ProgressCallback callback();

private:
  friend void poll();
  bool call(double fraction, const std::string& text);

  ProgressCallback callback_;
  PollScope* outer_;
  std::chrono::steady_clock::time_point last_;
  double fraction_ = 0;
  std::string text_;
};

/// Throws Cancelled when the callback of the thread's run asks to stop. Does nothing on threads without a run.
void poll();

/// poll() in a loop of short steps: every so many of them, a power of two; kHeavyChunk for those of a microsecond.
inline void pollNowAndThen(std::size_t step, std::size_t stepsBetween = std::size_t{ 1 } << 16)
{
  if ((step & (stepsBetween - 1)) == 0)
  {
    poll();
  }
}

} // namespace quadrille
