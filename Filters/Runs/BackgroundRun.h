// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run in a thread of its own, so that whoever asked for it can do something else meanwhile.
#pragma once

#include "Blocks/Blocks.h"
#include "Constraints/Constraints.h"
#include "Convert/PolyData.h"
#include "Ways/Ways.h"

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace quadrille
{

/// A run of one block: what goes in, and what comes out.
struct PreparedRun
{
  std::vector<vtkSmartPointer<vtkDataObject>> inputs; ///< of the block
  std::shared_ptr<BlockMemory> memory;                ///< that the problem's store is part of
  std::optional<ConvertedSurface> converted;          ///< where the surface was asked for
  AskedConstraints asked;
  QuadProblem problem;
  std::vector<std::string> notices; ///< on what goes in
  std::optional<QuadsMade> made;
};

/// What an execution ends with that has begun a run in the background, or finds that it is not over.
struct Underway : std::exception
{
  const char* what() const noexcept override { return "the quads are being made"; }
};

/// Begins with the object, and is stopped with it. Only the thread of whoever made it may ask; nobody else may touch
/// the run, nor what it points to, before it is over.
class BackgroundRun
{
public:
  /// wanted: what the result depends on. timeLimit: in seconds; 0: none.
  BackgroundRun(std::unique_ptr<PreparedRun> run, EarlierResult wanted, double timeLimit);
  ~BackgroundRun();
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  bool isFor(const EarlierResult& wanted) const { return wanted_.isFor(wanted); }
  bool isOver() const { return isOver_; }
  bool hasRunOutOfTime() const { return isOutOfTime_; }
  double progress() const { return progress_; }
  void stop() { isAskedToStop_ = true; }

  /// Waits until it is over, and gives the run back; throws what the run has thrown.
  std::unique_ptr<PreparedRun> take();

private:
  void work(double timeLimit);

  std::unique_ptr<PreparedRun> run_;
  EarlierResult wanted_;
  std::exception_ptr failure_;
  std::atomic<double> progress_{ 0 };
  std::atomic<bool> isAskedToStop_{ false };
  std::atomic<bool> isOutOfTime_{ false };
  std::atomic<bool> isOver_{ false };
  std::thread thread_;
};

} // namespace quadrille
