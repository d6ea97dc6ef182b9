// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/OrderedDecimation.h"

#include "Base/TryCount.h"
#include "Hierarchy/LazyHeap.h"
#include "Hierarchy/StarRemoval.h"

#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <utility>

namespace quadrille
{

namespace
{

/// Draws in a row without a vertex to remove after which the heap takes over.
constexpr int kEmptyDraws = 200;
/// Passes over all vertices, at most. Each begins with what the valences round it forbade before.
constexpr int kMostPasses = 40;
constexpr std::size_t kPollEvery = 1024;

/// What both orders share: costs, and the removal of a vertex.
class OrderedDecimation
{
public:
  OrderedDecimation(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
    : mesh_(mesh), options_(options), log_(log), kept_(mesh.position.size(), 0)
  {
    guards_.curveTolerance = options.curveTolerance;
    for (Index v = 0; v < static_cast<Index>(mesh.position.size()); ++v)
    {
      alive_ += mesh.outgoing[v] != kInvalidIndex ? 1 : 0;
    }
    began_ = alive_;
    for (const Index v : options.keepVertices)
    {
      kept_[v] = 1;
    }
  }

  void byHeap();
  void byDraws(const RandomDraws& draws);

private:
  static constexpr float kNeverCost = std::numeric_limits<float>::infinity();

  using Entry = LazyHeapEntry;

  std::size_t heapPass();
  void drawUntilEmpty(const RandomDraws& draws, StarRemoval& star, RecordWriter& records);
  float costOf(Index v, StarRemoval& star) const;
  bool remove(Index v, StarRemoval& star, RecordWriter& records);
  void tick();

  DecimationMesh& mesh_;
  const UniformOptions& options_;
  LogBuilder& log_;
  RemovalGuards guards_;
  std::vector<char> kept_;
  std::vector<Index> ring_; ///< of the vertex that was removed last
  std::size_t alive_ = 0;
  std::size_t began_ = 0;
  std::size_t ticks_ = 0;
};

/// E_uni, or kNeverCost for a vertex that has to stay or whose edges are long enough.
float OrderedDecimation::costOf(Index v, StarRemoval& star) const
{
  if (kept_[v] != 0 || !star.gather(v))
  {
    return kNeverCost;
  }
  const double limit =
    options_.edgeLength * (options_.scale.empty() ? 1.0 : double{ options_.scale[v] });
  const double shortest = star.shortestEdge(limit);
  return shortest < limit ? static_cast<float>(shortest) : kNeverCost;
}

bool OrderedDecimation::remove(Index v, StarRemoval& star, RecordWriter& records)
{
  if (costOf(v, star) == kNeverCost || star.plan() != StarRemoval::Outcome::Planned)
  {
    return false;
  }
  ring_.clear();
  for (int i = 0; i < star.ringSize(); ++i)
  {
    ring_.push_back(star.ringVertex(i));
  }
  star.apply(records);
  --alive_;
  return true;
}

void OrderedDecimation::tick()
{
  if (++ticks_ % kPollEvery == 0)
  {
    report(options_.progress, 1 - static_cast<double>(alive_) / static_cast<double>(began_),
      "uniform decimation");
  }
}

void OrderedDecimation::byHeap()
{
  for (const bool folds : { false, true })
  {
    guards_.allowOldFolds = folds; // as the sweeps end
    const std::size_t before = alive_;
    countTry(Try::OldFolds, folds ? 1 : 0);
    for (int i = 0; i < kMostPasses && heapPass() * 500 >= alive_; ++i)
    {
    }
    countTryLed(Try::OldFolds, folds && alive_ < before ? 1 : 0);
  }
}

/// Until no vertex is left that may go. Returns how many went.
std::size_t OrderedDecimation::heapPass()
{
  StarRemoval star(mesh_, guards_);
  RecordWriter records;
  std::vector<Index> version(mesh_.position.size(), 0);
  std::vector<Entry> entries;
  for (Index v = 0; v < static_cast<Index>(mesh_.position.size()); ++v)
  {
    const float cost = mesh_.outgoing[v] == kInvalidIndex ? kNeverCost : costOf(v, star);
    if (cost != kNeverCost)
    {
      entries.push_back({ cost, v, 0 });
    }
  }
  std::priority_queue<Entry> heap(std::less<Entry>(), std::move(entries));
  while (!heap.empty())
  {
    tick();
    const Entry entry = heap.top();
    heap.pop();
    if (entry.version != version[entry.vertex] || !remove(entry.vertex, star, records))
    {
      continue;
    }
    ++version[entry.vertex];
    for (const Index w : ring_)
    {
      ++version[w];
      const float cost = costOf(w, star);
      if (cost != kNeverCost)
      {
        heap.push({ cost, w, version[w] });
      }
    }
  }
  return log_.addRound(records);
}

void OrderedDecimation::byDraws(const RandomDraws& draws)
{
  StarRemoval star(mesh_, guards_);
  RecordWriter records;
  drawUntilEmpty(draws, star, records);
  log_.addRound(records);
  byHeap();
}

void OrderedDecimation::drawUntilEmpty(
  const RandomDraws& draws, StarRemoval& star, RecordWriter& records)
{
  std::vector<Index> alive;
  for (Index v = 0; v < static_cast<Index>(mesh_.position.size()); ++v)
  {
    if (mesh_.outgoing[v] != kInvalidIndex)
    {
      alive.push_back(v);
    }
  }
  // Costs are computed when a vertex is drawn, and again after its star has changed.
  constexpr float unknown = -1;
  std::vector<float> cost(mesh_.position.size(), unknown);
  std::mt19937_64 random(draws.seed);
  for (int empty = 0; alive.size() >= draws.exactBelow && !alive.empty() && empty < kEmptyDraws;)
  {
    tick();
    std::size_t best = 0;
    float least = kNeverCost;
    for (int i = 0; i < draws.candidates; ++i)
    {
      const std::size_t at = random() % alive.size();
      float& own = cost[alive[at]];
      own = own == unknown ? costOf(alive[at], star) : own;
      if (own < least)
      {
        least = own;
        best = at;
      }
    }
    ++empty;
    if (least == kNeverCost)
    {
      continue;
    }
    const Index v = alive[best];
    if (!remove(v, star, records))
    {
      cost[v] = kNeverCost; // until its star changes
      continue;
    }
    empty = 0;
    alive[best] = alive.back();
    alive.pop_back();
    for (const Index w : ring_)
    {
      cost[w] = unknown;
    }
  }
}

} // namespace

void decimateByHeap(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log)
{
  OrderedDecimation(mesh, options, log).byHeap();
}

void decimateByDraws(
  DecimationMesh& mesh, const UniformOptions& options, const RandomDraws& draws, LogBuilder& log)
{
  OrderedDecimation(mesh, options, log).byDraws(draws);
}

} // namespace quadrille
