// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connections that a user asks for, as lines that the map of a field has to have [Ebke et al. 2016,
/// Section 4]. Where we differ: the line is one equation of the seamless map, and becomes an edge of the triangulation
/// that integers are found on, so that neither rounding nor re-embedding can lose it.
#pragma once

#include "CrossField/CrossField.h"
#include "Integers/CurvePaths.h"
#include "Integers/UvRays.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// What became of a curve that was asked for.
struct CurveOutcome
{
  bool met = false;
  std::string why;            ///< where it is not met: the reason and what helps
  Index from = kInvalidIndex; ///< the vertices that a connection joins, of the mesh
  Index to = kInvalidIndex;
  Vector3 start = Vector3::Zero(); ///< their places; of a cycle its first point
  Vector3 end = Vector3::Zero();
};

/// What leads a field along curves.
struct CurvesInField
{
  std::vector<Guide> guides;         ///< #F or empty
  std::vector<FieldLine> lines;      ///< along which it does not turn
  std::vector<std::uint8_t> regular; ///< #V: vertices that would stand in the way of the lines
};

/// A curve that is to be followed.
struct FollowedCurve
{
  CurveRequest curve;
  std::optional<Isoline> way; ///< in place of the way along the curve
};

/// guides: #F or empty; those that are there stay. field: of the same mesh without the curves, with the vertices at
/// their ends. edgeLength: s.
CurvesInField followedCurves(const Mesh& mesh, const CrossField& field,
  const std::vector<FollowedCurve>& curves, double edgeLength, std::vector<Guide> guides);

/// Target valences that hold all turns of a field off features and boundaries. valences: #V or empty; those that are
/// asked for stay.
std::vector<int> valencesOf(const Mesh& mesh, const CrossField& field, std::vector<int> valences);

/// Target valences that hold the irregular vertices at the ends of connections where the field has them. valences: #V
/// or empty, the same back; those that are asked for stay.
std::vector<int> valencesWithEnds(const Mesh& mesh, const CrossField& field,
  const std::vector<FollowedCurve>& curves, double edgeLength, std::vector<int> valences);

/// A curve's line in the map of a field, or why there is none.
struct RequestedLine
{
  CurveOutcome outcome; ///< met: not known yet, `why` says why there is no line
  Isoline line;
  bool hasLine = false; ///< whether `line` is an equation
  bool endsOnCurve =
    false; ///< the line ends where it meets a feature or boundary; no equation says where

  bool isWanted() const { return hasLine || endsOnCurve; }
};

/// edgeLength: s. Ends of connections are taken to the nearest irregular vertex within 3 s, else feature or boundary
/// vertex within 1.5 s.
RequestedLine lineOf(
  const Mesh& mesh, const CrossField& field, const CurveRequest& curve, double edgeLength);

/// Another way between the same two vertices: the one nearest to the curve and to an axis of those that are straight
/// lines in a seamless map without the line, so that nothing stands in its way. None where no such way is near an axis.
std::optional<Isoline> straightWay(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const CurveRequest& curve, const CurveOutcome& ends,
  double edgeLength);

/// Which axis of another field on the same mesh a way between two vertices runs along.
int axisAlong(const Mesh& mesh, const CrossField& field, const Isoline& way);

/// The same way through the faces of a map: end(start), in units of 2^-24, of a line in the chart of its first face.
FixedVec2 developedVector(const UvMesh& map, const Isoline& line);

/// Makes the line an edge, or several. `map` is that of `mesh` with vertices removed, not those of `integer` (#V).
/// False where a vertex or a curve stands in its way. developed: developedVector() before.
bool lockLine(UvMesh& map, UvEditor& editor, const std::vector<std::uint8_t>& integer,
  const Mesh& mesh, const Isoline& line, FixedVec2 developed);

/// Whether an integer-grid map has the line: from vertex to vertex, or to a curve near the place asked for.
bool hasGridLine(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv,
  const RequestedLine& wanted, double edgeLength);

} // namespace quadrille
