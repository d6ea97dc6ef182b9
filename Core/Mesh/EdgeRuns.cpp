// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/EdgeRuns.h"

#include "Base/Error.h"
#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <algorithm>
#include <array>
#include <string>

namespace quadrille
{

namespace
{

/// Up to this size a bucket is sorted by counting for each entry how many come before it, which needs no branch
/// that depends on data; a vertex of most meshes has about three edges to higher ones.
constexpr std::size_t kSmallBucket = 16;

void checkFace(const Index* corner, Index face, Index vertexCount)
{
  for (int i = 0; i < 3; ++i)
  {
    if (corner[i] >= vertexCount)
    {
      throw InvalidInput("face " + std::to_string(face) + " names vertex " +
        std::to_string(corner[i]) + " of " + std::to_string(vertexCount));
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    if (corner[i] == corner[(i + 1) % 3])
    {
      throw InvalidInput("face " + std::to_string(face) + " has vertex " +
        std::to_string(corner[i]) + " at two corners");
    }
  }
}

std::uint64_t sortKey(const EdgeRuns::Entry& entry)
{
  return std::uint64_t{ entry.other } << 32 | entry.halfEdge;
}

} // namespace

void sortBucket(EdgeRuns::Entry* bucket, std::size_t count)
{
  if (count > kSmallBucket)
  {
    std::sort(bucket, bucket + count,
      [](const EdgeRuns::Entry& a, const EdgeRuns::Entry& b) { return sortKey(a) < sortKey(b); });
    return;
  }
  std::array<EdgeRuns::Entry, kSmallBucket> entry;
  std::array<std::uint32_t, kSmallBucket> place;
  for (std::size_t i = 0; i < count; ++i)
  {
    entry[i] = bucket[i];
    place[i] = 0;
    for (std::size_t j = 0; j < i; ++j)
    {
      const std::uint32_t before = sortKey(entry[j]) < sortKey(entry[i]) ? 1 : 0;
      place[i] += before;
      place[j] += 1 - before;
    }
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    bucket[place[i]] = entry[i];
  }
}

EdgeRuns::EdgeRuns(const std::vector<Index>& origin, Index vertexCount, int threads)
{
  refuseIf(origin.size() % 3 != 0, "the corner list has ", origin.size(),
    " entries, which is no multiple of 3");
  countEdges(origin, vertexCount);
  fill(origin);
  sortBuckets(threads);
}

void EdgeRuns::countEdges(const std::vector<Index>& origin, Index vertexCount)
{
  // Shifted by two, so that filling turns the array into the bucket begins without a second copy.
  begin_.assign(std::size_t{ vertexCount } + 2, 0);
  for (std::size_t h = 0; h < origin.size(); h += 3)
  {
    pollNowAndThen(h / 3);
    const Index* corner = &origin[h];
    checkFace(corner, static_cast<Index>(h / 3), vertexCount);
    ++begin_[std::size_t{ std::min(corner[0], corner[1]) } + 2];
    ++begin_[std::size_t{ std::min(corner[1], corner[2]) } + 2];
    ++begin_[std::size_t{ std::min(corner[2], corner[0]) } + 2];
  }
  for (std::size_t v = 2; v < begin_.size(); ++v)
  {
    begin_[v] += begin_[v - 1];
  }
}

void EdgeRuns::fill(const std::vector<Index>& origin)
{
  growLarge(entries_, origin.size());
  const auto put = [&](Index a, Index b, Index h) {
    entries_[begin_[std::size_t{ std::min(a, b) } + 1]++] = { std::max(a, b), h };
  };
  for (Index h = 0; h < origin.size(); h += 3)
  {
    pollNowAndThen(h / 3);
    put(origin[h], origin[h + 1], h);
    put(origin[h + 1], origin[h + 2], h + 1);
    put(origin[h + 2], origin[h], h + 2);
  }
  begin_.pop_back();
}

void EdgeRuns::sortBuckets(int threads)
{
  parallelForEach(begin_.size() - 1, kMediumChunk, threads,
    [&](std::size_t v) { sortBucket(entries_.data() + begin_[v], begin_[v + 1] - begin_[v]); });
}

} // namespace quadrille
