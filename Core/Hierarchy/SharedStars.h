// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Stars that phase 2 remembers for several surfaces: one, and those that a few vertices were added to without a change
/// of shape or features. Nearly all of their stars are the same.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/StarCache.h"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace quadrille
{

/// One phase 2 at a time uses it.
class SharedStars
{
public:
  /// So many vertices, the first ones, are those of all the surfaces.
  explicit SharedStars(Index sharedVertices) : sharedVertices_(sharedVertices) {}

  /// Empty where the stars before were those of another cost.
  StarCache& cacheFor(DecimationCost cost);
  /// What the vertices of a level are called: by the ids that are shared, and else by their places.
  std::vector<Index> namesOf(const Level& level);
  std::size_t bytes() const { return cache_.bytes(); }

private:
  Index sharedVertices_;
  std::map<std::array<double, 3>, Index> added_; ///< names by places
  DecimationCost cost_ = DecimationCost::Gaussian;
  StarCache cache_;
};

} // namespace quadrille
