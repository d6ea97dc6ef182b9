// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/TurnRepair.h"

#include "Base/Angles.h"
#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "CrossField/AngleStructure.h"
#include "Numerics/MinCostFlow.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kIrregular = 1.0;   // an irregular vertex: a pair closer than about 2 s vanishes
constexpr double kCostOfBend = 0.25; // a sector that is not straight
constexpr double kUnnatural = 2.0;   // squared difference of a sector's turns to the natural ones
constexpr double kCone = 0.1;        // the same inside; weak, because scans are full of small cones
constexpr double kRare = 1e3;        // valence 2 and 6

constexpr int kEdgeSteps = 2; // shifts of one edge either way
constexpr int kNodeSteps = 4; // changes of one fan's turns either way

std::int64_t integerCost(double cost)
{
  return std::llround(cost * 1024);
}

// Nodes are fans, then groups of fans with a prescribed sum; the last one (the hub) takes up what free fans deviate
// from their cheapest turns. Its balance follows from the sum rule, so it may be the flow's ground. What the fans of a
// group deviate goes to the group's node, whose demand is what the sum deviates.
class RepairFlow
{
public:
  explicit RepairFlow(const TurnRepairInput& input)
    : input_(input), fans_(static_cast<Index>(input.turns->size())),
      hub_(fans_ + (input.prescription ? static_cast<Index>(input.prescription->turns.size()) : 0)),
      flow_(hub_ + 1)
  {
    flow_.setGround(hub_);
    for (Index i = 0; i < fans_; ++i)
    {
      addFan(i);
    }
    for (Index group = 0; fans_ + group < hub_; ++group)
    {
      flow_.addSupply(fans_ + group, -input.prescription->turns[group]);
    }
    firstEdgeArc_ = arcCount_;
    for (std::size_t e = 0; e < input.topology->edges.size(); ++e)
    {
      addEdge(e);
    }
  }

  TurnRepairResult solve()
  {
    TurnRepairResult result;
    result.complete = flow_.solve().unrouted == 0;
    result.turns = *input_.turns;
    Index arc = firstEdgeArc_;
    for (std::size_t e = 0; e < input_.topology->edges.size(); ++e)
    {
      const std::array<Index, 2>& edge = input_.topology->edges[e];
      int shift = 0;
      for (int step = 0; step < kEdgeSteps; ++step)
      {
        shift += static_cast<int>(flow_.flow(arc++));
        shift -= static_cast<int>(flow_.flow(arc++));
      }
      result.shift.push_back(shift);
      result.turns[input_.topology->fanOfCorner[edge[1]]] -= shift;
      result.turns[input_.topology->fanOfCorner[edge[0]]] += shift;
    }
    return result;
  }

private:
  void addFan(Index i)
  {
    const Fan& fan = input_.topology->fans[i];
    const bool free = input_.prescription == nullptr || input_.prescription->isFree(i);
    const Index sink = free ? hub_ : fans_ + input_.prescription->groupOfFan[i];
    if (fan.sector && fan.corners == 1)
    {
      if (!free)
      {
        flow_.addSupply(sink, (*input_.turns)[i]);
      }
      return; // no edge can change it
    }
    const double natural = (*input_.natural)[i];
    const double irregular = input_.costOfIrregular(i);
    const int cheapest = cheapestTurns(fan, natural, irregular);
    const int excess = (*input_.turns)[i] - cheapest;
    flow_.addSupply(i, excess);
    if (!free)
    {
      flow_.addSupply(sink, cheapest);
    }
    for (int step = 0; step < kNodeSteps; ++step)
    {
      const double here = fanCost(fan, natural, cheapest + step, irregular);
      const double more = fanCost(fan, natural, cheapest + step + 1, irregular);
      addArc(i, sink, more - here);
      const double low = fanCost(fan, natural, cheapest - step, irregular);
      const double less = fanCost(fan, natural, cheapest - step - 1, irregular);
      addArc(sink, i, less - low);
    }
  }

  void addEdge(std::size_t e)
  {
    const std::array<Index, 2>& edge = input_.topology->edges[e];
    const Index head = input_.topology->fanOfCorner[edge[1]];
    const Index tail = input_.topology->fanOfCorner[edge[0]];
    for (int step = 0; step < kEdgeSteps; ++step)
    {
      addArc(head, tail, shiftCost(input_, e, step, 1));
      addArc(tail, head, shiftCost(input_, e, -step, -1));
    }
  }

  void addArc(Index from, Index to, double cost)
  {
    flow_.addArc(from, to, 1, integerCost(cost));
    ++arcCount_;
  }

  const TurnRepairInput& input_;
  Index fans_;
  Index hub_;
  MinCostFlow flow_;
  Index arcCount_ = 0;
  Index firstEdgeArc_ = 0;
};

using Flags = std::vector<std::uint8_t>;

// Shortest paths for single turns over the unconstrained edges.
class TurnMover
{
  // Edge and direction; forward: a turn goes from the fan of edges[e][1] to that of edges[e][0].
  struct Link
  {
    Index edge = kInvalidIndex;
    bool forward = false;
  };

public:
  TurnMover(const TurnRepairInput& input, TurnRepairResult& result)
    : input_(input), result_(result),
      links_(result.turns.size(),
        [&](const auto& visit)
        {
          const FieldTopology& topology = *input.topology;
          for (Index e = 0; e < topology.edges.size(); ++e)
          {
            visit(topology.fanOfCorner[topology.edges[e][0]], { e, false });
            visit(topology.fanOfCorner[topology.edges[e][1]], { e, true });
          }
        })
  {
  }

  // Takes a turn from the cheapest fan of one group to the cheapest of the other; false when that would make
  // something that no map realizes.
  bool move(const Flags& from, const Flags& to)
  {
    using Entry = std::pair<double, Index>;
    std::vector<double> distance(result_.turns.size(), kInfinity);
    std::vector<std::optional<Link>> entry(result_.turns.size());
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    for (Index i = 0; i < from.size(); ++i)
    {
      if (from[i] != 0)
      {
        distance[i] = changeCost(i, -1);
        queue.emplace(distance[i], i);
      }
    }
    double best = kForbiddenTurn / 2;
    Index goal = kInvalidIndex;
    while (!queue.empty() && queue.top().first < best)
    {
      const auto [length, fan] = queue.top();
      queue.pop();
      if (length > distance[fan])
      {
        continue;
      }
      if (to[fan] != 0 && length + changeCost(fan, 1) < best)
      {
        best = length + changeCost(fan, 1);
        goal = fan;
      }
      for (const Link* link = links_.begin(fan); link != links_.end(fan); ++link)
      {
        const Index other = otherFan(*link);
        const double through = length + linkCost(*link);
        if (through < distance[other])
        {
          distance[other] = through;
          entry[other] = *link;
          queue.emplace(through, other);
        }
      }
    }
    if (goal != kInvalidIndex)
    {
      apply(goal, entry);
    }
    return goal != kInvalidIndex;
  }

private:
  Index otherFan(const Link& link) const
  {
    return input_.topology->fanOfCorner[input_.topology->edges[link.edge][link.forward ? 0 : 1]];
  }
  double linkCost(const Link& link) const
  {
    // What an earlier shift would win back is not for this path to collect.
    return std::max(
      0.0, shiftCost(input_, link.edge, result_.shift[link.edge], link.forward ? 1 : -1));
  }
  // May be negative where an angle structure asked for more than the fan wanted; as an offset that is no
  // harm to the search.
  double changeCost(Index i, int step) const
  {
    if (input_.prescription != nullptr && !input_.prescription->isFree(i))
    {
      return kForbiddenTurn;
    }
    const Fan& fan = input_.topology->fans[i];
    const double natural = (*input_.natural)[i];
    const double irregular = input_.costOfIrregular(i);
    return fanCost(fan, natural, result_.turns[i] + step, irregular) -
      fanCost(fan, natural, result_.turns[i], irregular);
  }
  void apply(Index goal, const std::vector<std::optional<Link>>& entry)
  {
    ++result_.turns[goal];
    Index fan = goal;
    while (entry[fan])
    {
      const Link link = *entry[fan];
      result_.shift[link.edge] += link.forward ? 1 : -1;
      fan = otherFan({ link.edge, !link.forward });
    }
    --result_.turns[fan];
  }

  const TurnRepairInput& input_;
  TurnRepairResult& result_;
  Grouped<Link> links_; // that leave each fan
};

// Splits a group into parts that no unconstrained edge joins.
std::vector<Flags> splitGroup(const FieldTopology& topology, const Flags& group)
{
  DisjointSets sets(group.size(), 1);
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    const Index a = topology.fanOfCorner[edge[0]];
    const Index b = topology.fanOfCorner[edge[1]];
    if (group[a] != 0 && group[b] != 0)
    {
      sets.join(a, b);
    }
  }
  std::vector<Flags> parts;
  std::vector<std::size_t> partOf(group.size()); // per root, which is the lowest fan of its part
  for (Index fan = 0; fan < group.size(); ++fan)
  {
    const Index root = sets.find(fan);
    if (group[fan] != 0 && root == fan)
    {
      partOf[fan] = parts.size();
      parts.emplace_back(group.size(), 0);
    }
    if (group[fan] != 0)
    {
      parts[partOf[root]][fan] = 1;
    }
  }
  return parts;
}

} // namespace

TurnRepairResult repairTurns(const TurnRepairInput& input)
{
  return RepairFlow(input).solve();
}

int turnLimit(const Fan& fan)
{
  return 2 * static_cast<int>(fan.corners) - 1;
}

double fanCost(const Fan& fan, double natural, int turns, double irregular)
{
  const int limit = turnLimit(fan);
  double cost = kForbiddenTurn * (std::max(0, 1 - turns) + std::max(0, turns - limit));
  if (fan.sector)
  {
    return cost + kUnnatural * (turns - natural) * (turns - natural) +
      kCostOfBend * std::abs(turns - 2);
  }
  const int away = std::abs(turns - 4);
  cost += kCone * (turns - natural) * (turns - natural) +
    (kIrregular + irregular) * std::min(away, 1) + kRare * std::max(away - 1, 0);
  return cost + kForbiddenTurn * std::max(away - 2, 0);
}

int cheapestTurns(const Fan& fan, double natural, double irregular)
{
  int best = fan.sector ? 2 : 4;
  for (const int step : { 1, -1 })
  {
    while (fanCost(fan, natural, best + step, irregular) < fanCost(fan, natural, best, irregular))
    {
      best += step;
    }
  }
  return best;
}

double shiftCost(const TurnRepairInput& input, std::size_t e, int shift, int step)
{
  const bool stiff = input.stiffness != nullptr && !input.stiffness->empty();
  const double weight = input.topology->edgeLength[input.topology->edges[e][0]] / input.length *
    (stiff ? (*input.stiffness)[e] : 1.0);
  const double residual = (*input.residual)[e] / kRightAngle;
  // (residual - shift - step)^2 - (residual - shift)^2
  return weight * (1 - 2 * step * (residual - shift));
}

std::vector<std::uint8_t> completeTurns(
  const Mesh& mesh, const TurnRepairInput& input, TurnRepairResult& result)
{
  // Each round settles every separate place by one turn; places rarely need more than two.
  constexpr int kRounds = 16;
  TurnMover mover(input, result);
  for (int round = 0;; ++round)
  {
    const AngleStructure structure = findAngleStructure(mesh, *input.topology, result.turns);
    if (structure.feasible)
    {
      return {};
    }
    const std::vector<Flags> sources = splitGroup(*input.topology, structure.tooMany);
    const std::vector<Flags> goals = splitGroup(*input.topology, structure.tooFew);
    const bool bySource = sources.size() >= goals.size();
    bool moved = false;
    for (std::size_t i = 0; round < kRounds && i < (bySource ? sources : goals).size(); ++i)
    {
      const bool done = bySource ? mover.move(sources[i], structure.tooFew)
                                 : mover.move(structure.tooMany, goals[i]);
      moved = moved || done;
    }
    if (!moved)
    {
      const bool smaller = std::count(structure.tooMany.begin(), structure.tooMany.end(), 1) <=
        std::count(structure.tooFew.begin(), structure.tooFew.end(), 1);
      return smaller ? structure.tooMany : structure.tooFew;
    }
  }
}

} // namespace quadrille
