// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/FieldLines.h"

#include "Base/Angles.h"
#include "CrossField/PowerField.h"

#include <cassert>
#include <cmath>

namespace quadrille
{
namespace
{

/// Quarter turns from the direction to the nearest axis of the field in face f.
int axisFrom(const Mesh& mesh, Index f, const Vector3& direction, double angle)
{
  const Vector3 x = mesh.edgeVector(3 * f).stableNormalized();
  const Vector3 y = x.cross(mesh.edgeVector(3 * f + 1)).stableNormalized().cross(x);
  return static_cast<int>(
    std::lround((angle - std::atan2(direction.dot(y), direction.dot(x))) / kRightAngle));
}

/// How the direction of a line turns from face to face, without the field's own axes: from direction to direction by
/// less than half a turn.
int jumpAlong(const Mesh& mesh, const FieldTopology& topology, const std::vector<double>& angle,
  const FieldLine& line, std::size_t i)
{
  const Index h = line.crossed[i];
  const Index f = Mesh::face(h), g = Mesh::face(mesh.twin[h]);
  const int here = axisFrom(mesh, f, line.along[i], angle[f]);
  const int there = axisFrom(mesh, g, line.along[i + 1], angle[g]);
  // The direction carried across is the next one but for whole turns, which the angles leave open.
  const double carried = edgeResidual(topology, angle, mesh, h, here - there) / (4 * kRightAngle);
  return here - there + 4 * static_cast<int>(std::lround(carried));
}

} // namespace

std::vector<std::uint8_t> holdJumps(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<FieldLine>& lines, const std::vector<double>& angle, std::vector<int>& jump)
{
  if (lines.empty())
  {
    return {};
  }
  std::vector<std::uint8_t> isHeld(mesh.halfEdgeCount(), 0);
  for (const FieldLine& line : lines)
  {
    assert(line.along.size() == line.crossed.size() + 1);
    int missing = 0;
    for (std::size_t i = 0; i < line.crossed.size(); ++i)
    {
      const Index h = line.crossed[i], twin = mesh.twin[h];
      const int wanted = jumpAlong(mesh, topology, angle, line, i) + missing;
      if (isHeld[h] == 0)
      {
        jump[h] = wanted;
        jump[twin] = -wanted;
        isHeld[h] = isHeld[twin] = 1;
      }
      missing = wanted - jump[h];
    }
  }
  std::vector<std::uint8_t> held;
  for (const auto& edge : topology.edges)
  {
    held.push_back(isHeld[edge[0]]);
  }
  return held;
}

} // namespace quadrille
