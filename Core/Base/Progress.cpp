// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

thread_local PollScope* currentScope = nullptr;

} // namespace

ProgressCallback subProgress(
  const ProgressCallback& callback, double begin, double end, const std::string& prefix)
{
  if (!callback)
  {
    return {};
  }
  return [=](double fraction, const std::string& text)
  { return callback(begin + (end - begin) * std::clamp(fraction, 0.0, 1.0), prefix + text); };
}

PollScope::PollScope(ProgressCallback callback)
  : callback_(std::move(callback)), outer_(currentScope), last_(std::chrono::steady_clock::now())
{
  currentScope = this;
}

PollScope::~PollScope()
{
  currentScope = outer_;
}

bool PollScope::call(double fraction, const std::string& text)
{
  const bool goOn = callback_(fraction, text);
  last_ = std::chrono::steady_clock::now();
  return goOn;
}

ProgressCallback PollScope::callback()
{
  if (!callback_)
  {
    return {};
  }
  return [this](double fraction, const std::string& text)
  {
    fraction_ = fraction;
    text_ = text;
    return call(fraction, text);
  };
}

void poll()
{
  PollScope* scope = currentScope;
  if (scope && scope->callback_ &&
    std::chrono::steady_clock::now() - scope->last_ >= PollScope::kInterval &&
    !scope->call(scope->fraction_, scope->text_))
  {
    throw Cancelled();
  }
}

} // namespace quadrille
