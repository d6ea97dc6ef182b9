// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A joint surface on whose curves more than two sheets meet, as manifold sheets that lie apart from each other.
///
///         A | B            Two solids that touch: polygons that both have are kept once (I), the joint, where more
///        ---+---           than two sheets meet, is cut, and each sheet is moved to a place of its own, such that
///           | I            no later stage takes its border for that of another one.
#pragma once

#include "Assembly/JoinParts.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

struct JointSheets
{
  SurfaceInput input;               ///< of the sheets, with points of their own, moved apart
  std::vector<Index> jointPoint;    ///< per point of it: that of the joint surface
  std::vector<Index> sheetOf;       ///< per polygon of it
  std::vector<Index> sheetOfPoint;  ///< per point of it
  std::vector<Vector3> offset;      ///< per sheet, by how much it was moved
  Vector3 centre = Vector3::Zero(); ///< of the box round all before
  /// Per polygon of it: those of the joint surface that lie there, ascending; several where parts share a face.
  std::vector<std::vector<Index>> polygons;
  /// Of joints, by points of the joint surface, each once, ascending.
  std::vector<std::pair<Index, Index>> edges;
  /// Edges at which sheets only touch, and that are no joints for that; the middle of the first one.
  std::size_t touching = 0;
  Vector3 touchingPlace = Vector3::Zero();

  /// A place on a sheet that was moved, before that.
  Vector3 movedBack(const Vector3& place) const;
};

/// What becomes of edges at which sheets only touch: each that is there is there twice and goes on beyond, as where two
/// solids have a curve in common and no face.
enum class TouchingSheets : std::uint8_t
{
  Joined, ///< joints like others, unless there is no other way
  Left    ///< no joints: each sheet goes on, and nothing is common to them there
};

/// featureAngle: edges that end at a joint and are sharper, in radians, are asked for as features, as the rest of the
/// curve that they belong to may be on another sheet, where nobody sees that it is long enough; none: they are not.
/// A sheet that meets itself at a joint is cut at the borders of its patches, too. Throws InvalidInput, with the place,
/// where it does so even then.
JointSheets cutIntoSheets(const SurfaceInput& joint, std::optional<double> featureAngle,
  TouchingSheets touching = TouchingSheets::Joined);

} // namespace quadrille
