// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the arrays of a surface ask for, taken down before what is drawn beside it is added.
#pragma once

#include "Requests/DrawnConstraints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace quadrille
{

/// What the arrays of the surface ask for, as the user gave it.
struct ArrayConstraints
{
  struct Region
  {
    std::int64_t firstCell = 0;
    std::vector<Index> polygons; ///< ascending
    std::vector<GuidedPlace>
      measured; ///< some of them, evenly spread, where they are many; ascending
  };
  struct Curve
  {
    std::int64_t firstPoint = 0;
    std::vector<std::array<Vector3, 2>> edges;
  };
  struct Valence
  {
    std::int64_t point = 0;
    Vector3 place = Vector3::Zero();
    int asked = 0;
    bool isUsed = false; ///< by a polygon
  };
  std::vector<Region> guides; ///< connected by points
  std::vector<Curve> curves;  ///< connected edges of FeatureEdges
  std::vector<Valence> valences;
  bool sizes = false;
};

/// Of a surface to which no drawn constraint was added. cellOf: the user's cell of a polygon; empty: the same number.
ArrayConstraints arrayConstraints(
  const SurfaceInput& input, const std::function<std::int64_t(Index)>& cellOf = {});

} // namespace quadrille
