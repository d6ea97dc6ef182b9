// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/AngleStructure.h"
#include "CrossField/TurnCosts.h"
#include "CrossField/TurnRepair.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

namespace quadrille
{
namespace
{

using Flags = std::vector<std::uint8_t>;

// Shortest paths for single turns over the unconstrained edges.
class TurnMover
{
public:
  TurnMover(const TurnRepairInput& input, TurnRepairResult& result)
    : input_(input), result_(result), start_(result.turns.size() + 1, 0)
  {
    const FieldTopology& topology = *input.topology;
    for (const std::array<Index, 2>& edge : topology.edges)
    {
      ++start_[topology.fanOfCorner[edge[0]] + 1];
      ++start_[topology.fanOfCorner[edge[1]] + 1];
    }
    for (std::size_t i = 1; i < start_.size(); ++i)
    {
      start_[i] += start_[i - 1];
    }
    link_.resize(2 * topology.edges.size());
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    for (Index e = 0; e < topology.edges.size(); ++e)
    {
      link_[next[topology.fanOfCorner[topology.edges[e][0]]]++] = { e, false };
      link_[next[topology.fanOfCorner[topology.edges[e][1]]]++] = { e, true };
    }
  }

  // Takes a turn from the cheapest fan of one group to the cheapest of the other; false when that would make
  // something that no map realizes.
  bool move(const Flags& from, const Flags& to)
  {
    using Entry = std::pair<double, Index>;
    constexpr double kUnreached = std::numeric_limits<double>::infinity();
    std::vector<double> distance(result_.turns.size(), kUnreached);
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
      for (Index k = start_[fan]; k < start_[fan + 1]; ++k)
      {
        const Index other = otherFan(link_[k]);
        const double through = length + linkCost(link_[k]);
        if (through < distance[other])
        {
          distance[other] = through;
          entry[other] = link_[k];
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
  // Edge and direction; forward: a turn goes from the fan of edges[e][1] to that of edges[e][0].
  struct Link
  {
    Index edge = kInvalidIndex;
    bool forward = false;
  };

  Index otherFan(const Link& link) const
  {
    return input_.topology->fanOfCorner[input_.topology->edges[link.edge][link.forward ? 0 : 1]];
  }
  double linkCost(const Link& link) const
  {
    if (input_.isHeld(link.edge))
    {
      return kForbiddenTurn;
    }
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
  std::vector<Index> start_; // #fans + 1, into link_
  std::vector<Link> link_;   // links that leave each fan
};

// Splits a group into parts that no unconstrained edge joins.
std::vector<Flags> splitGroup(const FieldTopology& topology, const Flags& group)
{
  std::vector<std::vector<Index>> neighbours(group.size());
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    const Index a = topology.fanOfCorner[edge[0]];
    const Index b = topology.fanOfCorner[edge[1]];
    if (group[a] != 0 && group[b] != 0)
    {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  std::vector<Flags> parts;
  Flags seen(group.size(), 0);
  for (Index seed = 0; seed < group.size(); ++seed)
  {
    if (group[seed] == 0 || seen[seed] != 0)
    {
      continue;
    }
    parts.emplace_back(group.size(), 0);
    std::vector<Index> queue{ seed };
    seen[seed] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i)
    {
      parts.back()[queue[i]] = 1;
      for (const Index next : neighbours[queue[i]])
      {
        if (seen[next] == 0)
        {
          seen[next] = 1;
          queue.push_back(next);
        }
      }
    }
  }
  return parts;
}

} // namespace

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
