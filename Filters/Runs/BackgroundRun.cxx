// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/BackgroundRun.h"

#include "Base/Progress.h"

#include <chrono>
#include <utility>

namespace quadrille
{

BackgroundRun::BackgroundRun(
  std::unique_ptr<PreparedRun> run, EarlierResult wanted, double timeLimit)
  : run_(std::move(run)), wanted_(std::move(wanted)),
    thread_([this, timeLimit] { work(timeLimit); })
{
}

BackgroundRun::~BackgroundRun()
{
  stop();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void BackgroundRun::work(double timeLimit)
{
  const auto begin = std::chrono::steady_clock::now();
  const ProgressCallback progress = [this, begin, timeLimit](double fraction, const std::string&)
  {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    progress_ = std::max(progress_.load(), fraction); // stages that are tried again begin anew
    isOutOfTime_ = timeLimit > 0 && spent.count() > timeLimit;
    return !isOutOfTime_ && !isAskedToStop_;
  };
  PollScope scope(progress);
  run_->problem.options.progress = scope.callback();
  try
  {
    run_->made = remesh(run_->problem);
  }
  catch (...)
  {
    failure_ = std::current_exception();
  }
  run_->problem.options.progress = {};
  isOver_ = true;
}

std::unique_ptr<PreparedRun> BackgroundRun::take()
{
  thread_.join();
  if (failure_)
  {
    std::rethrow_exception(failure_);
  }
  return std::move(run_);
}

} // namespace quadrille
