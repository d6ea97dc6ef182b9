// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Loops over the tuples of arrays, by all threads.
#pragma once

#include "Base/Parallel.h"

#include <cstddef>

namespace quadrille
{

/// body(i) for all i below count, by all threads.
template <class Body>
void forEachIndex(std::size_t count, int threads, const Body& body)
{
  parallelFor(count, kLightChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        body(i);
      }
    });
}

} // namespace quadrille
