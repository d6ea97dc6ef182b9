// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/BackgroundRun.h"

#include "Base/Progress.h"

#include <chrono>
#include <utility>

namespace quadrille
{

void PreparedRun::make()
{
  try
  {
    made = remesh(problem);
    if (!converted)
    {
      converted = readForPieces(inputs, told);
    }
  }
  catch (...)
  {
    failure = std::current_exception();
  }
}

BackgroundRun::BackgroundRun(std::unique_ptr<PreparedRun> run, EarlierResult wanted,
  double timeLimit, std::unique_ptr<BackgroundRun> before)
  : run_(std::move(run)), wanted_(std::move(wanted)), before_(std::move(before)),
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

void BackgroundRun::leave()
{
  isLeft_ = true;
  stop();
}

void BackgroundRun::work(double timeLimit)
{
  before_.reset(); // waits for it
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
  run_->make();
  run_->problem.options.progress = {};
  if (isLeft_)
  {
    run_.reset();
  }
  isOver_ = true;
}

std::unique_ptr<PreparedRun> BackgroundRun::take()
{
  thread_.join();
  return std::move(run_);
}

} // namespace quadrille
