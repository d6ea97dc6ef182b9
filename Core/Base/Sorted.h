// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Arrays in ascending order.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace quadrille
{

/// Puts values in ascending order, each once.
template <typename T>
void sortUnique(std::vector<T>& values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Where a value stands among ascending ones that have it.
template <typename Values>
Index placeIn(const Values& values, Index value)
{
  const auto found = std::lower_bound(values.begin(), values.end(), value);
  assert(found != values.end() && *found == value);
  return static_cast<Index>(found - values.begin());
}

} // namespace quadrille
