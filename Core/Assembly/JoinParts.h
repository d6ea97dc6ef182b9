// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Several surfaces, parts of an assembly, become one where they have edges in common.
///
/// Two parts have an edge in common where the ends of an edge of the one lie at the places of the ends of an edge of
/// the other, up to kRoundingOfSingle of the box round all. Parts that only touch in a point, or along curves on which
/// each has points of its own, have none.
#pragma once

#include "Mesh/Surface.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// What parts have in common.
struct PartContacts
{
  std::vector<Index> firstPoint; ///< #parts + 1; points are numbered part after part
  std::vector<Index>
    pointOf; ///< per point: the lowest one that it is the same as, by a common edge; else itself
  std::vector<Index>
    group;               ///< per part: the lowest one that it hangs together with by common edges
  std::size_t edges = 0; ///< common ones, of two parts or more

  /// Edges of more than two faces, of more than one part: sheets that no manifold holds together. The three lowest
  /// parts at the first of them, and its middle.
  std::size_t manyFaced = 0;
  std::vector<Index> manyFacedParts;
  Vector3 manyFacedPlace = Vector3::Zero();

  /// Points where two parts meet, but no edge of any part that is there is common: curves along which each has points
  /// of its own. The two parts of the first of them, and its place.
  std::size_t loosePoints = 0;
  std::array<Index, 2> looseParts{};
  Vector3 loosePlace = Vector3::Zero();
};

/// Throws InvalidInput for more than 2^32 - 2 points in all. Corners must be within the points of their part.
PartContacts findContacts(const std::vector<const SurfaceInput*>& parts);

/// Parts as one surface. Features are the edges between two of them, too.
struct JoinedParts
{
  SurfaceInput input;                  ///< polygons part after part
  std::vector<Index> firstPolygon;     ///< #parts + 1
  std::vector<std::size_t> firstCurve; ///< #parts + 1, in input.curves
  /// Per part: its polygons, and the points of the joint surface with those of the part, ascending by the former.
  struct Part
  {
    std::vector<Index> polygonOffsets, polygonPoints; ///< in the part's own points
    std::vector<std::pair<Index, Index>> points;      ///< of the joint surface, of the part

    /// Of the part; kInvalidIndex where the part does not have it.
    Index ownPoint(Index joint) const;
  };
  std::vector<Part> parts;

  Index partOf(Index polygon) const;
};

/// Points that are one in `contacts`, which is of these parts, get the place of the lowest one; of sizes asked for
/// there the smallest counts, of valences the first. contacts: all parts must be one group, or those of several groups
/// stay apart. Throws InvalidInput for fewer than two parts.
JoinedParts joinParts(std::vector<SurfaceInput> parts, const PartContacts& contacts);

} // namespace quadrille
