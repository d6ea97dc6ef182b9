// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Faces near others, reached over the surface: a sheet close by is none of them.
#pragma once

#include "Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace quadrille
{

/// Where a front begins: a face, and the place that distances are taken from, up to `reach`.
struct SpreadStart
{
  Index face = kInvalidIndex;
  Vector3 from = Vector3::Zero();
  double reach = 0;
};

/// Lets all fronts spread at once through the half-edges that `mayCross` (asked inside of the boundary only), the
/// nearest middle of a face first. #F: the place in `starts` of the front that has reached the face, or kInvalidIndex.
std::vector<Index> spreadOverFaces(const Mesh& mesh, const std::vector<SpreadStart>& starts,
  const std::function<bool(Index)>& mayCross);

} // namespace quadrille
