// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/CleanSurface.h"

#include "Base/DisjointSets.h"
#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Mesh/EdgeRuns.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Prepare/DegenerateFaces.h"
#include "Prepare/MergePoints.h"
#include "Prepare/Sheets.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>

namespace quadrille
{

namespace
{

/// Vertices of a block. Its half-edges, about six times as many, take 800 kB.
constexpr Index kBlockVertices = 16384;
constexpr std::size_t kCleanChunk = std::size_t{ 1 } << 15;

Index lowestCorner(const Mesh& mesh, Index f)
{
  const Index* corner = &mesh.origin[3 * std::size_t{ f }];
  return std::min({ corner[0], corner[1], corner[2] });
}

/// A half-edge that is sorted in the block of its lower vertex, which is not that of its face.
struct PassedOn
{
  Index lower;
  EdgeRuns::Entry entry;
};

/// Finds the twins, block by block.
class EdgeBlocks
{
public:
  EdgeBlocks(Mesh& mesh, int threads)
    : mesh_(mesh), threads_(threads),
      count_((std::size_t{ mesh.vertexCount() } + kBlockVertices - 1) / kBlockVertices)
  {
  }

  /// Whether each edge has one face, or two that agree in orientation and are not the same. Fills twins then, and
  /// `open`, of the edges with one face their half-edges in the order of lower, then higher vertex.
  bool connect(std::vector<Index>& open)
  {
    passOn();
    reserveWithRoom(mesh_.twin, mesh_.origin.size(), threads_);
    growLarge(mesh_.twin, mesh_.origin.size());
    twin_ = mesh_.twin.edit();
    std::vector<std::vector<Index>> opens(count_);
    parallelFor(count_, 1, threads_,
      [&](std::size_t block, std::size_t)
      {
        if (isClean_.load(std::memory_order_relaxed) && !connectBlock(block, opens[block]))
        {
          isClean_.store(false, std::memory_order_relaxed);
        }
      });
    for (const std::vector<Index>& part : opens)
    {
      open.insert(open.end(), part.begin(), part.end());
    }
    return isClean_;
  }

private:
  Index firstVertex(std::size_t block) const
  {
    return static_cast<Index>(std::min<std::size_t>(block * kBlockVertices, mesh_.vertexCount()));
  }

  /// The first face whose lowest vertex is not below v; faces ascend by it.
  Index firstFace(Index v) const
  {
    Index low = 0;
    for (Index count = mesh_.faceCount(); count > 0;)
    {
      const Index half = count / 2;
      const bool isBelow = lowestCorner(mesh_, low + half) < v;
      low = isBelow ? low + half + 1 : low;
      count = isBelow ? count - half - 1 : half;
    }
    return low;
  }

  /// Calls visit(lower vertex, entry) for the half-edges of a face.
  template <typename Visitor>
  void forEachEdge(Index f, Visitor&& visit) const
  {
    const Index* v = &mesh_.origin[3 * std::size_t{ f }];
    for (Index i = 0; i < 3; ++i)
    {
      const Index a = v[i], b = v[i == 2 ? 0 : i + 1];
      visit(std::min(a, b), EdgeRuns::Entry{ std::max(a, b), 3 * f + i });
    }
  }

  void passOn()
  {
    std::vector<std::vector<PassedOn>> given(count_);
    parallelFor(count_, 1, threads_,
      [&](std::size_t block, std::size_t)
      {
        const Index end = firstVertex(block + 1);
        const Index lastFace = firstFace(end);
        for (Index f = firstFace(firstVertex(block)); f < lastFace; ++f)
        {
          forEachEdge(f,
            [&](Index lower, const EdgeRuns::Entry& entry)
            {
              if (lower >= end)
              {
                given[block].push_back({ lower, entry });
              }
            });
        }
      });
    taken_.resize(count_);
    for (const std::vector<PassedOn>& part : given)
    {
      poll();
      for (const PassedOn& half : part)
      {
        taken_[half.lower / kBlockVertices].push_back(half);
      }
    }
  }

  bool connectBlock(std::size_t block, std::vector<Index>& open)
  {
    const Index first = firstVertex(block), end = firstVertex(block + 1);
    const Index firstFaceOfBlock = firstFace(first), lastFace = firstFace(end);
    std::vector<Index> begin(std::size_t{ end - first } + 2, 0);
    const auto forEachHalfEdge = [&](const auto& visit)
    {
      for (Index f = firstFaceOfBlock; f < lastFace; ++f)
      {
        forEachEdge(f,
          [&](Index lower, const EdgeRuns::Entry& entry)
          {
            if (lower < end)
            {
              visit(lower, entry);
            }
          });
      }
      for (const PassedOn& half : taken_[block])
      {
        visit(half.lower, half.entry);
      }
    };
    // Shifted by two, so that filling leaves the array with the beginnings.
    forEachHalfEdge([&](Index lower, const EdgeRuns::Entry&) { ++begin[lower - first + 2]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<EdgeRuns::Entry> entries(begin.back());
    forEachHalfEdge([&](Index lower, const EdgeRuns::Entry& entry)
      { entries[begin[lower - first + 1]++] = entry; });
    taken_[block] = {};
    for (Index v = 0; v < end - first; ++v)
    {
      EdgeRuns::Entry* const bucket = entries.data() + begin[v];
      sortBucket(bucket, begin[v + 1] - begin[v]);
      for (EdgeRuns::Entry* entry = bucket; entry != entries.data() + begin[v + 1];)
      {
        const std::size_t rest = static_cast<std::size_t>(entries.data() + begin[v + 1] - entry);
        const std::size_t faces = connectEdge(entry, rest, open);
        if (faces == 0)
        {
          return false;
        }
        entry += faces;
      }
    }
    return true;
  }

  /// The number of faces of the edge that begins at `entry`, of which there are `rest`; 0 where it is not clean.
  std::size_t connectEdge(
    const EdgeRuns::Entry* entry, std::size_t rest, std::vector<Index>& open) const
  {
    const auto isSame = [&](std::size_t i) { return i < rest && entry[i].other == entry->other; };
    const Index h = entry->halfEdge;
    if (!isSame(1))
    {
      twin_[h] = kInvalidIndex;
      open.push_back(h);
      return 1;
    }
    const Index g = entry[1].halfEdge;
    const bool isDuplicate = mesh_.origin[Mesh::previous(h)] == mesh_.origin[Mesh::previous(g)];
    if (isSame(2) || mesh_.origin[h] == mesh_.origin[g] || isDuplicate)
    {
      return 0;
    }
    twin_[h] = g;
    twin_[g] = h;
    return 2;
  }

  Mesh& mesh_;
  Index* twin_ = nullptr; ///< of the mesh, to be written
  int threads_;
  std::size_t count_;
  std::vector<std::vector<PassedOn>> taken_; ///< by each block
  std::atomic<bool> isClean_{ true };
};

/// Whether each vertex has one fan: then any one of its fans has all of its half-edges.
bool hasSingleFans(const Mesh& mesh, const std::atomic<Index>* outgoing, int threads)
{
  const auto counts = parallelParts<std::size_t>(mesh.vertexCount(), kBlockVertices, threads,
    [&](Index begin, Index end, std::size_t& count)
    {
      for (Index v = begin; v < end; ++v)
      {
        const Index h = outgoing[v].load(std::memory_order_relaxed);
        if (h != kInvalidIndex)
        {
          forEachInFan(mesh, h, [&](Index) { ++count; });
        }
      }
    });
  return std::accumulate(counts.begin(), counts.end(), std::size_t{ 0 }) == mesh.origin.size();
}

/// Whether no face is degenerate. Counts the components, and splits vertices of several fans.
bool isWithoutSlivers(PreparedSurface& surface, int threads)
{
  const Mesh& mesh = surface.mesh;
  DisjointSets components(mesh.faceCount(), threads);
  std::unique_ptr<std::atomic<Index>[]> outgoing(new std::atomic<Index>[mesh.vertexCount()]);
  parallelForEach(mesh.vertexCount(), kBlockVertices, threads,
    [&](std::size_t v) { outgoing[v].store(kInvalidIndex, std::memory_order_relaxed); });
  const std::size_t faces = mesh.faceCount();
  const std::size_t refused = firstRefused(faces, kCleanChunk, threads,
    [&](std::size_t face)
    {
      const Index f = static_cast<Index>(face);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        // Which half-edge of a vertex stays there does not matter.
        outgoing[mesh.origin[h]].store(h, std::memory_order_relaxed);
        if (mesh.twin[h] < h)
        {
          components.join(f, Mesh::face(mesh.twin[h]));
        }
      }
      return !isDegenerate(mesh, f);
    });
  if (refused < faces)
  {
    return false;
  }
  surface.components = static_cast<Index>(components.countSets());
  if (!hasSingleFans(mesh, outgoing.get(), threads))
  {
    surface.repair.nonManifoldVertices += splitVertexFans(surface.mesh);
    orderSurface(surface, threads);
  }
  return true;
}

} // namespace

bool connectCleanSurface(PreparedSurface& surface, int threads)
{
  std::vector<Index> open;
  // A closed component of less than four faces would have two that are the same.
  return EdgeBlocks(surface.mesh, threads).connect(open) && !wouldMerge(surface.mesh, open) &&
    isWithoutSlivers(surface, threads);
}

} // namespace quadrille
