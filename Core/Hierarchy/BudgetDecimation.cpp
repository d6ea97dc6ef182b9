// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/BudgetDecimation.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/TryCount.h"
#include "Hierarchy/ComparedCosts.h"
#include "Hierarchy/ComponentShares.h"
#include "Hierarchy/GaussianCurvatureCost.h"
#include "Hierarchy/VertexRemoval.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <optional>
#include <queue>

namespace quadrille
{

namespace
{

/// Weights of what is added to the curvature cost (radians). A star of average size costs as much as a change of
/// curvature of kAreaWeight.
constexpr double kAreaWeight = 0.15;
constexpr double kShapeWeight = 0.4;
constexpr double kValenceWeight = 0.05;

/// Costs in radians up to which the stages of guards are gone through before the next ceiling. The strictest guards
/// alone would first take what costs most among the vertices that they allow.
constexpr std::array<double, 5> kCeilings{ 0.25, 0.5, 1, 2, kInfinity };
/// Where no budget is given: coarse vertices for each quad, about, by which costs are scaled before it is known.
constexpr double kVerticesPerQuad = 0.4;

/// Positions in a value of the cache, see BudgetDecimation::writeValue().
enum ValuePosition : std::size_t
{
  kCurvatureAt = 1,
  kAreaAt,
  kBadAt,
  kPlanAt
};

std::uint32_t wordOf(double number)
{
  const float rounded = static_cast<float>(number);
  std::uint32_t word = 0;
  std::memcpy(&word, &rounded, sizeof(word));
  return word;
}
float numberOf(std::uint32_t word)
{
  float number = 0;
  std::memcpy(&number, &word, sizeof(number));
  return number;
}

/// Removals are first confined to the strictest guards; the next ones are taken when the budget needs it.
std::vector<RemovalGuards> guardStages(double curveTolerance)
{
  RemovalGuards strict;
  strict.minimumQuality = 0.4;
  strict.minimumNormalDot = 0.5;
  strict.minimumValence = 5;
  strict.maximumValence = 8;
  strict.curveTolerance = curveTolerance;
  RemovalGuards medium = strict;
  medium.minimumQuality = 0.3;
  medium.minimumNormalDot = 0.35;
  medium.minimumValence = 4;
  medium.maximumValence = 10;
  RemovalGuards loose = medium;
  loose.minimumQuality = 0.2;
  loose.maximumValence = 12;
  return { strict, medium, loose };
}

class BudgetDecimation
{
public:
  BudgetDecimation(DecimationMesh& mesh, const BudgetOptions& options, StarCache& cache)
    : mesh_(mesh), options_(options), cache_(cache), shares_(mesh), kept_(mesh.position.size(), 0),
      version_(mesh.position.size(), 0)
  {
    for (const Index v : options.keepVertices)
    {
      kept_[v] = 1;
    }
    prepareCost();
    budget_ = std::max(isAutomatic() ? kLeastCoarseVertices : options.vertices, shares_.needed());
    expected_ = isAutomatic() ? expectedVertices() : budget_;
  }

  BudgetResult run();

private:
  /// Of the heap: the cheapest comes first, of two equally cheap vertices the lower id. Outdated entries stay in it and
  /// are skipped.
  struct Entry
  {
    float cost = 0;
    Index vertex = 0;
    Index version = 0; ///< outdated when the vertex has a later one
    bool operator<(const Entry& other) const
    {
      return cost != other.cost ? cost > other.cost : vertex > other.vertex;
    }
  };
  using Heap = std::priority_queue<Entry>;
  struct Stage
  {
    RemovalGuards guards;
    std::uint32_t number = 0;
    double ceiling = 0; ///< of the costs
  };
  /// What one thread works with.
  struct Work
  {
    explicit Work(DecimationMesh& mesh) : removal(mesh) {}
    VertexRemoval removal;
    VertexRemoval::Change change;
    StarCache::Words key;
    StarCache::Words value;
    const std::uint32_t* planned = nullptr; ///< value of the removal that was planned last
    StarCache::Batch fresh;
    std::size_t lookups = 0;
    std::size_t hits = 0;
  };

  bool isAutomatic() const { return options_.vertices == 0; }
  Index expectedVertices() const;
  void prepareCost();
  void runStage(const Stage& stage, RecordWriter& records);
  std::vector<Entry> evaluateAll(const Stage& stage);
  std::optional<float> evaluate(Index v, const Stage& stage, Work& work) const;
  bool plan(const Stage& stage, Work& work) const;
  void writeValue(bool possible, Work& work) const;
  float cost(Index v, double shortestEdge, const Work& work) const;
  double curvatureCost(Index v, const Work& work) const;
  double shapeCost(const Work& work) const;
  double densityOf(Index f) const;
  double movedBy(const Work& work) const;
  bool movesTooMuch(const Work& work) const;
  void remember(const Work& work);
  void fillCache(Work& work);
  /// Whether the cost is E_G or E_G,mem.
  bool wantsChange() const { return !compared_; }
  std::string notice() const;

  DecimationMesh& mesh_;
  const BudgetOptions& options_;
  StarCache& cache_;
  ComponentShares shares_;
  std::vector<char> kept_;
  std::vector<Index> version_;
  std::vector<float> defect_;            ///< current angle defects, for GaussianMemory
  std::optional<ComparedCost> compared_; ///< where E_G is not what orders the removals
  Index budget_ = 0;
  Index expected_ = 0; ///< vertices in the end, for the scale of costs
  Index alive_ = 0;
  double area_ = 0;
  double curvature_ = 0; ///< sum of |angle defects| at the start, where costs know it
  double moved_ = 0;     ///< curvature times distance, see movedBy()
  CacheReport report_;
};

void BudgetDecimation::prepareCost()
{
  alive_ = shares_.total();
  if (options_.cost == DecimationCost::Quadric || options_.cost == DecimationCost::Uniform)
  {
    compared_.emplace(mesh_, options_.cost);
  }
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    if (!mesh_.isAlive(f))
    {
      continue;
    }
    const Vector3& p = mesh_.position[mesh_.origin[3 * f]];
    const Vector3 n = (mesh_.position[mesh_.origin[3 * f + 1]] - p)
                        .cross(mesh_.position[mesh_.origin[3 * f + 2]] - p);
    area_ += 0.5 * n.norm() * densityOf(f);
  }
  if (wantsChange())
  {
    defect_ = angleDefects(mesh_);
  }
  for (const float defect : defect_)
  {
    curvature_ += std::abs(double{ defect });
  }
  curvature_ = std::max(curvature_, 2 * kPi);
}

Index BudgetDecimation::expectedVertices() const
{
  const double quads = area_ / (options_.edgeLength * options_.edgeLength);
  return std::max(budget_,
    static_cast<Index>(std::clamp(
      kVerticesPerQuad * quads, double{ kLeastCoarseVertices }, double{ kMostCoarseVertices })));
}

/// Mean of 1 / size^2 at the corners of a face.
double BudgetDecimation::densityOf(Index f) const
{
  double sum = 0;
  for (Index h = 3 * f; h < 3 * f + 3 && !mesh_.sizing.empty(); ++h)
  {
    const double size = mesh_.sizeOf(mesh_.origin[h]);
    sum += 1 / (3 * size * size);
  }
  return mesh_.sizing.empty() ? 1 : sum;
}

/// The curvature that the removal moves, half of E_G since it leaves one place and arrives at another, times about the
/// length of the edges along which it goes.
double BudgetDecimation::movedBy(const Work& work) const
{
  // Six equilateral triangles.
  const double edge =
    std::sqrt(double{ numberOf(work.planned[kAreaAt]) } * 2 / (3 * std::sqrt(3.0)));
  return 0.5 * double{ numberOf(work.planned[kCurvatureAt]) } * edge;
}

/// Whether an automatic budget ends before the removal.
bool BudgetDecimation::movesTooMuch(const Work& work) const
{
  return isAutomatic() && alive_ <= kMostCoarseVertices &&
    moved_ + movedBy(work) > kCurvatureShift * options_.edgeLength * curvature_;
}

BudgetResult BudgetDecimation::run()
{
  BudgetResult result;
  for (const double ceiling : kCeilings)
  {
    Stage stage;
    stage.ceiling = wantsChange() ? ceiling : kCeilings.back();
    for (const RemovalGuards& guards : guardStages(options_.curveTolerance))
    {
      stage.guards = guards;
      if (alive_ > budget_)
      {
        const bool isLooser = stage.number > 0;
        const Index before = alive_;
        countTry(Try::LooserGuards, isLooser ? 1 : 0);
        runStage(stage, result.records);
        countTryLed(Try::LooserGuards, isLooser && alive_ < before ? 1 : 0);
      }
      ++stage.number;
    }
  }
  result.notice = notice();
  report_.bytes = cache_.bytes();
  result.cache = report_;
  result.curvatureShift = moved_ / curvature_;
  return result;
}

std::string BudgetDecimation::notice() const
{
  const Index most = isAutomatic() ? kMostCoarseVertices : options_.vertices;
  if (alive_ <= most)
  {
    return {};
  }
  const bool topology = shares_.needed() > most;
  return "The coarse level keeps " + std::to_string(alive_) + " vertices instead of " +
    (isAutomatic() ? "at most " : "") + std::to_string(most) +
    (topology ? ": its components, handles and boundary loops need them."
              : ": features and curved parts need them.");
}

void BudgetDecimation::runStage(const Stage& stage, RecordWriter& records)
{
  Heap heap(std::less<Entry>(), evaluateAll(stage));
  Work work(mesh_);
  VertexRemoval& removal = work.removal;
  const Index begin = alive_;
  std::vector<Index> ring;
  std::size_t visits = 0;
  while (alive_ > budget_ && !heap.empty() && double{ heap.top().cost } <= stage.ceiling)
  {
    if (++visits % kHeavyChunk == 0)
    {
      poll();
    }
    const Entry entry = heap.top();
    heap.pop();
    if (entry.version != version_[entry.vertex] || !shares_.maySpare(entry.vertex) ||
      !removal.gather(entry.vertex) || !removal.surroundingsFit(stage.guards) ||
      !plan(stage, work) || !removal.valencesFit(stage.guards))
    {
      fillCache(work);
      continue;
    }
    ring.clear();
    for (int i = 0; i < removal.ringSize(); ++i)
    {
      ring.push_back(removal.ringVertex(i));
    }
    if (movesTooMuch(work))
    {
      fillCache(work);
      budget_ = alive_;
      return;
    }
    moved_ += wantsChange() ? movedBy(work) : 0;
    remember(work);
    fillCache(work);
    removal.apply(records);
    shares_.remove(entry.vertex);
    ++version_[entry.vertex];
    --alive_;
    for (const Index w : ring)
    {
      ++version_[w];
      if (const std::optional<float> cost = evaluate(w, stage, work))
      {
        heap.push({ *cost, w, version_[w] });
      }
      fillCache(work);
    }
    if (alive_ % 1024 == 0)
    {
      report(options_.progress, double(begin - alive_) / double(begin - budget_),
        "curvature decimation");
    }
  }
}

std::vector<BudgetDecimation::Entry> BudgetDecimation::evaluateAll(const Stage& stage)
{
  const std::vector<Index> alive =
    idsWhere(mesh_.position.size(), [&](Index v) { return mesh_.outgoing[v] != kInvalidIndex; });
  std::vector<float> cost(alive.size(), -1);
  std::deque<Work> works;
  for (std::size_t begin = 0; begin < alive.size(); begin += kHeavyChunk)
  {
    works.emplace_back(mesh_);
  }
  parallelFor(alive.size(), kHeavyChunk, options_.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        cost[i] = evaluate(alive[i], stage, works[begin / kHeavyChunk]).value_or(-1);
      }
    });
  for (Work& work : works)
  {
    fillCache(work);
  }
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < alive.size(); ++i)
  {
    if (cost[i] >= 0)
    {
      entries.push_back({ cost[i], alive[i], version_[alive[i]] });
    }
  }
  return entries;
}

/// Puts what a thread found out into the cache.
void BudgetDecimation::fillCache(Work& work)
{
  cache_.add(work.fresh);
  work.fresh.clear();
  report_.lookups += work.lookups;
  report_.hits += work.hits;
  work.lookups = 0;
  work.hits = 0;
}

std::optional<float> BudgetDecimation::evaluate(Index v, const Stage& stage, Work& work) const
{
  VertexRemoval& removal = work.removal;
  if (kept_[v] != 0 || !removal.gather(v) || !removal.surroundingsFit(stage.guards))
  {
    return std::nullopt;
  }
  const double shortest = removal.shortestEdge();
  if (!plan(stage, work) || !removal.valencesFit(stage.guards))
  {
    return std::nullopt;
  }
  return cost(v, shortest, work);
}

/// Plans the removal of the vertex that was gathered, from the cache where it has it.
bool BudgetDecimation::plan(const Stage& stage, Work& work) const
{
  VertexRemoval& removal = work.removal;
  work.key.assign(1, stage.number);
  removal.addStarKey(work.key, options_.names);
  ++work.lookups;
  work.planned = cache_.find(work.key);
  if (work.planned != nullptr && (*work.planned == 0 || removal.loadPlan(work.planned + kPlanAt)))
  {
    ++work.hits;
    return *work.planned != 0;
  }
  const bool known = work.planned != nullptr;
  const bool possible = removal.planStar(stage.guards);
  writeValue(possible, work);
  work.planned = work.value.data();
  if (!known && removal.dependsOnStarOnly())
  {
    work.fresh.add(work.key, work.value);
  }
  return possible;
}

/// The value that the cache gets: whether the removal is possible; own curvature cost, area and shape; the plan;
/// changes of the ring's defects, for GaussianMemory.
void BudgetDecimation::writeValue(bool possible, Work& work) const
{
  work.value.assign(1, possible ? 1U : 0U);
  if (!possible)
  {
    return;
  }
  work.value.resize(kPlanAt, 0U);
  work.removal.savePlan(work.value);
  if (!wantsChange())
  {
    return;
  }
  work.removal.measureChange(work.change);
  for (int i = 0; i < work.removal.ringSize(); ++i)
  {
    const std::array<double, 2>& change = work.change.defect[static_cast<std::size_t>(i)];
    if (options_.cost == DecimationCost::GaussianMemory)
    {
      work.value.push_back(wordOf(change[0] + change[1]));
    }
  }
  const double bad = 1 - work.change.worstQuality;
  work.value[kCurvatureAt] = wordOf(gaussianCurvatureCost(work.change, work.removal.ringSize()));
  work.value[kAreaAt] = wordOf(work.change.starArea);
  work.value[kBadAt] = wordOf(bad * bad * bad);
}

float BudgetDecimation::cost(Index v, double shortestEdge, const Work& work) const
{
  return static_cast<float>(compared_ ? compared_->of(work.removal, shortestEdge)
                                      : curvatureCost(v, work) + shapeCost(work));
}

double BudgetDecimation::curvatureCost(Index v, const Work& work) const
{
  if (options_.cost == DecimationCost::Gaussian)
  {
    return numberOf(work.planned[kCurvatureAt]);
  }
  const std::uint32_t* change = work.planned + kPlanAt + work.removal.planWords();
  double cost = std::abs(double{ options_.inputDefect[v] });
  for (int i = 0; i < work.removal.ringSize(); ++i)
  {
    const Index w = work.removal.ringVertex(i);
    cost +=
      std::abs(double{ defect_[w] } + numberOf(change[i]) - double{ options_.inputDefect[w] });
  }
  return cost;
}

double BudgetDecimation::shapeCost(const Work& work) const
{
  const VertexRemoval& removal = work.removal;
  const double averageStar = 3 * area_ / expected_;
  double odd = 0;
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    if (mesh_.curves.kind[removal.ringVertex(i)] == VertexKind::Free)
    {
      const int valence = removal.newValence(i);
      odd += valence < 5 ? 5 - valence : std::max(0, valence - 7);
    }
  }
  const double size = mesh_.sizeOf(removal.vertex());
  const double sizeChange = mesh_.sizing.empty() ? 0 : removal.sizeChange();
  // In the metric of the sizes a bump of the height of their logarithm on a regular star has this curvature, so it
  // costs what E_G makes other curvature cost.
  const double sixCotangentsOf60Degrees = 2 * std::sqrt(3.0);
  return kAreaWeight * numberOf(work.planned[kAreaAt]) / (size * size) / averageStar +
    kShapeWeight * numberOf(work.planned[kBadAt]) + kValenceWeight * odd +
    sixCotangentsOf60Degrees * sizeChange;
}

void BudgetDecimation::remember(const Work& work)
{
  const VertexRemoval& removal = work.removal;
  if (options_.cost == DecimationCost::GaussianMemory)
  {
    const std::uint32_t* change = work.planned + kPlanAt + removal.planWords();
    for (int i = 0; i < removal.ringSize(); ++i)
    {
      defect_[removal.ringVertex(i)] += numberOf(change[i]);
    }
  }
  if (compared_)
  {
    compared_->remove(removal);
  }
}

} // namespace

BudgetResult decimateToBudget(DecimationMesh& mesh, const BudgetOptions& options, StarCache& cache)
{
  return BudgetDecimation(mesh, options, cache).run();
}

} // namespace quadrille
