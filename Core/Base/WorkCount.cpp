// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/WorkCount.h"

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

} // namespace quadrille
