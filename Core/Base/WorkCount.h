// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run has done, counted where it is done, so that it can be bounded by a number that is the same on every
/// machine.
///
/// One unit is what takes a microsecond on one core of the machine that the constants were measured on (see
/// Documentation/Design/Recovery.md). Only iterations of unknown length count themselves: Newton steps and searches.
/// What takes a time that follows from the size of its input needs no count.
#pragma once

#include <cstddef>
#include <limits>
#include <stdexcept>

namespace quadrille
{

/// Thrown by countWork() where the work of a scope is spent; caught by who has made the scope.
class WorkSpent : public std::runtime_error
{
public:
  WorkSpent() : std::runtime_error("the bound of work is reached") {}
};

/// Counts the work of its thread while it lives. Scopes nest: what the inner one counts, the outer one counts, too.
class WorkScope
{
public:
  /// most: units after which countWork() throws WorkSpent.
  explicit WorkScope(std::size_t most = std::numeric_limits<std::size_t>::max());
  ~WorkScope();
  WorkScope(const WorkScope&) = delete;
  WorkScope& operator=(const WorkScope&) = delete;

  std::size_t done() const { return done_; }

private:
  friend void countWork(std::size_t units);
  friend std::size_t workLeft();

  WorkScope* outer_;
  std::size_t most_;
  std::size_t done_ = 0;
};

/// Adds to the scopes of the thread, if there are any. Call it from the thread that makes the run only, and only with
/// numbers that do not depend on threads: then a run ends at the same place for any number of them.
void countWork(std::size_t units);

/// What the scopes of the thread have left; the largest number where none has a bound.
std::size_t workLeft();

} // namespace quadrille
