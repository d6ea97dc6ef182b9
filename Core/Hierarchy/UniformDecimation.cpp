// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/UniformDecimation.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Hierarchy/StarRemoval.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

namespace quadrille
{

namespace
{

/// Blocks of a round where the mesh has enough vertices for them: work for many threads.
constexpr std::size_t kBlocks = 16;
/// Live vertices of a block: large against its border, small enough for the cache.
constexpr std::size_t kLeastBlock = 4096;
constexpr std::size_t kLargestBlock = 32768;
constexpr double kThresholdStep = 1.5;
/// Sweeps inside one round. The second one takes what the first one locked while the block is in the cache.
constexpr int kSweepsPerRound = 2;
/// A rough end is one where a round removes less than this part of the vertices.
constexpr std::size_t kRoughPart = 16;
/// How many visits ahead the memory is asked for a star, and twice that for its vertex.
constexpr std::size_t kAhead = 6;
/// Lock of a vertex that must stay.
constexpr std::uint16_t kKept = 0xFFFF;

/// Consecutive live vertices, that one thread sweeps.
struct Block
{
  std::size_t begin = 0; ///< positions in the list of live vertices
  std::size_t end = 0;
  Index first = 0; ///< vertex ids
  Index last = 0;  ///< one past

  bool owns(Index v) const { return v >= first && v < last; }
};

class UniformDecimation
{
public:
  UniformDecimation(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
    : mesh_(mesh), options_(options), log_(log), state_(mesh.position.size())
  {
    guards_.curveTolerance = options.curveTolerance;
    alive_ = options.candidates;
    for (Index v = 0; v < static_cast<Index>(mesh.position.size()) && !isLocal(); ++v)
    {
      pollNowAndThen(v);
      if (mesh.outgoing[v] != kInvalidIndex)
      {
        alive_.push_back(v);
      }
    }
    for (const Index v : options.keepVertices)
    {
      state_[v].lock = kKept;
    }
  }

  void run();

private:
  struct VertexState
  {
    float idleBelow = 0;    ///< no use in a visit before the threshold is above this
    std::uint16_t lock = 0; ///< number of the last sweep that changed the vertex's star
  };
  /// What one thread needs to sweep a block; passed on from one block to the next, with its memory.
  struct Worker
  {
    Worker(DecimationMesh& mesh, const RemovalGuards& guards) : star(mesh, guards) {}
    StarRemoval star;
    RecordWriter log;
    double threshold = 0;
    std::uint16_t stamp = 0;
  };

  std::unique_ptr<Worker> takeWorker();
  void giveBack(std::unique_ptr<Worker> worker);
  LogBuilder::Block sweepBlock(Block& block, double threshold, int firstStamp);
  bool isLocal() const { return !options_.candidates.empty(); }
  double firstThreshold() const;
  double shortestEdge() const;
  double largestScale() const;
  void finish(double threshold);
  void finishRoughly(double threshold);
  void forget();
  std::size_t round(double threshold, bool serial);
  std::vector<Block> makeBlocks(bool serial);
  void sweep(Block& block, Worker& worker);
  void fetchAhead(std::size_t i, std::size_t end) const;
  bool visit(Index v, const Block& block, Worker& worker);
  bool isDue(Index v, double shortest, double threshold);
  void apply(StarRemoval& star, Worker& worker);

  DecimationMesh& mesh_;
  const UniformOptions& options_;
  LogBuilder& log_;
  RemovalGuards guards_;
  std::vector<VertexState> state_;
  std::vector<Index> alive_;
  std::uint16_t sweeps_ = 0;
  bool shifted_ = false;
  std::vector<std::unique_ptr<Worker>> idle_;
  std::mutex idleMutex_;
};

void UniformDecimation::run()
{
  const double last = options_.edgeLength * largestScale();
  double threshold = std::min(firstThreshold(), last);
  const double steps =
    std::max(1.0, std::ceil(std::log(last / threshold) / std::log(kThresholdStep)));
  int done = 0;
  for (; threshold < last; threshold *= kThresholdStep)
  {
    report(options_.progress, ++done / (steps + 2), "uniform decimation");
    round(threshold, isLocal());
  }
  report(options_.progress, (steps + 1) / (steps + 2), "uniform decimation");
  if (options_.isRough)
  {
    finishRoughly(last);
    return;
  }
  finish(last);
  if (options_.isExact)
  {
    return;
  }
  // Noise of scans folds the surface; a star that is folded itself may be replaced by one that is no worse.
  guards_.allowOldFolds = true;
  idle_.clear(); // they have copies of the guards
  const std::size_t before = alive_.size();
  countTry(Try::OldFolds);
  finish(last);
  countTryLed(Try::OldFolds, alive_.size() < before ? 1 : 0);
}

/// Parallel rounds while they pay, then serial ones, which also reach what sits at the borders of the blocks.
void UniformDecimation::finish(double threshold)
{
  forget();
  bool serial = isLocal();
  for (;;)
  {
    poll();
    const std::size_t removed = round(threshold, serial);
    if (serial && (removed == 0 || removed * 500 < alive_.size()))
    {
      break;
    }
    if (!serial && (removed == 0 || removed * 100 < alive_.size()))
    {
      serial = true;
      forget(); // once more what the valences forbade; they have changed since
    }
  }
}

/// The first of these rounds, which are as parallel as those before, remove nearly all that goes at last.
void UniformDecimation::finishRoughly(double threshold)
{
  std::size_t removed = alive_.size();
  while (removed > 0 && removed * kRoughPart >= alive_.size())
  {
    poll();
    removed = round(threshold, isLocal());
  }
}

/// Every vertex is worth a visit again.
void UniformDecimation::forget()
{
  for (const Index v : alive_)
  {
    state_[v].idleBelow = 0;
  }
}

/// Of those at candidates.
double UniformDecimation::shortestEdge() const
{
  double shortest = kInfinity;
  for (Index h = 0; h < 3 * mesh_.faceCount(); ++h)
  {
    const Index a = mesh_.origin[h], b = mesh_.target(h);
    if (std::binary_search(alive_.begin(), alive_.end(), a) &&
      std::binary_search(alive_.begin(), alive_.end(), b))
    {
      shortest = std::min(shortest, (mesh_.position[b] - mesh_.position[a]).norm());
    }
  }
  return shortest;
}

double UniformDecimation::firstThreshold() const
{
  const double least = 1e-6 * options_.edgeLength;
  if (isLocal())
  {
    return std::max(shortestEdge() * kThresholdStep, least);
  }
  double sum = 0;
  std::size_t count = 0;
  for (Index h = 0; h < 3 * mesh_.faceCount(); h += 7)
  {
    sum += (mesh_.position[mesh_.target(h)] - mesh_.position[mesh_.origin[h]]).norm();
    ++count;
  }
  return std::max(sum / static_cast<double>(std::max<std::size_t>(count, 1)), least);
}

/// At least 1, so that components that are all small change no threshold.
double UniformDecimation::largestScale() const
{
  const auto largest = std::max_element(options_.scale.begin(), options_.scale.end());
  return largest == options_.scale.end() ? 1.0 : std::max(1.0, double{ *largest });
}

std::vector<Block> UniformDecimation::makeBlocks(bool serial)
{
  std::vector<std::size_t> borders{ 0 };
  if (!serial)
  {
    const std::size_t size = std::clamp(alive_.size() / kBlocks, kLeastBlock, kLargestBlock);
    for (std::size_t border = shifted_ ? size / 2 : size; border < alive_.size(); border += size)
    {
      borders.push_back(border);
    }
    shifted_ = !shifted_;
  }
  borders.push_back(alive_.size());
  std::vector<Block> blocks;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i)
  {
    const Index first = i == 0 ? 0 : alive_[borders[i]];
    const Index last = borders[i + 1] < alive_.size() ? alive_[borders[i + 1]] : kInvalidIndex;
    blocks.push_back({ borders[i], borders[i + 1], first, last });
  }
  return blocks;
}

std::size_t UniformDecimation::round(double threshold, bool serial)
{
  std::vector<Block> blocks = makeBlocks(serial);
  std::vector<LogBuilder::Block> logs(blocks.size());
  const int firstStamp = sweeps_ + 1;
  sweeps_ = static_cast<std::uint16_t>(sweeps_ + kSweepsPerRound);
  parallelFor(blocks.size(), 1, options_.threads,
    [&](std::size_t i, std::size_t) { logs[i] = sweepBlock(blocks[i], threshold, firstStamp); });
  std::size_t count = 0;
  for (const Block& block : blocks)
  {
    const auto begin = alive_.begin() + static_cast<std::ptrdiff_t>(block.begin);
    const auto end = alive_.begin() + static_cast<std::ptrdiff_t>(block.end);
    std::move(begin, end, alive_.begin() + static_cast<std::ptrdiff_t>(count));
    count += block.end - block.begin;
  }
  alive_.resize(count);
  return log_.addRound(std::move(logs));
}

std::unique_ptr<UniformDecimation::Worker> UniformDecimation::takeWorker()
{
  const std::lock_guard<std::mutex> lock(idleMutex_);
  if (idle_.empty())
  {
    return std::make_unique<Worker>(mesh_, guards_);
  }
  std::unique_ptr<Worker> worker = std::move(idle_.back());
  idle_.pop_back();
  return worker;
}

void UniformDecimation::giveBack(std::unique_ptr<Worker> worker)
{
  const std::lock_guard<std::mutex> lock(idleMutex_);
  idle_.push_back(std::move(worker));
}

LogBuilder::Block UniformDecimation::sweepBlock(Block& block, double threshold, int firstStamp)
{
  std::unique_ptr<Worker> worker = takeWorker();
  worker->threshold = threshold;
  worker->log.clear();
  for (int k = 0; k < kSweepsPerRound; ++k)
  {
    worker->stamp = static_cast<std::uint16_t>(firstStamp + k);
    sweep(block, *worker);
  }
  // The worker's buffer is warm in the cache; what stays is written once, into memory of its size.
  LogBuilder::Block result(worker->log);
  giveBack(std::move(worker));
  return result;
}

/// Visits the vertices of the block; those that stay move up in its part of the list.
void UniformDecimation::sweep(Block& block, Worker& worker)
{
  std::size_t kept = block.begin;
  for (std::size_t i = block.begin; i < block.end; ++i)
  {
    const Index v = alive_[i];
    alive_[kept] = v;
    fetchAhead(i, block.end);
    kept += visit(v, block, worker) ? 0 : 1;
  }
  block.end = kept;
}

/// Asks for what the visits that come next will read.
void UniformDecimation::fetchAhead(std::size_t i, std::size_t end) const
{
#if defined(__GNUC__)
  if (i + 2 * kAhead < end)
  {
    const Index far = alive_[i + 2 * kAhead];
    __builtin_prefetch(&mesh_.outgoing[far]);
    __builtin_prefetch(&mesh_.position[far]);
    __builtin_prefetch(&state_[far]);
    const Index h = mesh_.outgoing[alive_[i + kAhead]];
    __builtin_prefetch(&mesh_.origin[h]);
    __builtin_prefetch(&mesh_.twin[h]);
  }
#endif
}

bool UniformDecimation::visit(Index v, const Block& block, Worker& worker)
{
  const VertexState& state = state_[v];
  StarRemoval& star = worker.star;
  if (state.lock == worker.stamp || state.lock == kKept ||
    !(worker.threshold > double{ state.idleBelow }) || !star.gather(v))
  {
    return false;
  }
  for (int i = 0; i < star.ringSize(); ++i)
  {
    if (!block.owns(star.ringVertex(i)))
    {
      return false;
    }
  }
  if (!isDue(v, star.shortestEdge(worker.threshold), worker.threshold))
  {
    return false;
  }
  const StarRemoval::Outcome outcome = star.plan();
  if (outcome == StarRemoval::Outcome::Refused)
  {
    state_[v].idleBelow = std::numeric_limits<float>::infinity();
  }
  if (outcome != StarRemoval::Outcome::Planned)
  {
    return false;
  }
  apply(star, worker);
  return true;
}

/// Whether the vertex has to go by its shortest edge. If not, remembers until when a visit is of no use.
bool UniformDecimation::isDue(Index v, double shortest, double threshold)
{
  const double limit =
    options_.edgeLength * (options_.scale.empty() ? 1.0 : double{ options_.scale[v] });
  if (shortest < std::min(threshold, limit))
  {
    return true;
  }
  state_[v].idleBelow =
    shortest < limit ? static_cast<float>(shortest) : std::numeric_limits<float>::infinity();
  return false;
}

void UniformDecimation::apply(StarRemoval& star, Worker& worker)
{
  for (int i = 0; i < star.ringSize(); ++i)
  {
    VertexState& state = state_[star.ringVertex(i)];
    state.idleBelow = 0;
    state.lock = state.lock == kKept ? kKept : worker.stamp;
  }
  star.apply(worker.log);
}

} // namespace

void decimateUniformly(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
{
  UniformDecimation(mesh, options, log).run();
}

} // namespace quadrille
