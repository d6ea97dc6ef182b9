// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mesh with its fixed-point map, seen through exact predicates: what the extraction asks of it.
#pragma once

#include "Base/ChartRotation.h"
#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// Base/FixedPoint.h: differences of coordinates below this, 2^20 quads, have exact determinants.
constexpr std::int64_t kCoordinateLimit = std::int64_t{ 1 } << 44;

/// The unit vector of axis `direction` (0..3: +u, +v, -u, -v) in fixed point.
inline FixedVec2 axisVector(int direction)
{
  return rotate({ kOne, 0 }, direction);
}

/// Coordinate of p along axis `direction`.
inline std::int64_t along(FixedVec2 p, int direction)
{
  switch (direction & 3)
  {
    case 0:
      return p.u;
    case 1:
      return p.v;
    case 2:
      return -p.u;
    default:
      return -p.v;
  }
}

/// First axis at or counterclockwise after a vector other than zero.
inline int firstAxis(FixedVec2 e)
{
  if (e.u > 0 && e.v <= 0)
  {
    return 0;
  }
  if (e.u >= 0 && e.v > 0)
  {
    return 1;
  }
  return e.u < 0 && e.v >= 0 ? 2 : 3;
}

/// +1, 0, -1 as b lies counterclockwise of, along, or clockwise of a. Exact.
inline int orientation(FixedVec2 a, FixedVec2 b)
{
  const Int128 d = Int128{ a.u } * b.v - Int128{ a.v } * b.u;
  return (d > 0) - (d < 0);
}

/// References only: mesh and uv must outlive it.
struct ExactMap
{
  const Mesh& mesh;
  const std::vector<FixedVec2>& uv;

  FixedVec2 at(Index h) const { return uv[h]; }
  FixedVec2 edge(Index h) const { return uv[Mesh::next(h)] - uv[h]; }
  int orientationOf(Index f) const
  {
    return orientation(
      uv[3 * std::size_t{ f }], uv[3 * std::size_t{ f } + 1], uv[3 * std::size_t{ f } + 2]);
  }

  /// Does half-edge h run along an integer isoline?
  bool isOnIsoline(Index h) const
  {
    const FixedVec2 e = edge(h);
    return (e.v == 0 && isInteger(uv[h].v)) || (e.u == 0 && isInteger(uv[h].u));
  }

  /// The transition over h into the chart of its twin's face; false when there is no unique one: a
  /// boundary, an image of length zero, or two images that differ by more than a transition.
  bool transition(Index h, Transition& result) const
  {
    const Index g = mesh.twin[h];
    if (g == kInvalidIndex)
    {
      return false;
    }
    const std::optional<int> rotation = rotationBetween(edge(h), -edge(g));
    if (rotation)
    {
      result = { *rotation, uv[Mesh::next(g)] - rotate(uv[h], *rotation) };
    }
    return rotation.has_value();
  }
};

/// What can be wrong with one element of a map.
enum MapDefect
{
  kNotPositive, ///< a triangle with !(det > 0)
  kResidual,    ///< an edge whose two images differ by more than a transition
  kFractional,  ///< a transition with a translation that is not whole
  kOffIsoline,  ///< a constrained edge that does not lie on an integer isoline
  kMapDefects   ///< number of kinds
};

/// The exact check in front of the extraction.
struct MapCheck
{
  std::array<std::size_t, kMapDefects> count{};
  std::array<std::vector<Index>, kMapDefects> faces; ///< the first few of each kind, lowest first
  double area = 0;                                   ///< sum of |det| / 2 in quads
  double extent = 0; ///< sum of the triangles' widths in quads: bounds the work of a scan
  double constrainedLength = 0; ///< uv length of all constrained edges, each counted once, in quads
  Index outOfRange = kInvalidIndex; ///< a corner beyond the coordinates that are exact

  bool valid() const { return count == std::array<std::size_t, kMapDefects>{}; }
  /// "3 inverted triangles (faces 17, 18, 40)"; empty when valid.
  std::string text() const;
};

/// Linear and parallel; the result does not depend on the number of threads. isCertified: no edge has a defect, which
/// the certificate of the map has shown; then transitions are not looked at.
MapCheck checkMap(const ExactMap& map, bool isCertified, int threads);

} // namespace quadrille
