// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/SingularityDistance.h"

#include "Base/Error.h"
#include "Mesh/Topology.h"
#include "Numerics/MinCostFlow.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace quadrille
{

namespace
{

/// Integer units that the mean edge gets: finer than any edge's length matters.
constexpr double kUnitsPerEdge = 1024;
/// More than all quarter turns of any field together.
constexpr std::int64_t kUnlimited = std::int64_t{ 1 } << 40;

double meanEdgeLength(const Mesh& mesh)
{
  double sum = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    sum += mesh.edgeVector(h).norm();
  }
  return sum / std::max<Index>(mesh.halfEdgeCount(), 1);
}

void requireTurns(const Mesh& mesh, const std::vector<int>& turns)
{
  if (turns.size() != mesh.vertexCount())
  {
    throw InvalidInput("There are quarter turns for " + std::to_string(turns.size()) +
      " vertices, but the mesh has " + std::to_string(mesh.vertexCount()) + ".");
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
  const Mesh& mesh, const std::vector<int>& turns, const std::vector<int>& otherTurns)
{
  requireTurns(mesh, turns);
  requireTurns(mesh, otherTurns);
  const double mean = meanEdgeLength(mesh);
  if (!(mean > 0))
  {
    return {};
  }
  MinCostFlow flow(mesh.vertexCount());
  const auto addArc = [&](Index from, Index to, double length)
  { flow.addArc(from, to, kUnlimited, std::llround(kUnitsPerEdge * length / mean)); };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const double length = mesh.edgeVector(h).norm();
    addArc(mesh.origin[h], mesh.target(h), length);
    if (mesh.isBoundary(h))
    {
      addArc(mesh.target(h), mesh.origin[h], length);
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (turns[v] != otherTurns[v])
    {
      flow.addSupply(
        v, otherTurns[v] - turns[v]); // the index is what is missing to a regular vertex
    }
  }
  const MinCostFlow::Result result = flow.solve();
  SingularityDistance distance;
  distance.work = static_cast<double>(result.cost) * mean / kUnitsPerEdge;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    distance.unmatched += std::abs(flow.remaining(v));
  }
  return distance;
}

} // namespace quadrille
