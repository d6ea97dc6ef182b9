// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/WorkCount.h"

#include <algorithm>

namespace quadrille
{

namespace
{

thread_local WorkScope* innermostWork = nullptr;

} // namespace

WorkScope::WorkScope(std::size_t most) : outer_(innermostWork), most_(most)
{
  innermostWork = this;
}

WorkScope::~WorkScope()
{
  innermostWork = outer_;
}

void countWork(std::size_t units)
{
  bool isSpent = false;
  for (WorkScope* scope = innermostWork; scope != nullptr; scope = scope->outer_)
  {
    scope->done_ += units;
    isSpent = isSpent || scope->done_ > scope->most_;
  }
  if (isSpent)
  {
    throw WorkSpent();
  }
}

std::size_t workLeft()
{
  std::size_t left = std::numeric_limits<std::size_t>::max();
  for (const WorkScope* scope = innermostWork; scope != nullptr; scope = scope->outer_)
  {
    left = std::min(left, scope->most_ - std::min(scope->most_, scope->done_));
  }
  return left;
}

} // namespace quadrille
