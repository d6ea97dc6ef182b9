// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/ElementEdges.h"

#include "Base/LargeArray.h"
#include "Base/Lists.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

ElementEdges::ElementEdges(const ElementMesh& mesh) : mesh_(mesh)
{
  const std::size_t count = 4 * mesh.elementCount();
  growLarge(twin_, count, kInvalidIndex);
  growLarge(kinds_, count, std::uint8_t{ 0 });
  const Grouped<> byLowerNode(mesh.nodes.size(),
    [this](const auto& visit)
    {
      for (Index h = 0; h < halfEdgeCount(); ++h)
      {
        pollNowAndThen(h);
        visit(std::min(start(h), end(h)), h);
      }
    });
  const auto key = [this](Index h) { return std::max(start(h), end(h)); };
  std::vector<Index> bucket;
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
  {
    pollNowAndThen(v);
    bucket.assign(byLowerNode.begin(v), byLowerNode.end(v));
    std::sort(bucket.begin(), bucket.end(),
      [&](Index a, Index b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
    const Index* const bucketEnd = bucket.data() + bucket.size();
    for (const Index* run = bucket.data(); run != bucketEnd;)
    {
      const Index* runEnd =
        std::find_if(run, bucketEnd, [&](Index h) { return key(h) != key(*run); });
      joinRun(run, runEnd);
      run = runEnd;
    }
  }
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
