// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/ElementEdges.h"

#include "Base/LargeArray.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

ElementEdges::ElementEdges(const ElementMesh& mesh) : mesh_(mesh)
{
  const std::size_t count = 4 * mesh.elementCount();
  growLarge(twin_, count, kInvalidIndex);
  growLarge(kinds_, count, std::uint8_t{ 0 });
  std::vector<Index> first;
  std::vector<Index> inBuckets; // half-edges by the lower node of their edge
  sortIntoBuckets(first, inBuckets);
  const auto key = [this](Index h) { return std::max(start(h), end(h)); };
  for (std::size_t v = 0; v + 1 < first.size(); ++v)
  {
    pollNowAndThen(v);
    Index* const begin = inBuckets.data() + first[v];
    Index* const bucketEnd = inBuckets.data() + first[v + 1];
    std::sort(begin, bucketEnd,
      [&](Index a, Index b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
    for (Index* run = begin; run != bucketEnd;)
    {
      Index* runEnd = std::find_if(run, bucketEnd, [&](Index h) { return key(h) != key(*run); });
      joinRun(run, runEnd);
      run = runEnd;
    }
  }
}

void ElementEdges::sortIntoBuckets(std::vector<Index>& first, std::vector<Index>& inBuckets) const
{
  growLarge(first, mesh_.nodes.size() + 2, Index{ 0 });
  growLarge(inBuckets, twin_.size(), Index{ 0 });
  const auto lower = [this](Index h) { return std::min(start(h), end(h)); };
  for (Index h = 0; h < halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    ++first[lower(h) + 2];
  }
  for (std::size_t v = 2; v < first.size(); ++v)
  {
    first[v] += first[v - 1];
  }
  for (Index h = 0; h < halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    inBuckets[first[lower(h) + 1]++] = h;
  }
  first.pop_back();
}

/// Half-edges of one edge, the lowest first.
void ElementEdges::joinRun(const Index* begin, const Index* end)
{
  const auto count = end - begin;
  bool feature = count > 2;
  for (const Index* h = begin; h != end; ++h)
  {
    feature = feature ||
      (!mesh_.featureEdges.empty() && ((mesh_.featureEdges[*h / 4] >> (*h % 4)) & 1) != 0);
  }
  if (count == 2)
  {
    twin_[begin[0]] = begin[1];
    twin_[begin[1]] = begin[0];
  }
  for (const Index* h = begin; h != end; ++h)
  {
    kinds_[*h] = static_cast<std::uint8_t>((count == 1   ? kBoundary
                                               : feature ? kFeature
                                                         : 0) |
      (h == begin ? kLowestHalfEdge : 0));
  }
}

Index ElementEdges::otherSide(Index h, Index node) const
{
  const Index side = h % 4;
  return h - side + (start(h) == node ? (side + 3) % 4 : (side + 1) % 4);
}

} // namespace quadrille
