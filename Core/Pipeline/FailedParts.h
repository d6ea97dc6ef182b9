// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What of a surface a run has made no quads of.
#pragma once

#include "Base/Types.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

/// All of the surface where the status is not ok, else the connected components that were left out.
struct FailedParts
{
  std::vector<Vector3> places; ///< on the surface, where the map or the quads have failed
  std::size_t components = 0;  ///< left out as they have no map; 0 where the status is not ok
  std::size_t ofComponents = 0;
  double share = 0;            ///< of the area over the sizes, of those that were left out
  std::vector<Index> polygons; ///< of the input, of those components; ascending
  std::string why;             ///< the message of the attempts that had no quads for them

  /// "1 of 82 connected components, with 3 % of the area".
  std::string countText() const;
  /// "<why>; <count> has no quads and was left out"; empty where none was left out.
  std::string text() const;
  /// Why what was asked for cannot be: more components have no quads than the `without` that had none without it.
  /// Empty where there are no more.
  std::string lostText(std::size_t without) const;
};

} // namespace quadrille
