// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run in a thread of its own, so that whoever asked for it can do something else meanwhile.
#pragma once

#include "Blocks/Blocks.h"
#include "Convert/PolyData.h"
#include "Evaluation/ConstraintWords.h"
#include "Runs/GivenInputs.h"
#include "Ways/Ways.h"

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace quadrille
{

/// A run of one block: what goes in, and what comes out.
struct PreparedRun
{
  GivenInputs inputs;
  std::shared_ptr<BlockMemory> memory; ///< that the problem's store is part of
  QuadProblem problem;

  std::shared_ptr<ReadSurface> read; ///< what lies under the converted surface
  std::optional<ConvertedSurface> converted;
  AskedConstraints asked;
  std::vector<ToldOfInputs> told;
  std::optional<QuadsMade> made;
  std::exception_ptr failure; ///< in place of what was made

  /// Reads the inputs, where the problem asks for them, and makes the quads.
  void make();
};

/// What an execution ends with that has begun a run in the background, or finds that it is not over.
struct Underway : std::exception
{
  const char* what() const noexcept override { return "the quads are being made"; }
};

/// Begins with the object, after a run that it takes the place of has ended, and is stopped with it. Only the thread of
/// whoever made it may ask; nobody else may touch the run, nor what it points to, before it is over.
class BackgroundRun
{
public:
  /// wanted: what the result depends on. timeLimit: in seconds; 0: none. before: stopped, or null; both may have the
  /// same memory.
  BackgroundRun(std::unique_ptr<PreparedRun> run, EarlierResult wanted, double timeLimit,
    std::unique_ptr<BackgroundRun> before);
  ~BackgroundRun();
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  bool isFor(const EarlierResult& wanted) const { return wanted_.isFor(wanted); }
  bool isOver() const { return isOver_; }
  bool hasRunOutOfTime() const { return isOutOfTime_; }
  double progress() const { return progress_; }
  void stop() { isAskedToStop_ = true; }
  /// Stops it, and lets it drop what it has when it ends; it is not to be taken any more.
  void leave();

  /// Waits until it is over, and gives the run back.
  std::unique_ptr<PreparedRun> take();

private:
  void work(double timeLimit);

  std::unique_ptr<PreparedRun> run_;
  EarlierResult wanted_;
  std::unique_ptr<BackgroundRun> before_;
  std::atomic<double> progress_{ 0 };
  std::atomic<bool> isAskedToStop_{ false };
  std::atomic<bool> isLeft_{ false };
  std::atomic<bool> isOutOfTime_{ false };
  std::atomic<bool> isOver_{ false };
  std::thread thread_;
};

} // namespace quadrille
