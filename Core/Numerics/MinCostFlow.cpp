// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/MinCostFlow.h"

#include "Base/Error.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace quadrille
{
namespace
{

constexpr std::int64_t kUnreached = std::numeric_limits<std::int64_t>::max();

} // namespace

MinCostFlow::MinCostFlow(Index nodeCount)
  : excess_(nodeCount, 0), potential_(nodeCount, 0), distance_(nodeCount, kUnreached),
    entry_(nodeCount, kInvalidIndex), settled_(nodeCount, 0)
{
}

Index MinCostFlow::addArc(Index from, Index to, std::int64_t capacity, std::int64_t cost)
{
  if (from >= excess_.size() || to >= excess_.size() || capacity < 0)
  {
    throw InvalidInput("flow: an arc needs two existing nodes and a capacity of 0 or more");
  }
  arcs_.push_back({ to, capacity, cost });
  arcs_.push_back({ from, 0, -cost });
  return static_cast<Index>(arcs_.size() / 2 - 1);
}

void MinCostFlow::addSupply(Index node, std::int64_t amount)
{
  if (node >= excess_.size())
  {
    throw InvalidInput("flow: supply at a node that does not exist");
  }
  excess_[node] += amount;
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

void MinCostFlow::buildAdjacency()
{
  firstOut_.assign(excess_.size() + 1, 0);
  for (std::size_t i = 0; i < arcs_.size(); ++i)
  {
    ++firstOut_[arcs_[i ^ 1].to + 1];
  }
  for (std::size_t n = 0; n < excess_.size(); ++n)
  {
    firstOut_[n + 1] += firstOut_[n];
  }
  outgoing_.resize(arcs_.size());
  std::vector<Index> next(firstOut_.begin(), firstOut_.end() - 1);
  for (std::size_t i = 0; i < arcs_.size(); ++i)
  {
    outgoing_[next[arcs_[i ^ 1].to]++] = static_cast<Index>(i);
  }
}

void MinCostFlow::settle(Index node)
{
  settled_[node] = 1;
  for (Index k = firstOut_[node]; k < firstOut_[node + 1]; ++k)
  {
    const ResidualArc& arc = arcs_[outgoing_[k]];
    if (arc.capacity == 0 || settled_[arc.to] != 0)
    {
      continue;
    }
    const std::int64_t length = distance_[node] + arc.cost + potential_[node] - potential_[arc.to];
    if (length < distance_[arc.to])
    {
      if (distance_[arc.to] == kUnreached)
      {
        touched_.push_back(arc.to);
      }
      distance_[arc.to] = length;
      entry_[arc.to] = outgoing_[k];
      heap_.emplace_back(length, arc.to);
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }
}

// Dijkstra on reduced costs. Returns the first open demand reached, and lowers the potentials of settled
// nodes so that the path to it costs nothing and no reduced cost becomes negative.
Index MinCostFlow::findNearestDemand(Index source)
{
  for (const Index node : touched_)
  {
    distance_[node] = kUnreached;
    settled_[node] = 0;
  }
  touched_.assign(1, source);
  heap_.assign(1, { 0, source });
  distance_[source] = 0;
  entry_[source] = kInvalidIndex;
  while (!heap_.empty())
  {
    const Index node = heap_.front().second;
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    if (settled_[node] != 0)
    {
      continue;
    }
    if (excess_[node] < 0)
    {
      for (const Index reached : touched_)
      {
        potential_[reached] += settled_[reached] != 0 ? distance_[reached] - distance_[node] : 0;
      }
      return node;
    }
    settle(node);
  }
  return kInvalidIndex;
}

void MinCostFlow::augment(Index demand)
{
  std::int64_t amount = -excess_[demand];
  Index node = demand;
  while (entry_[node] != kInvalidIndex)
  {
    amount = std::min(amount, arcs_[entry_[node]].capacity);
    node = arcs_[entry_[node] ^ 1].to;
  }
  amount = std::min(amount, excess_[node]);
  excess_[node] -= amount;
  excess_[demand] += amount;
  for (node = demand; entry_[node] != kInvalidIndex; node = arcs_[entry_[node] ^ 1].to)
  {
    arcs_[entry_[node]].capacity -= amount;
    arcs_[entry_[node] ^ 1].capacity += amount;
  }
}

MinCostFlow::Result MinCostFlow::solve()
{
  saturateNegativeArcs();
  buildAdjacency();
  for (Index source = 0; source < excess_.size(); ++source)
  {
    while (excess_[source] > 0)
    {
      const Index demand = findNearestDemand(source);
      if (demand == kInvalidIndex)
      {
        break; // and no later path opens: a demand out of reach now stays so
      }
      augment(demand);
    }
  }
  Result result;
  for (const std::int64_t left : excess_)
  {
    result.unrouted += std::max<std::int64_t>(left, 0);
  }
  for (std::size_t i = 0; i < arcs_.size(); i += 2)
  {
    result.cost += arcs_[i].cost * arcs_[i + 1].capacity;
  }
  return result;
}

} // namespace quadrille
