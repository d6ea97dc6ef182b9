// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SpaceFillingOrder.h"

#include "Base/Parallel.h"
#include "Mesh/Buckets.h"
#include "Mesh/PointSets.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{

namespace
{

/// 2^11 cells an axis: on a surface some 10^7 cells, so ten million vertices are about one a cell.
constexpr int kBitsOfCell = 11;

/// The keys' 33 bits are sorted by their upper 11 first, which leaves 22 to sort among the few points of a bucket.
constexpr std::size_t kDigitValues = std::size_t{ 1 } << kBitsOfCell;
constexpr int kLowerBits = 2 * kBitsOfCell;
/// Buckets below this size are sorted by comparing.
constexpr std::size_t kSmallKeyBucket = 512;
/// Cells whose keys are computed in step; a multiple of the lanes of any vector unit.
constexpr std::size_t kCellLanes = 32;

/// Coordinates of cells, axis by axis.
template <std::size_t kCount>
using Cells = std::array<std::array<std::uint32_t, kCount>, 3>;

/// Undoes the rotations and reflections of the sub-cubes, coarsest first, then Gray code [Skilling 2004]; without
/// branches, so that a compiler can take several cells at once.
template <std::size_t kCount>
void toHilbert(Cells<kCount>& cell, int bits)
{
  for (int bit = bits - 1; bit > 0; --bit)
  {
    const std::uint32_t lower = (1U << bit) - 1;
    for (std::size_t i = 0; i < kCount; ++i)
    {
      cell[0][i] ^= lower & (0U - (cell[0][i] >> bit & 1U));
    }
    for (std::size_t k = 1; k < 3; ++k)
    {
      for (std::size_t i = 0; i < kCount; ++i)
      {
        const std::uint32_t reflect = 0U - (cell[k][i] >> bit & 1U);
        const std::uint32_t swapped = (cell[0][i] ^ cell[k][i]) & lower & ~reflect;
        cell[0][i] ^= (lower & reflect) | swapped;
        cell[k][i] ^= swapped;
      }
    }
  }
  for (std::size_t i = 0; i < kCount; ++i)
  {
    cell[1][i] ^= cell[0][i];
    cell[2][i] ^= cell[1][i];
    std::uint32_t t = cell[2][i] >> 1; // every bit turns all bits below it
    t ^= t >> 1;
    t ^= t >> 2;
    t ^= t >> 4;
    t ^= t >> 8;
    t ^= t >> 16;
    cell[0][i] ^= t;
    cell[1][i] ^= t;
    cell[2][i] ^= t;
  }
}

/// Two zeros after each of the lower 21 bits.
std::uint64_t spread(std::uint32_t x)
{
  std::uint64_t s = x & 0x1FFFFFU;
  s = (s | s << 32) & 0x001F00000000FFFFULL;
  s = (s | s << 16) & 0x001F0000FF0000FFULL;
  s = (s | s << 8) & 0x100F00F00F00F00FULL;
  s = (s | s << 4) & 0x10C30C30C30C30C3ULL;
  return (s | s << 2) & 0x1249249249249249ULL;
}

template <std::size_t kCount>
std::uint64_t interleave(const Cells<kCount>& cell, std::size_t i)
{
  return spread(cell[0][i]) << 2 | spread(cell[1][i]) << 1 | spread(cell[2][i]);
}

std::vector<std::uint64_t> computeKeys(const std::vector<Vector3>& points, int threads)
{
  const PointBox box = boxOfPoints(points, threads);
  const Vector3& low = box.low;
  const double extent = (box.high - box.low).maxCoeff();
  const double last = (1 << kBitsOfCell) - 1;
  const double scale = extent > 0 ? last / extent : 0;

  std::vector<std::uint64_t> keys(points.size());
  parallelFor(points.size(), kLightChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t first = begin; first < end; first += kCellLanes)
      {
        const std::size_t count = std::min(kCellLanes, end - first);
        Cells<kCellLanes> cell{};
        for (std::size_t i = 0; i < count; ++i)
        {
          for (Index k = 0; k < 3; ++k)
          {
            const double x = (points[first + i][k] - low[k]) * scale;
            cell[k][i] = static_cast<std::uint32_t>(std::clamp(x, 0.0, last));
          }
        }
        toHilbert(cell, kBitsOfCell);
        for (std::size_t i = 0; i < count; ++i)
        {
          keys[first + i] = interleave(cell, i);
        }
      }
    });
  return keys;
}

/// Sorts the items of a bucket by their keys; least significant digit first, so that equal keys keep their order.
void sortKeyBucket(std::uint64_t* items, std::uint64_t* scratch, std::size_t count)
{
  if (count < kSmallKeyBucket)
  {
    std::sort(
      items, items + count); // the point is part of the item, so that equal keys keep their order
    return;
  }
  for (int shift = 32; shift < 32 + kLowerBits; shift += kBitsOfCell)
  {
    std::array<std::size_t, kDigitValues + 1> begin{};
    for (std::size_t i = 0; i < count; ++i)
    {
      ++begin[(items[i] >> shift & (kDigitValues - 1)) + 1];
    }
    for (std::size_t b = 1; b <= kDigitValues; ++b)
    {
      begin[b] += begin[b - 1];
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      scratch[begin[items[i] >> shift & (kDigitValues - 1)]++] = items[i];
    }
    std::swap(items, scratch);
  }
}

} // namespace

std::uint64_t hilbertKey(std::array<std::uint32_t, 3> cell, int bits)
{
  Cells<1> cells{ { { cell[0] }, { cell[1] }, { cell[2] } } };
  toHilbert(cells, bits);
  return interleave(cells, 0);
}

std::vector<Index> spaceFillingOrder(const std::vector<Vector3>& points, int threads)
{
  std::vector<std::uint64_t> keys = computeKeys(points, threads);
  // By their upper bits; an item is the lower ones of the key, and the point.
  constexpr std::uint64_t kLower = (std::uint64_t{ 1 } << kLowerBits) - 1;
  auto buckets = sortIntoBuckets<kDigitValues, std::uint64_t>(
    keys.size(), threads, [&](std::size_t i) { return keys[i] >> kLowerBits; },
    [&](std::size_t i) { return (keys[i] & kLower) << 32 | i; });
  std::vector<std::uint64_t>& items = buckets.items;
  const std::vector<std::size_t>& begin = buckets.begin;
  std::vector<Index> order(points.size());
  parallelFor(kDigitValues, 16, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t b = first; b < last; ++b)
      {
        sortKeyBucket(items.data() + begin[b], keys.data() + begin[b], begin[b + 1] - begin[b]);
      }
      for (std::size_t i = begin[first]; i < begin[last]; ++i)
      {
        order[i] = static_cast<Index>(items[i]);
      }
    });
  return order;
}

} // namespace quadrille
