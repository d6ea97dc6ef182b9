// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Numerics/MinCostFlow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <vector>

namespace quadrille
{
namespace
{

struct SmallGraph
{
  struct Arc
  {
    Index from;
    Index to;
    std::int64_t capacity;
    std::int64_t cost;
  };
  std::vector<std::int64_t> supply;
  std::vector<Arc> arcs;
};

SmallGraph randomGraph(std::mt19937& random, bool negativeCosts)
{
  const auto pick = [&](int low, int high)
  { return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)); };
  SmallGraph graph;
  const int nodes = pick(3, 5);
  graph.supply.assign(static_cast<std::size_t>(nodes), 0);
  for (int i = pick(1, 3); i > 0; --i)
  {
    ++graph.supply[static_cast<std::size_t>(pick(0, nodes - 1))];
    --graph.supply[static_cast<std::size_t>(pick(0, nodes - 1))];
  }
  for (int i = 0; i < 9; ++i)
  {
    const int from = pick(0, nodes - 1);
    const int to = (from + pick(1, nodes - 1)) % nodes;
    graph.arcs.push_back({ static_cast<Index>(from), static_cast<Index>(to), pick(1, 2),
      pick(negativeCosts ? -5 : 0, 9) });
  }
  return graph;
}

// Least cost over all flows that meet every supply, by trying each of them.
// The first `freeNodes` nodes' supplies need not be met.
std::optional<std::int64_t> bruteForce(const SmallGraph& graph, std::size_t freeNodes = 0)
{
  std::optional<std::int64_t> best;
  std::vector<std::int64_t> flow(graph.arcs.size(), 0);
  while (true)
  {
    std::vector<std::int64_t> left = graph.supply;
    std::int64_t cost = 0;
    for (std::size_t a = 0; a < flow.size(); ++a)
    {
      left[graph.arcs[a].from] -= flow[a];
      left[graph.arcs[a].to] += flow[a];
      cost += flow[a] * graph.arcs[a].cost;
    }
    if (std::all_of(left.begin() + static_cast<long>(freeNodes), left.end(),
          [](std::int64_t x) { return x == 0; }))
    {
      best = std::min(best.value_or(cost), cost);
    }
    std::size_t a = 0;
    for (; a < flow.size() && flow[a] == graph.arcs[a].capacity; ++a)
    {
      flow[a] = 0;
    }
    if (a == flow.size())
    {
      return best;
    }
    ++flow[a];
  }
}

TEST(MinCostFlow, AgreesWithBruteForce)
{
  std::mt19937 random(7);
  int feasible = 0;
  for (int round = 0; round < 400; ++round)
  {
    const SmallGraph graph = randomGraph(random, round % 2 == 1);
    MinCostFlow flow(static_cast<Index>(graph.supply.size()));
    for (Index node = 0; node < graph.supply.size(); ++node)
    {
      flow.addSupply(node, graph.supply[node]);
    }
    for (const SmallGraph::Arc& arc : graph.arcs)
    {
      flow.addArc(arc.from, arc.to, arc.capacity, arc.cost);
    }
    const MinCostFlow::Result result = flow.solve();
    const std::optional<std::int64_t> expected = bruteForce(graph);
    ASSERT_EQ(result.unrouted == 0, expected.has_value()) << "round " << round;
    if (expected)
    {
      ++feasible;
      ASSERT_EQ(result.cost, *expected) << "round " << round;
    }
    // Conservation, in either case.
    std::vector<std::int64_t> left = graph.supply;
    for (Index a = 0; a < graph.arcs.size(); ++a)
    {
      ASSERT_GE(flow.flow(a), 0);
      ASSERT_LE(flow.flow(a), graph.arcs[a].capacity);
      left[graph.arcs[a].from] -= flow.flow(a);
      left[graph.arcs[a].to] += flow.flow(a);
    }
    for (Index node = 0; node < left.size(); ++node)
    {
      ASSERT_EQ(left[node], flow.remaining(node));
    }
  }
  // Both kinds have to occur, or the comparison says little.
  EXPECT_GT(feasible, 100);
  EXPECT_LT(feasible, 400);
}

TEST(MinCostFlow, GroundAgreesWithBruteForce)
{
  std::mt19937 random(11);
  int feasible = 0;
  for (int round = 0; round < 400; ++round)
  {
    SmallGraph graph = randomGraph(random, round % 2 == 1);
    graph.supply[1] += round % 3 - 1; // the rest need not balance: node 0 gives and takes
    MinCostFlow flow(static_cast<Index>(graph.supply.size()));
    flow.setGround(0);
    for (Index node = 1; node < graph.supply.size(); ++node)
    {
      flow.addSupply(node, graph.supply[node]);
    }
    for (const SmallGraph::Arc& arc : graph.arcs)
    {
      flow.addArc(arc.from, arc.to, arc.capacity, arc.cost);
    }
    const MinCostFlow::Result result = flow.solve();
    const std::optional<std::int64_t> expected = bruteForce(graph, 1);
    ASSERT_EQ(result.unrouted == 0, expected.has_value()) << "round " << round;
    if (expected)
    {
      ++feasible;
      ASSERT_EQ(result.cost, *expected) << "round " << round;
    }
  }
  EXPECT_GT(feasible, 100);
  EXPECT_LT(feasible, 400);
}

TEST(MinCostFlow, SplitsAlongParallelArcsOfAConvexCost)
{
  // Two routes of cost 1, 3, 5 each for the first, second, third unit: three units go two and one.
  MinCostFlow flow(4);
  std::array<std::array<Index, 3>, 2> arcs{};
  for (Index route = 0; route < 2; ++route)
  {
    for (Index unit = 0; unit < 3; ++unit)
    {
      arcs[route][unit] = flow.addArc(0, 1 + route, 1, 1 + 2 * unit);
    }
    flow.addArc(1 + route, 3, 3, 0);
  }
  flow.addSupply(0, 3);
  flow.addSupply(3, -3);
  EXPECT_EQ(flow.solve().cost, 1 + 1 + 3);
  EXPECT_EQ(flow.flow(arcs[0][0]) + flow.flow(arcs[1][0]), 2);
  EXPECT_EQ(flow.flow(arcs[0][1]) + flow.flow(arcs[1][1]), 1);
}

TEST(MinCostFlow, RefusesBadArcs)
{
  MinCostFlow flow(2);
  EXPECT_THROW(flow.addArc(0, 2, 1, 0), InvalidInput);
  EXPECT_THROW(flow.addArc(0, 1, -1, 0), InvalidInput);
  EXPECT_THROW(flow.addSupply(2, 1), InvalidInput);
}

} // namespace
} // namespace quadrille
