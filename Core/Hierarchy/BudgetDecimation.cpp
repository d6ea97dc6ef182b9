// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/BudgetDecimation.h"

#include "Base/Parallel.h"
#include "Hierarchy/VertexRemoval.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>

namespace quadrille
{

namespace
{

constexpr double kPi = 3.14159265358979323846;

/// Weights of what is added to the curvature cost (radians). A star of average size costs as much as a change of
/// curvature of kAreaWeight.
constexpr double kAreaWeight = 0.15;
constexpr double kShapeWeight = 0.4;
constexpr double kValenceWeight = 0.05;

/// Vertices that a component keeps for its topology.
constexpr Index kVerticesPerComponent = 12;
constexpr Index kVerticesPerHandleOrLoop = 8;

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

struct Quadric
{
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector3 b = Vector3::Zero();
  double c = 0;

  void addPlane(const Vector3& normal, double offset, double weight)
  {
    a += weight * normal * normal.transpose();
    b += weight * offset * normal;
    c += weight * offset * offset;
  }
  void add(const Quadric& other)
  {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  double at(const Vector3& p) const { return p.dot(a * p) + 2 * b.dot(p) + c; }
};

/// Connected components of what is alive, and how many vertices each has to keep.
class ComponentShares
{
public:
  explicit ComponentShares(const DecimationMesh& mesh)
    : component_(mesh.position.size(), kInvalidIndex)
  {
    std::vector<long> euler;
    std::vector<Index> stack;
    for (Index seed = 0; seed < component_.size(); ++seed)
    {
      if (mesh.outgoing[seed] == kInvalidIndex || component_[seed] != kInvalidIndex)
      {
        continue;
      }
      const Index id = static_cast<Index>(count_.size());
      count_.push_back(0);
      euler.push_back(0);
      component_[seed] = id;
      stack.assign(1, seed);
      while (!stack.empty())
      {
        const Index v = stack.back();
        stack.pop_back();
        ++count_[id];
        ++euler[id];
        visitNeighbours(mesh, v,
          [&](Index w)
          {
            if (component_[w] == kInvalidIndex)
            {
              component_[w] = id;
              stack.push_back(w);
            }
          });
      }
    }
    countEdgesAndFaces(mesh, euler);
    for (std::size_t id = 0; id < count_.size(); ++id)
    {
      const long handles = std::max(0L, 2 - euler[id]);
      keep_.push_back(std::min(count_[id],
        kVerticesPerComponent + kVerticesPerHandleOrLoop * static_cast<Index>(handles)));
    }
  }

  Index needed() const { return std::accumulate(keep_.begin(), keep_.end(), Index{ 0 }); }
  std::size_t components() const { return count_.size(); }
  bool maySpare(Index v) const { return count_[component_[v]] > keep_[component_[v]]; }
  void remove(Index v) { --count_[component_[v]]; }
  Index total() const { return std::accumulate(count_.begin(), count_.end(), Index{ 0 }); }

private:
  template <typename Body>
  static void visitNeighbours(const DecimationMesh& mesh, Index v, const Body& body)
  {
    const Index first = mesh.outgoing[v];
    Index h = first;
    do
    {
      body(mesh.target(h));
      body(mesh.origin[Mesh::previous(h)]);
      h = mesh.twin[Mesh::previous(h)];
    } while (h != first && h != kInvalidIndex);
  }
  void countEdgesAndFaces(const DecimationMesh& mesh, std::vector<long>& euler) const
  {
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      if (!mesh.isAlive(f))
      {
        continue;
      }
      long& sum = euler[component_[mesh.origin[3 * f]]];
      ++sum;
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        sum -= mesh.isBoundary(h) || h < mesh.twin[h] ? 1 : 0;
      }
    }
  }
  std::vector<Index> component_;
  std::vector<Index> count_;
  std::vector<Index> keep_;
};

class BudgetDecimation
{
public:
  BudgetDecimation(DecimationMesh& mesh, const BudgetOptions& options, LogBuilder& log)
    : mesh_(mesh), options_(options), log_(log), shares_(mesh), kept_(mesh.position.size(), 0),
      version_(mesh.position.size(), 0)
  {
    for (const Index v : options.keepVertices)
    {
      kept_[v] = 1;
    }
    budget_ = std::max(options.vertices, shares_.needed());
    prepareCost();
  }

  std::string run();

private:
  struct Entry
  {
    double cost = 0;
    Index vertex = 0;
    Index version = 0;
    bool operator<(const Entry& other) const
    {
      return cost != other.cost ? cost > other.cost : vertex > other.vertex;
    }
  };
  using Heap = std::priority_queue<Entry>;

  void prepareCost();
  void runStage(const RemovalGuards& guards, RecordWriter& records);
  std::vector<Entry> evaluateAll(const RemovalGuards& guards) const;
  std::optional<double> evaluate(
    Index v, VertexRemoval& removal, const RemovalGuards& guards) const;
  double curvatureCost(const VertexRemoval& removal, Index v) const;
  double quadricCost(const VertexRemoval& removal, Index v) const;
  double shapeCost(const VertexRemoval& removal) const;
  void remember(const VertexRemoval& removal, Index v);
  std::string notice() const;

  DecimationMesh& mesh_;
  const BudgetOptions& options_;
  LogBuilder& log_;
  ComponentShares shares_;
  std::vector<char> kept_;
  std::vector<Index> version_;
  std::vector<float> defect_;    ///< current angle defects, for GaussianMemory
  std::vector<Quadric> quadric_; ///< for Quadric
  Index budget_ = 0;
  Index alive_ = 0;
  double area_ = 0;
};

void BudgetDecimation::prepareCost()
{
  alive_ = shares_.total();
  if (options_.cost == DecimationCost::Quadric)
  {
    quadric_.resize(mesh_.position.size());
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
    const double doubled = n.norm();
    area_ += 0.5 * doubled;
    for (Index h = 3 * f; h < 3 * f + 3 && !quadric_.empty() && doubled > 0; ++h)
    {
      quadric_[mesh_.origin[h]].addPlane(n / doubled, -n.dot(p) / doubled, 0.5 * doubled);
    }
  }
  if (options_.cost == DecimationCost::GaussianMemory)
  {
    defect_ = angleDefects(mesh_);
  }
}

std::string BudgetDecimation::run()
{
  std::vector<RecordWriter> records(1);
  for (const RemovalGuards& guards : guardStages(options_.curveTolerance))
  {
    if (alive_ > budget_)
    {
      runStage(guards, records[0]);
    }
  }
  log_.addRound(std::move(records));
  return notice();
}

std::string BudgetDecimation::notice() const
{
  if (alive_ <= options_.vertices)
  {
    return {};
  }
  const bool topology = shares_.needed() > options_.vertices;
  return "The coarse level keeps " + std::to_string(alive_) + " vertices instead of " +
    std::to_string(options_.vertices) +
    (topology ? ": its components, handles and boundary loops need them."
              : ": features and curved parts need them.");
}

void BudgetDecimation::runStage(const RemovalGuards& guards, RecordWriter& records)
{
  Heap heap(std::less<Entry>(), evaluateAll(guards));
  VertexRemoval removal(mesh_);
  const Index begin = alive_;
  std::vector<Index> ring;
  while (alive_ > budget_ && !heap.empty())
  {
    const Entry entry = heap.top();
    heap.pop();
    if (entry.version != version_[entry.vertex] || !shares_.maySpare(entry.vertex) ||
      !removal.gather(entry.vertex) || !removal.plan(guards))
    {
      continue;
    }
    ring.clear();
    for (int i = 0; i < removal.ringSize(); ++i)
    {
      ring.push_back(removal.ringVertex(i));
    }
    remember(removal, entry.vertex);
    removal.apply(records);
    shares_.remove(entry.vertex);
    ++version_[entry.vertex];
    --alive_;
    for (const Index w : ring)
    {
      ++version_[w];
      if (const std::optional<double> cost = evaluate(w, removal, guards))
      {
        heap.push({ *cost, w, version_[w] });
      }
    }
    if (alive_ % 1024 == 0)
    {
      report(options_.progress, double(begin - alive_) / double(begin - budget_),
        "curvature decimation");
    }
  }
}

std::vector<BudgetDecimation::Entry> BudgetDecimation::evaluateAll(
  const RemovalGuards& guards) const
{
  std::vector<Index> alive;
  for (Index v = 0; v < mesh_.position.size(); ++v)
  {
    if (mesh_.outgoing[v] != kInvalidIndex)
    {
      alive.push_back(v);
    }
  }
  std::vector<double> cost(alive.size(), -1);
  parallelFor(alive.size(), 1024, options_.threads,
    [&](std::size_t begin, std::size_t end)
    {
      VertexRemoval removal(mesh_);
      for (std::size_t i = begin; i < end; ++i)
      {
        cost[i] = evaluate(alive[i], removal, guards).value_or(-1);
      }
    });
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

std::optional<double> BudgetDecimation::evaluate(
  Index v, VertexRemoval& removal, const RemovalGuards& guards) const
{
  if (kept_[v] != 0 || !removal.gather(v))
  {
    return std::nullopt;
  }
  const double shortest = removal.shortestEdge();
  if (!removal.plan(guards))
  {
    return std::nullopt;
  }
  switch (options_.cost)
  {
    case DecimationCost::Uniform:
      return shortest;
    case DecimationCost::Quadric:
      return quadricCost(removal, v);
    default:
      return curvatureCost(removal, v) + shapeCost(removal);
  }
}

double BudgetDecimation::curvatureCost(const VertexRemoval& removal, Index v) const
{
  const bool memory = options_.cost == DecimationCost::GaussianMemory;
  double cost =
    memory ? std::abs(double{ options_.inputDefect[v] }) : std::abs(removal.ownDefect());
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    const std::array<double, 2> change = removal.defectChange(i);
    if (memory)
    {
      const Index w = removal.ringVertex(i);
      cost +=
        std::abs(double{ defect_[w] } + change[0] + change[1] - double{ options_.inputDefect[w] });
    }
    else
    {
      cost += std::abs(change[0]) + std::abs(change[1]);
    }
  }
  return cost;
}

double BudgetDecimation::quadricCost(const VertexRemoval& removal, Index v) const
{
  double cost = std::numeric_limits<double>::infinity();
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    const Index w = removal.ringVertex(i);
    Quadric sum = quadric_[v];
    sum.add(quadric_[w]);
    cost = std::min(cost, sum.at(mesh_.position[w]));
  }
  return std::max(cost, 0.0);
}

double BudgetDecimation::shapeCost(const VertexRemoval& removal) const
{
  const double averageStar = 3 * area_ / budget_;
  double odd = 0;
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    if (mesh_.curves.kind[removal.ringVertex(i)] == VertexKind::Free)
    {
      const int valence = removal.newValence(i);
      odd += valence < 5 ? 5 - valence : std::max(0, valence - 7);
    }
  }
  const double bad = 1 - removal.worstQuality();
  return kAreaWeight * removal.starArea() / averageStar + kShapeWeight * bad * bad * bad +
    kValenceWeight * odd;
}

void BudgetDecimation::remember(const VertexRemoval& removal, Index v)
{
  if (options_.cost == DecimationCost::GaussianMemory)
  {
    for (int i = 0; i < removal.ringSize(); ++i)
    {
      const std::array<double, 2> change = removal.defectChange(i);
      defect_[removal.ringVertex(i)] += static_cast<float>(change[0] + change[1]);
    }
  }
  if (options_.cost == DecimationCost::Quadric)
  {
    int best = 0;
    for (int i = 1; i < removal.ringSize(); ++i)
    {
      const auto cost = [&](int j)
      { return quadric_[v].at(mesh_.position[removal.ringVertex(j)]); };
      best = cost(i) < cost(best) ? i : best;
    }
    quadric_[removal.ringVertex(best)].add(quadric_[v]);
  }
}

} // namespace

std::vector<float> angleDefects(const DecimationMesh& mesh)
{
  std::vector<float> defect(mesh.position.size(), 0.0F);
  for (Index v = 0; v < defect.size(); ++v)
  {
    if (mesh.outgoing[v] != kInvalidIndex)
    {
      defect[v] = static_cast<float>(mesh.isBoundary(mesh.outgoing[v]) ? kPi : 2 * kPi);
    }
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    for (Index h = 3 * f; mesh.isAlive(f) && h < 3 * f + 3; ++h)
    {
      const Vector3& p = mesh.position[mesh.origin[h]];
      const Vector3 a = mesh.position[mesh.target(h)] - p;
      const Vector3 b = mesh.position[mesh.origin[Mesh::previous(h)]] - p;
      defect[mesh.origin[h]] -= static_cast<float>(std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return defect;
}

std::string decimateToBudget(DecimationMesh& mesh, const BudgetOptions& options, LogBuilder& log)
{
  return BudgetDecimation(mesh, options, log).run();
}

} // namespace quadrille
