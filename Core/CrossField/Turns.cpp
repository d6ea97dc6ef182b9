// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/Turns.h"

#include "Base/Angles.h"
#include "CrossField/PowerField.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

constexpr double kNoise = kPi / 3; // turns up to here can be noise,
constexpr double kSharp =
  kPi / 2; // from here on they are the shape's own, like the steps of a part

// Walking along the border of the faces on the left, sector after sector.
struct BorderWalk
{
  std::vector<Index> before; // #fans; the sector at the other end of the incoming constrained edge
  std::vector<Index> after;  // #fans; ... of the outgoing one
};

BorderWalk linkSectors(const FieldTopology& topology)
{
  const std::size_t count = topology.fans.size();
  BorderWalk walk{ std::vector<Index>(count, kInvalidIndex),
    std::vector<Index>(count, kInvalidIndex) };
  for (Index i = 0; i < count; ++i)
  {
    if (topology.fans[i].sector)
    {
      // The fan that the start edge of this sector ends in holds the next corner of the same face.
      const Index next = topology.fanOfCorner[Mesh::next(topology.fans[i].first)];
      walk.after[i] = next;
      walk.before[next] = i;
    }
  }
  return walk;
}

// Turn of the border between its mean directions over `window` before and after sector i: the turns nearby
// weighted by a hat.
double windowedTurn(const FieldTopology& topology, const BorderWalk& walk,
  const std::vector<double>& turn, Index i, double window)
{
  double sum = turn[i];
  for (const bool forward : { true, false })
  {
    double distance = 0;
    Index at = i;
    while (true)
    {
      const Index next = forward ? walk.after[at] : walk.before[at];
      const Fan& start = topology.fans[forward ? at : next];
      distance += topology.edgeLength[start.first];
      if (distance >= window || next == i)
      {
        break;
      }
      sum += turn[next] * (1 - distance / window);
      at = next;
    }
  }
  return sum;
}

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

std::vector<double> naturalTurns(const FieldTopology& topology, double window)
{
  const BorderWalk walk = linkSectors(topology);
  std::vector<double> turn(topology.fans.size(), 0.0);
  for (std::size_t i = 0; i < turn.size(); ++i)
  {
    turn[i] = topology.fans[i].sector ? topology.fans[i].angle - kPi : 0.0;
  }
  std::vector<double> natural(turn.size());
  for (Index i = 0; i < turn.size(); ++i)
  {
    if (!topology.fans[i].sector)
    {
      natural[i] = topology.fans[i].angle / (0.5 * kPi);
      continue;
    }
    const double smooth = windowedTurn(topology, walk, turn, i, window);
    const double kept = turn[i] * smooth > 0
      ? std::copysign(std::min(std::abs(turn[i]), std::abs(smooth)), turn[i])
      : 0.0;
    const double sharp = std::clamp((std::abs(turn[i]) - kNoise) / (kSharp - kNoise), 0.0, 1.0);
    natural[i] = 2 + (sharp * turn[i] + (1 - sharp) * kept) / (0.5 * kPi);
  }
  return natural;
}

} // namespace quadrille
