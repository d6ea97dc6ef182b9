// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/SingularityDistance.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Evaluation/GeodesicGraph.h"
#include "Mesh/Topology.h"
#include "Numerics/MinCostFlow.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{

namespace
{

void requireTurns(const Mesh& mesh, const std::vector<int>& turns)
{
  refuseIf(turns.size() != mesh.vertexCount(), "There are quarter turns for ", turns.size(),
    " vertices, but the mesh has ", mesh.vertexCount(), ".");
}

/// Vertices where one field has more quarter turns than the other one, with how many.
struct Excess
{
  std::vector<Index> vertices;
  std::vector<int> turns;
};

Excess excessOf(const std::vector<int>& turns, const std::vector<int>& otherTurns)
{
  Excess excess;
  for (Index v = 0; v < turns.size(); ++v)
  {
    if (turns[v] > otherTurns[v])
    {
      excess.vertices.push_back(v);
      excess.turns.push_back(turns[v] - otherTurns[v]);
    }
  }
  return excess;
}

/// Way by way from each source (row) to each sink (column); infinite between components.
std::vector<std::vector<double>> waysBetween(
  const Mesh& mesh, const Excess& sources, const Excess& sinks, int threads)
{
  const GeodesicGraph graph(mesh);
  std::vector<std::vector<double>> ways(sources.vertices.size());
  parallelForEach(ways.size(), 1, threads,
    [&](std::size_t i) { ways[i] = graph.distances(sources.vertices[i], sinks.vertices); });
  return ways;
}

/// The transport problem between sources and sinks; only the longest way sets its unit.
void transport(const Excess& sources, const Excess& sinks,
  const std::vector<std::vector<double>>& ways, SingularityDistance& result)
{
  double longest = 0;
  for (const std::vector<double>& row : ways)
  {
    for (const double way : row)
    {
      longest = std::isfinite(way) ? std::max(longest, way) : longest;
    }
  }
  const double unit = longest > 0 ? longest / kUnitsOfLongest : 1;
  const Index count = static_cast<Index>(sources.vertices.size());
  const Index sinkCount = static_cast<Index>(sinks.vertices.size());
  MinCostFlow flow(count + sinkCount);
  std::vector<std::array<Index, 2>> ends; // of each arc
  for (Index i = 0; i < count; ++i)
  {
    flow.addSupply(i, sources.turns[i]);
    for (Index k = 0; k < sinkCount; ++k)
    {
      if (std::isfinite(ways[i][k]))
      {
        const int most = std::min(sources.turns[i], sinks.turns[k]);
        flow.addArc(i, count + k, most, std::llround(ways[i][k] / unit));
        ends.push_back({ i, k });
      }
    }
  }
  for (Index k = 0; k < sinkCount; ++k)
  {
    flow.addSupply(count + k, -sinks.turns[k]);
  }
  flow.solve();
  for (Index arc = 0; arc < ends.size(); ++arc)
  {
    const auto [i, k] = ends[arc];
    if (const std::int64_t turns = flow.flow(arc))
    {
      result.moves.push_back(
        { sources.vertices[i], sinks.vertices[k], static_cast<int>(turns), ways[i][k] });
      result.work += static_cast<double>(turns) * ways[i][k];
    }
  }
  for (Index node = 0; node < count + sinkCount; ++node)
  {
    result.unmatched += std::abs(flow.remaining(node));
  }
}

} // namespace

std::map<int, std::size_t> singularityHistogram(const Mesh& mesh, const std::vector<int>& turns)
{
  requireTurns(mesh, turns);
  const std::vector<int> regular = regularTurns(mesh);
  std::map<int, std::size_t> histogram;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (regular[v] == 4 && turns[v] != 4)
    {
      ++histogram[turns[v]];
    }
  }
  return histogram;
}

SingularityDistance singularityDistance(
  const Mesh& mesh, const std::vector<int>& turns, const std::vector<int>& otherTurns, int threads)
{
  requireTurns(mesh, turns);
  requireTurns(mesh, otherTurns);
  // The index of a vertex is what it lacks to a regular one, so it goes from where turns are more afterwards.
  const Excess sources = excessOf(otherTurns, turns);
  const Excess sinks = excessOf(turns, otherTurns);
  SingularityDistance result;
  transport(sources, sinks, waysBetween(mesh, sources, sinks, threads), result);
  return result;
}

} // namespace quadrille
