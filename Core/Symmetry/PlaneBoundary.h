// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The boundary of a half in its mirror plane, on its triangles as they are given.
#pragma once

#include "Symmetry/MirrorCut.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// Edges are named by the corners that they begin at.
class PlaneBoundary
{
public:
  PlaneBoundary(const MirrorHalf& half, const MirrorPlane& plane, double tolerance);

  /// Corners whose edge, to the next one, is on the boundary in the plane.
  const std::vector<Index>& edges() const { return inside_; }
  /// Chains of them in the order of the boundary; a closed one ends where it begins.
  std::vector<std::vector<Index>> chains() const;

  Index from(Index edge) const { return input_.polygonPoints[edge]; }
  Index to(Index edge) const { return input_.polygonPoints[Mesh::next(edge)]; }

  /// Per point in the plane: the features inside the half that end there.
  std::vector<Index> featuresAt() const;

private:
  /// Only triangles with a corner in the plane count.
  void findEdges();
  std::optional<Index> twin(Index edge) const;
  /// The next edge of the boundary, where it is in the plane.
  std::optional<Index> after(Index edge) const;

  const SurfaceInput& input_;
  std::vector<std::uint8_t> inPlane_;
  std::map<std::pair<Index, Index>, Index> edgeBetween_;
  std::vector<Index> inside_;
};

} // namespace quadrille
