// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/MinCostFlow.h"

#include "Base/Refuse.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>

namespace quadrille
{
namespace
{

constexpr std::int64_t kUnreachedCost = std::numeric_limits<std::int64_t>::max();

} // namespace

MinCostFlow::MinCostFlow(Index nodeCount)
  : excess_(nodeCount, 0), potential_(nodeCount, 0), distance_(nodeCount, kUnreachedCost),
    entry_(nodeCount, kInvalidIndex), settled_(nodeCount, 0)
{
}

Index MinCostFlow::addArc(Index from, Index to, std::int64_t capacity, std::int64_t cost)
{
  refuseIf(from >= excess_.size() || to >= excess_.size() || capacity < 0,
    "flow: an arc needs two existing nodes and a capacity of 0 or more");
  arcs_.push_back({ to, capacity, cost });
  arcs_.push_back({ from, 0, -cost });
  return static_cast<Index>(arcs_.size() / 2 - 1);
}

void MinCostFlow::addSupply(Index node, std::int64_t amount)
{
  refuseIf(node >= excess_.size(), "flow: supply at a node that does not exist");
  excess_[node] += amount;
}

void MinCostFlow::setGround(Index node)
{
  refuseIf(node >= excess_.size(), "flow: the ground has to be an existing node");
  ground_ = node;
}

std::int64_t MinCostFlow::flow(Index arc) const
{
  return arcs_[2 * arc + 1].capacity;
}

// With negative arcs full, every residual cost is >= 0 and zero potentials are valid.
void MinCostFlow::saturateNegativeArcs()
{
  for (std::size_t i = 0; i < arcs_.size(); i += 2)
  {
    if (arcs_[i].cost < 0)
    {
      const std::int64_t amount = arcs_[i].capacity;
      excess_[arcs_[i + 1].to] -= amount;
      excess_[arcs_[i].to] += amount;
      arcs_[i + 1].capacity += amount;
      arcs_[i].capacity = 0;
    }
  }
}

bool MinCostFlow::isGoal(Index node, Direction direction) const
{
  return node == ground_ ||
    (direction == Direction::Forward ? excess_[node] < 0 : excess_[node] > 0);
}

void MinCostFlow::settle(Index node, Direction direction)
{
  const bool forward = direction == Direction::Forward;
  settled_[node] = 1;
  for (const Index* arc = outgoing_.begin(node); arc != outgoing_.end(node); ++arc)
  {
    const Index other = arcs_[*arc].to;
    const Index used = forward ? *arc : *arc ^ 1; // backward: other -> node
    if (arcs_[used].capacity == 0 || settled_[other] != 0)
    {
      continue;
    }
    const std::int64_t step =
      forward ? potential_[node] - potential_[other] : potential_[other] - potential_[node];
    const std::int64_t length = distance_[node] + arcs_[used].cost + step;
    if (length < distance_[other])
    {
      if (distance_[other] == kUnreachedCost)
      {
        touched_.push_back(other);
      }
      distance_[other] = length;
      entry_[other] = used;
      heap_.emplace_back(length, other);
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }
}

// Dijkstra on reduced costs. Returns the first goal reached, and shifts the potentials of settled
// nodes so that the path to it costs nothing and no reduced cost becomes negative.
Index MinCostFlow::findNearest(Index start, Direction direction)
{
  for (const Index node : touched_)
  {
    distance_[node] = kUnreachedCost;
    settled_[node] = 0;
  }
  touched_.assign(1, start);
  heap_.assign(1, { 0, start });
  distance_[start] = 0;
  entry_[start] = kInvalidIndex;
  while (!heap_.empty())
  {
    const Index node = heap_.front().second;
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    if (settled_[node] != 0)
    {
      continue;
    }
    if (isGoal(node, direction))
    {
      const std::int64_t sign = direction == Direction::Forward ? 1 : -1;
      for (const Index reached : touched_)
      {
        potential_[reached] +=
          settled_[reached] != 0 ? sign * (distance_[reached] - distance_[node]) : 0;
      }
      return node;
    }
    settle(node, direction);
  }
  return kInvalidIndex;
}

void MinCostFlow::augment(Index start, Index goal)
{
  const auto previous = [&](Index node)
  {
    const ResidualArc& arc = arcs_[entry_[node]];
    return arc.to == node ? arcs_[entry_[node] ^ 1].to : arc.to;
  };
  std::int64_t amount = std::abs(excess_[start]);
  if (goal != ground_)
  {
    amount = std::min(amount, std::abs(excess_[goal]));
  }
  for (Index node = goal; node != start; node = previous(node))
  {
    amount = std::min(amount, arcs_[entry_[node]].capacity);
  }
  for (Index node = goal; node != start; node = previous(node))
  {
    arcs_[entry_[node]].capacity -= amount;
    arcs_[entry_[node] ^ 1].capacity += amount;
  }
  const std::int64_t moved = excess_[start] > 0 ? amount : -amount;
  excess_[start] -= moved;
  excess_[goal] += moved;
}

void MinCostFlow::route(Direction direction)
{
  for (Index start = 0; start < excess_.size(); ++start)
  {
    while (start != ground_ &&
      (direction == Direction::Forward ? excess_[start] > 0 : excess_[start] < 0))
    {
      const Index goal = findNearest(start, direction);
      if (goal == kInvalidIndex)
      {
        break; // and no later path opens: a goal out of reach now stays so
      }
      augment(start, goal);
    }
  }
}

MinCostFlow::Result MinCostFlow::solve()
{
  saturateNegativeArcs();
  outgoing_ = { excess_.size(),
    [this](const auto& visit)
    {
      for (Index i = 0; i < arcs_.size(); ++i)
      {
        visit(arcs_[i ^ 1].to, i);
      }
    } };
  route(Direction::Forward);
  if (ground_ != kInvalidIndex)
  {
    route(Direction::Backward); // only the ground can serve what demand is left
  }
  Result result;
  for (Index node = 0; node < excess_.size(); ++node)
  {
    if (node != ground_)
    {
      result.unrouted += ground_ == kInvalidIndex ? std::max<std::int64_t>(excess_[node], 0)
                                                  : std::abs(excess_[node]);
    }
  }
  for (std::size_t i = 0; i < arcs_.size(); i += 2)
  {
    result.cost += arcs_[i].cost * arcs_[i + 1].capacity;
  }
  return result;
}

} // namespace quadrille
