// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/UniformDecimation.h"

#include "Base/Parallel.h"
#include "Hierarchy/VertexRemoval.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

namespace quadrille
{

namespace
{

/// Live faces of a block. Large against its border, small enough for many blocks in a scan.
constexpr std::size_t kBlockFaces = 16384;
constexpr double kThresholdStep = 1.5;
constexpr int kLastRounds = 8;
/// Lock of a vertex that must stay.
constexpr std::uint16_t kKept = 0xFFFF;
/// Owner of a vertex whose faces are in several blocks.
constexpr Index kShared = kInvalidIndex - 1;

class UniformDecimation
{
public:
  UniformDecimation(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
    : mesh_(mesh), options_(options), log_(log),
      owner_(new std::atomic<Index>[mesh.position.size()]), lock_(mesh.position.size(), 0)
  {
    guards_.curveTolerance = options.curveTolerance;
    for (const Index v : options.keepVertices)
    {
      lock_[v] = kKept;
    }
  }

  void run();

private:
  double firstThreshold() const;
  std::size_t round(double threshold, bool serial);
  std::vector<Index> blockBorders(bool serial);
  void assignOwners(const std::vector<Index>& borders);
  void sweep(Index begin, Index end, Index block, double threshold, std::uint16_t stamp,
    VertexRemoval& removal, RecordWriter& log);
  bool visit(
    Index h, Index block, double threshold, std::uint16_t stamp, VertexRemoval& removal) const;

  DecimationMesh& mesh_;
  const UniformOptions& options_;
  LogBuilder& log_;
  RemovalGuards guards_;
  std::unique_ptr<std::atomic<Index>[]> owner_;
  std::vector<std::uint16_t> lock_; ///< number of the last sweep that changed the vertex's star
  std::uint16_t sweeps_ = 0;
  bool shifted_ = false;
};

/// Sweeps inside one round. The second one takes what the first one locked while the block is in the cache.
constexpr int kSweepsPerRound = 2;

void UniformDecimation::run()
{
  const double last = options_.edgeLength;
  double threshold = std::min(firstThreshold(), last);
  const double steps =
    std::max(1.0, std::ceil(std::log(last / threshold) / std::log(kThresholdStep)));
  int done = 0;
  for (; threshold < last; threshold *= kThresholdStep)
  {
    report(options_.progress, ++done / (steps + 2), "uniform decimation");
    round(threshold, false);
  }
  std::size_t alive = static_cast<std::size_t>(std::count_if(
    mesh_.outgoing.begin(), mesh_.outgoing.end(), [](Index h) { return h != kInvalidIndex; }));
  for (int i = 0; i < kLastRounds; ++i)
  {
    report(options_.progress, (steps + 1) / (steps + 2), "uniform decimation");
    const bool serial = i + 2 >= kLastRounds;
    const std::size_t removed = round(last, serial);
    alive -= removed;
    if (serial && removed * 200 < alive)
    {
      break;
    }
    if (removed * 50 < alive)
    {
      i = std::max(i, kLastRounds - 3); // only what sits at the borders of the blocks is left
    }
  }
}

double UniformDecimation::firstThreshold() const
{
  double sum = 0;
  std::size_t count = 0;
  for (Index h = 0; h < 3 * mesh_.faceCount(); h += 7)
  {
    sum += (mesh_.position[mesh_.target(h)] - mesh_.position[mesh_.origin[h]]).norm();
    ++count;
  }
  return std::max(
    sum / static_cast<double>(std::max<std::size_t>(count, 1)), 1e-6 * options_.edgeLength);
}

std::vector<Index> UniformDecimation::blockBorders(bool serial)
{
  std::vector<Index> borders{ 0 };
  if (!serial)
  {
    std::size_t count = shifted_ ? kBlockFaces / 2 : 0;
    shifted_ = !shifted_;
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      count += mesh_.isAlive(f) ? 1U : 0U;
      if (count >= kBlockFaces)
      {
        borders.push_back(f + 1);
        count = 0;
      }
    }
  }
  if (borders.back() != mesh_.faceCount())
  {
    borders.push_back(mesh_.faceCount());
  }
  return borders;
}

void UniformDecimation::assignOwners(const std::vector<Index>& borders)
{
  const std::size_t vertices = mesh_.position.size();
  parallelFor(vertices, 1U << 16, options_.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        owner_[v].store(kInvalidIndex, std::memory_order_relaxed);
      }
    });
  parallelFor(borders.size() - 1, 1, options_.threads,
    [&](std::size_t block, std::size_t)
    {
      for (Index h = 3 * borders[block]; h < 3 * borders[block + 1]; ++h)
      {
        if (mesh_.origin[h - h % 3] == kInvalidIndex)
        {
          h += 2; // a dead face, entered at its first corner
          continue;
        }
        // Whatever the order of the blocks: one block leaves its number, two leave kShared.
        std::atomic<Index>& owner = owner_[mesh_.origin[h]];
        Index seen = owner.load(std::memory_order_relaxed);
        if (seen == block || seen == kShared)
        {
          continue;
        }
        if (seen != kInvalidIndex ||
          !owner.compare_exchange_strong(seen, static_cast<Index>(block)))
        {
          owner.store(kShared, std::memory_order_relaxed);
        }
      }
    });
}

std::size_t UniformDecimation::round(double threshold, bool serial)
{
  const std::vector<Index> borders = blockBorders(serial);
  assignOwners(borders);
  std::vector<RecordWriter> logs(borders.size() - 1);
  const std::uint16_t firstStamp = static_cast<std::uint16_t>(sweeps_ + 1);
  sweeps_ = static_cast<std::uint16_t>(sweeps_ + kSweepsPerRound);
  parallelFor(logs.size(), 1, options_.threads,
    [&](std::size_t block, std::size_t)
    {
      VertexRemoval removal(mesh_);
      for (int i = 0; i < kSweepsPerRound; ++i)
      {
        sweep(borders[block], borders[block + 1], static_cast<Index>(block), threshold,
          static_cast<std::uint16_t>(firstStamp + i), removal, logs[block]);
      }
    });
  return log_.addRound(std::move(logs));
}

void UniformDecimation::sweep(Index begin, Index end, Index block, double threshold,
  std::uint16_t stamp, VertexRemoval& removal, RecordWriter& log)
{
  for (Index f = begin; f < end; ++f)
  {
    // A removal may kill the very face that is being visited.
    for (Index h = 3 * f; h < 3 * f + 3 && mesh_.isAlive(f); ++h)
    {
      if (!visit(h, block, threshold, stamp, removal))
      {
        continue;
      }
      for (int i = 0; i < removal.ringSize(); ++i)
      {
        std::uint16_t& lock = lock_[removal.ringVertex(i)];
        lock = lock == kKept ? kKept : stamp;
      }
      removal.apply(log);
    }
  }
}

bool UniformDecimation::visit(
  Index h, Index block, double threshold, std::uint16_t stamp, VertexRemoval& removal) const
{
  const Index v = mesh_.origin[h];
  if (mesh_.outgoing[v] != h || owner_[v].load(std::memory_order_relaxed) != block ||
    lock_[v] == stamp || lock_[v] == kKept || !removal.gather(v))
  {
    return false;
  }
  const double scale = options_.scale.empty() ? 1.0 : double{ options_.scale[v] };
  if (!(removal.shortestEdge() < std::min(threshold, options_.edgeLength * scale)))
  {
    return false;
  }
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    if (owner_[removal.ringVertex(i)].load(std::memory_order_relaxed) != block)
    {
      return false;
    }
  }
  return removal.plan(guards_);
}

} // namespace

void decimateUniformly(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
{
  UniformDecimation(mesh, options, log).run();
}

} // namespace quadrille
