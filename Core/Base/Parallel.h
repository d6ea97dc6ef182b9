// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Loops on threads. They are started anew for each loop: less than two hundred a run, of 35 microseconds each, are too
/// few for a pool or a library (figures: Documentation/Design/Libraries.md), and every chunk here looks out for a stop.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace quadrille
{

/// The number of threads to use for a request: 0 means all hardware threads. At least 1.
int resolveThreads(int requested);

/// Calls body(begin, end) for consecutive chunks of [0, count) of at most chunkSize elements, on
/// `threads` threads (0: all). The chunks do not depend on the number of threads, so a body that
/// writes only what belongs to its chunk gives the same bytes for any number. The first exception
/// thrown by a body is rethrown here after all threads have stopped; so is Cancelled (see poll()).
void parallelFor(std::size_t count, std::size_t chunkSize, int threads,
  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body(i) for all i below count, the i of one chunk on one thread; Number: the type of i.
template <typename Number = std::size_t, typename Body>
void parallelForEach(std::size_t count, std::size_t chunkSize, int threads, const Body& body)
{
  parallelFor(count, chunkSize, threads,
    [&body](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        body(static_cast<Number>(i));
      }
    });
}

/// What body(begin, end, part) makes of each chunk, in the order of the chunks.
template <typename Part, typename Body>
std::vector<Part> parallelParts(
  std::size_t count, std::size_t chunkSize, int threads, const Body& body)
{
  std::vector<Part> parts((count + chunkSize - 1) / chunkSize);
  parallelFor(count, chunkSize, threads,
    [&](std::size_t begin, std::size_t end) { body(begin, end, parts[begin / chunkSize]); });
  return parts;
}

/// Calls body(i) for all i below count. Where it returns false for some, the lowest of these comes back, whatever the
/// number of threads; else count. Behind a refused one the rest of its chunk is left out.
template <typename Body>
std::size_t firstRefused(std::size_t count, std::size_t chunkSize, int threads, const Body& body)
{
  std::vector<std::size_t> refused((count + chunkSize - 1) / chunkSize, count);
  parallelFor(count, chunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (!body(i))
        {
          refused[begin / chunkSize] = i;
          return;
        }
      }
    });
  return refused.empty() ? count : *std::min_element(refused.begin(), refused.end());
}

} // namespace quadrille
