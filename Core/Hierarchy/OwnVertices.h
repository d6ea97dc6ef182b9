// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The vertices that a surface does not have in common with the one it was made of.
#pragma once

#include "Mesh/Mesh.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Of a surface that vertices and features were added to.
struct OwnVertices
{
  Index shared = 0;           ///< so many vertices, the first ones, are those of both
  std::vector<Index> changed; ///< of these the ones whose features are others, ascending
  std::uint64_t features = 0; ///< names the features that were added; 0: none

  bool contains(Index v) const
  {
    return v >= shared || std::binary_search(changed.begin(), changed.end(), v);
  }
};

} // namespace quadrille
