// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/DisjointSets.h"
#include "Base/Lists.h"
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
