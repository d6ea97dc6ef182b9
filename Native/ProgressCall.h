// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Python's progress functions under Core's callback: the lock of the interpreter is taken for the call alone, a
/// result of False stops the run, and an exception stops it and is raised to who started it, Ctrl+C included.
#pragma once

#include "Base/Progress.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <functional>
#include <string>

namespace quadrille::native
{

namespace py = pybind11;

class ProgressCall
{
public:
  /// function: called as function(fraction, text), or with the fraction alone; None: only Ctrl+C is looked for.
  /// timeLimit: seconds, 0: none.
  ProgressCall(py::object function, bool withText, double timeLimit);

  /// The part [begin, end] of all.
  ProgressCallback callback(double begin, double end);
  /// What the run did is done: the last call. A stop that it asks for comes too late.
  void finish();
  /// Raises what the function raised.
  void rethrow() const;
  /// Why it was stopped.
  std::string stopText() const;

private:
  bool call(double fraction, const std::string& text);

  py::object function_;
  bool withText_;
  double timeLimit_;
  bool timeIsOver_ = false;
  double farthest_ = 0;
  std::string lastText_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::exception_ptr raised_;
};

/// run() without the interpreter's lock, so that other threads of Python go on.
template <class Run>
auto withoutLock(const Run& run) -> decltype(run())
{
  const py::gil_scoped_release release;
  return run();
}

} // namespace quadrille::native
