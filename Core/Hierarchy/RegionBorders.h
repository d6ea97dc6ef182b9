// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The borders of guided regions and how they bend.
#pragma once

#include "Hierarchy/DecimationMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The borders of the guided regions of a mesh whose flags have them. Half-edges of borders that have the region on
/// their left run round it counterclockwise.
class RegionBorders
{
public:
  RegionBorders(const DecimationMesh& mesh, double length);

  bool touches(Index v) const { return degree_[v] > 0; }
  /// The border passes, and nothing else is there.
  bool passes(Index v) const { return degree_[v] == 2 && mesh_.curves.kind[v] == VertexKind::Free; }
  /// How much the border bends at a corner; 0 where it is none.
  double sharpness(Index v) const;

private:
  /// The next corner of the region at the same vertex; none past the border.
  Index nextInside(Index h) const;
  double innerAngle(Index v) const;
  /// The point about `length` further along the border.
  Vector3 walk(Index v, bool forward) const;

  const DecimationMesh& mesh_;
  double length_;
  std::vector<std::uint8_t> degree_; // of the border
  std::vector<Index> leaving_;       // half-edge of the border with the region on its left
  std::vector<Index> arriving_;
};

} // namespace quadrille
