// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All half-edges of a triangle list, grouped by the edge that they run along.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// Half-edges sorted into one bucket per lower vertex, and by the higher vertex within a bucket, so
/// that the half-edges of one edge are neighbours (a run). Linear for bounded valence, n log n for
/// a cone. Works on any triangle list whose triangles have three different corners.
class EdgeRuns
{
public:
  struct Entry
  {
    Index other; ///< the higher vertex
    Index halfEdge;
  };

  /// Throws InvalidInput when a corner is out of range or a face has a vertex twice.
  EdgeRuns(const std::vector<Index>& origin, Index vertexCount, int threads);

  /// Calls visit(begin, end) for the run of every edge, in the order of lower, then higher vertex. Looks out for a
  /// stop.
  template <typename Visitor>
  void forEach(Visitor&& visit) const
  {
    for (std::size_t v = 0; v < bucketCount(); ++v)
    {
      pollNowAndThen(v);
      forEachIn(v, visit);
    }
  }

  std::size_t bucketCount() const { return begin_.size() - 1; }

  /// The same for the edges with lower vertex v.
  template <typename Visitor>
  void forEachIn(std::size_t v, Visitor&& visit) const
  {
    const Entry* entry = entries_.data() + begin_[v];
    const Entry* const bucketEnd = entries_.data() + begin_[v + 1];
    while (entry != bucketEnd)
    {
      const Entry* runEnd = entry + 1;
      while (runEnd != bucketEnd && runEnd->other == entry->other)
      {
        ++runEnd;
      }
      visit(entry, runEnd);
      entry = runEnd;
    }
  }

private:
  void countEdges(const std::vector<Index>& origin, Index vertexCount);
  void fill(const std::vector<Index>& origin);
  void sortBuckets(int threads);

  std::vector<Index> begin_; ///< #V + 1
  std::vector<Entry> entries_;
};

/// Sorts the entries of one lower vertex by the higher one, then by half-edge.
void sortBucket(EdgeRuns::Entry* bucket, std::size_t count);

} // namespace quadrille
