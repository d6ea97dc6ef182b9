// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/ProgressCall.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace quadrille::native
{

ProgressCall::ProgressCall(py::object function, bool withText, double timeLimit)
  : function_(std::move(function)), withText_(withText), timeLimit_(timeLimit)
{
}

ProgressCallback ProgressCall::callback(double begin, double end)
{
  return [this, begin, end](double fraction, const std::string& text)
  {
    // A stage that is tried again starts from its beginning; a bar must not run backwards.
    farthest_ = std::max(farthest_, begin + (end - begin) * std::clamp(fraction, 0.0, 1.0));
    lastText_ = text;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - started_;
    timeIsOver_ = timeLimit_ > 0 && spent.count() > timeLimit_;
    return call(farthest_, text) && !timeIsOver_;
  };
}

void ProgressCall::finish()
{
  call(1, lastText_);
}

bool ProgressCall::call(double fraction, const std::string& text)
{
  if (raised_)
  {
    return false;
  }
  const py::gil_scoped_acquire acquire;
  try
  {
    if (PyErr_CheckSignals() != 0)
    {
      throw py::error_already_set();
    }
    if (function_.is_none())
    {
      return true;
    }
    const py::object answer = withText_ ? function_(fraction, text) : function_(fraction);
    return !answer.is(py::bool_(false));
  }
  catch (const py::error_already_set&)
  {
    raised_ = std::current_exception();
    return false;
  }
}

void ProgressCall::rethrow() const
{
  if (raised_)
  {
    std::rethrow_exception(raised_);
  }
}

std::string ProgressCall::stopText() const
{
  if (!timeIsOver_)
  {
    return "stopped on request";
  }
  std::ostringstream text;
  text << "stopped after the time limit of " << timeLimit_ << " s";
  return text.str();
}

} // namespace quadrille::native
