// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Loops on threads. They are started anew for each loop: less than two hundred a run, of 35 microseconds each, are too
/// few for a pool or a library (figures: Documentation/Design/Libraries.md), and every chunk here looks out for a stop.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

namespace quadrille
{

/// Sizes of chunks, by the time that an element takes: some nanoseconds; some hundred, with data of a chunk that fit a
/// second level cache; a microsecond and more. Where parts are sums of floating-point numbers their bytes follow from
/// the size.
constexpr std::size_t kLightChunk = std::size_t{ 1 } << 16;
constexpr std::size_t kMediumChunk = std::size_t{ 1 } << 12;
constexpr std::size_t kHeavyChunk = std::size_t{ 1 } << 8;

/// The number of threads to use for a request: 0 means all hardware threads. At least 1.
int resolveThreads(int requested);

/// Calls body(begin, end) for consecutive chunks of [0, count) of at most chunkSize elements, on
/// `threads` threads (0: all). The chunks do not depend on the number of threads, so a body that
/// writes only what belongs to its chunk gives the same bytes for any number. The first exception
/// thrown by a body is rethrown here after all threads have stopped; so is Cancelled (see poll()).
void parallelFor(std::size_t count, std::size_t chunkSize, int threads,
  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The same for a body(i) of each element by itself.
template <typename Id, typename Body>
void parallelForEach(Id count, std::size_t chunkSize, int threads, const Body& body)
{
  parallelFor(count, chunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Id i = static_cast<Id>(begin); i < end; ++i)
      {
        body(i);
      }
    });
}

/// The same for a body(begin, end, part) with a part for each chunk; returns the parts in the order of the chunks.
template <typename Part, typename Id, typename Body>
std::vector<Part> parallelParts(Id count, std::size_t chunkSize, int threads, const Body& body)
{
  std::vector<Part> parts((count + chunkSize - 1) / chunkSize);
  parallelFor(count, chunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    { body(static_cast<Id>(begin), static_cast<Id>(end), parts[begin / chunkSize]); });
  return parts;
}

/// Calls body(id, list) for all ids below count; what they add to the list, in their order, whatever the number of
/// threads.
template <typename Item, typename Id, typename Body>
std::vector<Item> parallelGather(Id count, std::size_t chunkSize, int threads, const Body& body)
{
  const auto parts = parallelParts<std::vector<Item>>(count, chunkSize, threads,
    [&](Id begin, Id end, std::vector<Item>& part)
    {
      for (Id i = begin; i < end; ++i)
      {
        body(i, part);
      }
    });
  std::vector<Item> all;
  for (const std::vector<Item>& part : parts)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// The ids below count for which select(id) holds, ascending, whatever the number of threads.
template <typename Id, typename Select>
std::vector<Id> parallelSelect(Id count, std::size_t chunkSize, int threads, const Select& select)
{
  return parallelGather<Id>(count, chunkSize, threads,
    [&](Id i, std::vector<Id>& selected)
    {
      if (select(i))
      {
        selected.push_back(i);
      }
    });
}

/// The number of ids below count for which counts(id) holds.
template <typename Id, typename Counts>
std::size_t parallelCount(Id count, std::size_t chunkSize, int threads, const Counts& counts)
{
  const auto parts = parallelParts<std::size_t>(count, chunkSize, threads,
    [&](Id begin, Id end, std::size_t& part)
    {
      std::size_t found = 0;
      for (Id i = begin; i < end; ++i)
      {
        found += counts(i) ? 1U : 0U;
      }
      part = found;
    });
  return std::accumulate(parts.begin(), parts.end(), std::size_t{ 0 });
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
