// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/EdgeRuns.h"

#include "Base/Error.h"
#include "Base/Parallel.h"

#include <algorithm>
#include <string>

namespace quadrille
{

namespace
{

constexpr std::size_t kBucketChunk = 16384;

Index targetOf(const std::vector<Index>& origin, Index h)
{
  return origin[Mesh::next(h)];
}

void checkCorners(const std::vector<Index>& origin, Index vertexCount)
{
  if (origin.size() % 3 != 0)
  {
    throw InvalidInput("the corner list has " + std::to_string(origin.size()) +
      " entries, which is no multiple of 3");
  }
  for (Index h = 0; h < origin.size(); ++h)
  {
    if (origin[h] >= vertexCount)
    {
      throw InvalidInput("face " + std::to_string(h / 3) + " names vertex " +
        std::to_string(origin[h]) + " of " + std::to_string(vertexCount));
    }
    if (origin[h] == targetOf(origin, h))
    {
      throw InvalidInput("face " + std::to_string(h / 3) + " has vertex " +
        std::to_string(origin[h]) + " at two corners");
    }
  }
}

} // namespace

EdgeRuns::EdgeRuns(const std::vector<Index>& origin, Index vertexCount, int threads)
{
  checkCorners(origin, vertexCount);
  fill(origin, vertexCount);
  sortBuckets(threads);
}

void EdgeRuns::fill(const std::vector<Index>& origin, Index vertexCount)
{
  const Index count = static_cast<Index>(origin.size());
  // Shifted by two, so that filling turns the array into the bucket begins without a second copy.
  begin_.assign(std::size_t{ vertexCount } + 2, 0);
  for (Index h = 0; h < count; ++h)
  {
    ++begin_[std::size_t{ std::min(origin[h], targetOf(origin, h)) } + 2];
  }
  for (std::size_t v = 2; v < begin_.size(); ++v)
  {
    begin_[v] += begin_[v - 1];
  }
  entries_.resize(count);
  for (Index h = 0; h < count; ++h)
  {
    const Index a = origin[h];
    const Index b = targetOf(origin, h);
    entries_[begin_[std::size_t{ std::min(a, b) } + 1]++] = { std::max(a, b), h };
  }
  begin_.pop_back();
}

void EdgeRuns::sortBuckets(int threads)
{
  const auto before = [](const Entry& a, const Entry& b)
  { return a.other != b.other ? a.other < b.other : a.halfEdge < b.halfEdge; };
  parallelFor(begin_.size() - 1, kBucketChunk, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t v = first; v < last; ++v)
      {
        std::sort(entries_.begin() + begin_[v], entries_.begin() + begin_[v + 1], before);
      }
    });
}

} // namespace quadrille
