// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/UniformDecimation.h"

#include "Base/Parallel.h"
#include "Hierarchy/VertexRemoval.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>

namespace quadrille
{

namespace
{

/// Live faces of a block. Large against its border, small enough for many blocks in a scan.
constexpr std::size_t kBlockFaces = 16384;
constexpr double kThresholdStep = 1.5;
/// Rounds at the last threshold, at most.
constexpr int kLastRounds = 40;
/// Lock of a vertex that must stay.
constexpr std::uint16_t kKept = 0xFFFF;
/// Owner of a vertex whose faces are in several blocks.
constexpr Index kShared = kInvalidIndex - 1;

class UniformDecimation
{
public:
  UniformDecimation(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
    : mesh_(mesh), options_(options), log_(log),
      owner_(new std::atomic<Index>[mesh.position.size()]), lock_(mesh.position.size(), 0),
      faces_(mesh.faceCount())
  {
    guards_.curveTolerance = options.curveTolerance;
    std::iota(faces_.begin(), faces_.end(), Index{ 0 });
    for (const Index v : options.keepVertices)
    {
      lock_[v] = kKept;
    }
  }

  void run();

private:
  double firstThreshold() const;
  std::size_t round(double threshold, bool serial);
  std::vector<std::size_t> blockBorders(bool serial);
  void assignOwners(const std::vector<std::size_t>& borders);
  void sweep(std::size_t begin, std::size_t end, Index block, double threshold, std::uint16_t stamp,
    VertexRemoval& removal, RecordWriter& log);
  bool visit(
    Index h, Index block, double threshold, std::uint16_t stamp, VertexRemoval& removal) const;

  DecimationMesh& mesh_;
  const UniformOptions& options_;
  LogBuilder& log_;
  RemovalGuards guards_;
  std::unique_ptr<std::atomic<Index>[]> owner_;
  std::vector<std::uint16_t> lock_; ///< number of the last sweep that changed the vertex's star
  std::vector<Index> faces_;        ///< alive at the beginning of the round
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
  // Parallel rounds while they pay, then serial ones, which also reach what sits at the borders of the blocks.
  bool serial = false;
  for (int i = 0; i < kLastRounds; ++i)
  {
    report(options_.progress, (steps + 1) / (steps + 2), "uniform decimation");
    const std::size_t removed = round(last, serial);
    if (serial && removed * 500 < faces_.size())
    {
      break;
    }
    serial = serial || removed * 100 < faces_.size() || i + 2 == kLastRounds;
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

/// Borders of the blocks as positions in faces_.
std::vector<std::size_t> UniformDecimation::blockBorders(bool serial)
{
  std::vector<std::size_t> borders{ 0 };
  if (!serial)
  {
    const std::size_t first = shifted_ ? kBlockFaces / 2 : kBlockFaces;
    shifted_ = !shifted_;
    for (std::size_t border = first; border < faces_.size(); border += kBlockFaces)
    {
      borders.push_back(border);
    }
  }
  borders.push_back(faces_.size());
  return borders;
}

void UniformDecimation::assignOwners(const std::vector<std::size_t>& borders)
{
  const auto forEachCorner = [&](const auto& body)
  {
    parallelFor(borders.size() - 1, 1, options_.threads,
      [&](std::size_t block, std::size_t)
      {
        for (std::size_t i = borders[block]; i < borders[block + 1]; ++i)
        {
          const Index h = 3 * faces_[i];
          body(owner_[mesh_.origin[h]], static_cast<Index>(block));
          body(owner_[mesh_.origin[h + 1]], static_cast<Index>(block));
          body(owner_[mesh_.origin[h + 2]], static_cast<Index>(block));
        }
      });
  };
  forEachCorner([](std::atomic<Index>& owner, Index)
    { owner.store(kInvalidIndex, std::memory_order_relaxed); });
  forEachCorner(
    [](std::atomic<Index>& owner, Index block)
    {
      // Whatever the order of the blocks: one block leaves its number, two leave kShared.
      Index seen = owner.load(std::memory_order_relaxed);
      if (seen == block || seen == kShared)
      {
        return;
      }
      if (seen != kInvalidIndex || !owner.compare_exchange_strong(seen, block))
      {
        owner.store(kShared, std::memory_order_relaxed);
      }
    });
}

std::size_t UniformDecimation::round(double threshold, bool serial)
{
  faces_.erase(
    std::remove_if(faces_.begin(), faces_.end(), [&](Index f) { return !mesh_.isAlive(f); }),
    faces_.end());
  const std::vector<std::size_t> borders = blockBorders(serial);
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

void UniformDecimation::sweep(std::size_t begin, std::size_t end, Index block, double threshold,
  std::uint16_t stamp, VertexRemoval& removal, RecordWriter& log)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    const Index f = faces_[i];
    // A removal may kill the very face that is being visited.
    for (Index h = 3 * f; h < 3 * f + 3 && mesh_.isAlive(f); ++h)
    {
      if (!visit(h, block, threshold, stamp, removal))
      {
        continue;
      }
      for (int j = 0; j < removal.ringSize(); ++j)
      {
        std::uint16_t& lock = lock_[removal.ringVertex(j)];
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
