// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Entries of a heap of vertices whose costs change: outdated ones stay in it and are skipped.
#pragma once

#include "Base/Types.h"

namespace quadrille
{

/// In a std::priority_queue the cheapest comes first, of two equally cheap vertices the lower id.
struct LazyHeapEntry
{
  float cost = 0;
  Index vertex = 0;
  Index version = 0; ///< outdated when the vertex has a later one
  bool operator<(const LazyHeapEntry& other) const
  {
    return cost != other.cost ? cost > other.cost : vertex > other.vertex;
  }
};

} // namespace quadrille
