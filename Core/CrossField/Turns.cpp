// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/Turns.h"

#include "Base/Angles.h"

#include <cmath>

namespace quadrille
{
namespace
{

// Angle from the axis of its alignment to constrained half-edge h, in (-pi, pi].
double deviation(const FieldTopology& topology, const FieldConstraints& constraints,
  const std::vector<double>& angle, Index h)
{
  return wrapAngle(
    topology.direction[h] - angle[Mesh::face(h)] - kRightAngle * constraints.alignment[h]);
}

} // namespace

std::vector<int> roundJumps(
  const Mesh& mesh, const FieldTopology& topology, const std::vector<double>& angle)
{
  std::vector<int> jump(mesh.halfEdgeCount(), 0);
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    const double turn = edgeResidual(topology, angle, mesh, edge[0], 0);
    jump[edge[0]] = static_cast<int>(std::lround(turn / kRightAngle));
    jump[edge[1]] = -jump[edge[0]];
  }
  return jump;
}

std::vector<int> countTurns(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<double>& angle,
  const std::vector<int>& jump)
{
  std::vector<double> sum(topology.fans.size());
  for (std::size_t i = 0; i < topology.fans.size(); ++i)
  {
    const Fan& fan = topology.fans[i];
    sum[i] = fan.angle;
    if (fan.sector)
    {
      sum[i] += deviation(topology, constraints, angle, fan.first) -
        deviation(topology, constraints, angle, Mesh::previous(fan.last));
    }
  }
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    // edge[0] points to the vertex that edge[1] leaves.
    const double residual = edgeResidual(topology, angle, mesh, edge[0], jump[edge[0]]);
    sum[topology.fanOfCorner[edge[1]]] += residual;
    sum[topology.fanOfCorner[edge[0]]] -= residual;
  }
  std::vector<int> turns(topology.fans.size());
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    turns[i] = static_cast<int>(std::lround(sum[i] / kRightAngle));
  }
  return turns;
}

} // namespace quadrille
