// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/TurnRepair.h"

#include "CrossField/TurnCosts.h"
#include "Numerics/MinCostFlow.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

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
      for (int step = 0; step < kEdgeSteps && !input_.isHeld(e); ++step)
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
    for (int step = 0; step < kEdgeSteps && !input_.isHeld(e); ++step)
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

} // namespace

TurnRepairResult repairTurns(const TurnRepairInput& input)
{
  return RepairFlow(input).solve();
}

} // namespace quadrille
