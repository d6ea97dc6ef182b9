// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A start for mending a patch of the map round an irregular vertex, from which the vertex keeps its turns.
///
/// A map of positive triangles may still wind wrongly: where the irregular vertex has to stay beside the place that its
/// surroundings would give it, the minimization may leave it with turns too few, and a regular one near it with as many
/// too many. The power w = z^(4/turns) about the irregular vertex makes of the patch's image a disc of the plane in
/// which nothing can wind wrongly: a map into a disc whose border winds once has no branch point where all triangles are
/// positive. So the patch is made valid there, and brought back by the inverse power.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace quadrille
{

struct ConePatch
{
  const Mesh& mesh;
  const std::vector<FixedVec2>&
    uv; ///< #H; its transitions are right everywhere, its triangles at the border positive
  const std::vector<Index>&
    faces; ///< ascending; no feature edge and no other irregular vertex inside, no boundary
  Index cone = kInvalidIndex; ///< inside
  int turns = 4;              ///< quarter turns round it, >= 1
};

struct ConeStart
{
  /// 3 per face of the patch: a place in the chart of the face, in quads. The border and the cone are where they were.
  /// Empty where the patch is no disc, where its border does not wind round the cone as it should, or where no valid
  /// map into the disc was found.
  std::vector<Vector2> places;
  int steps = 0; ///< of the untangler
};

/// maximumSteps: of the untangler. Deterministic.
ConeStart startRoundCone(const ConePatch& patch, int maximumSteps);

/// The edges [b - a, c - a] of an equilateral triangle.
Eigen::Matrix2d equilateral(double side);
/// Area of one of side 1.
constexpr double kEquilateralArea = 0.4330127018922193;

} // namespace quadrille
