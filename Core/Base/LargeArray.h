// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Arrays of the size of a large mesh: fresh memory comes at 2 GB/s, so that filling one takes longer than a run may
/// take to stop.
#pragma once

#include "Base/Memory.h"
#include "Base/Progress.h"
#include "Base/SharedArray.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace quadrille
{

/// Bytes that are taken at a time, between two looks at the clock: 4 ms of fresh memory.
constexpr std::size_t kLargeArrayStep = std::size_t{ 1 } << 23;

/// values.resize(count, value...), with poll() in between; values must not have more already.
template <typename T, typename... Value>
void growLarge(std::vector<T>& values, std::size_t count, const Value&... value)
{
  values.reserve(count);
  while (values.size() < count)
  {
    poll();
    values.resize(std::min(count, values.size() + kLargeArrayStep / sizeof(T)), value...);
  }
}

/// values.reserve(count), of fresh memory that several threads ask for (0: all). The arrays of a large mesh wait for it
/// otherwise, on one thread.
template <typename T>
void reserveLarge(std::vector<T>& values, std::size_t count, int threads)
{
  if (values.capacity() < count)
  {
    values.reserve(count);
    provideMemory(static_cast<void*>(values.data() + values.size()),
      (values.capacity() - values.size()) * sizeof(T), threads);
  }
}

/// Room for a few elements more than `count`, so that changes at single places later move no array of this size.
template <typename T>
void reserveWithRoom(std::vector<T>& values, std::size_t count, int threads)
{
  reserveLarge(values, count + count / 256 + 1024, threads);
}

/// values.assign(count, value), with poll() in between.
template <typename T>
void fillLarge(std::vector<T>& values, std::size_t count, const T& value, int threads = 1)
{
  values.clear();
  reserveLarge(values, count, threads);
  growLarge(values, count, value);
}

/// The same of arrays that may be shared.
template <typename T, typename... Value>
void growLarge(SharedArray<T>& values, std::size_t count, const Value&... value)
{
  values.change([&](std::vector<T>& own) { growLarge(own, count, value...); });
}
template <typename T>
void reserveWithRoom(SharedArray<T>& values, std::size_t count, int threads)
{
  values.change([&](std::vector<T>& own) { reserveWithRoom(own, count, threads); });
}
template <typename T>
void fillLarge(SharedArray<T>& values, std::size_t count, const T& value, int threads = 1)
{
  std::vector<T> filled;
  fillLarge(filled, count, value, threads);
  values = std::move(filled);
}

/// to = from, with poll() in between.
template <typename Array, typename T>
void copyLarge(const Array& from, std::vector<T>& to)
{
  to.clear();
  to.reserve(from.size());
  while (to.size() < from.size())
  {
    poll();
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(to.size());
    const std::size_t count = std::min(from.size() - to.size(), kLargeArrayStep / sizeof(T));
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  }
}

} // namespace quadrille
