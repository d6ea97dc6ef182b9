// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Stars that phase 2 remembers for several surfaces: one, and those that a few vertices and features were added to
/// without a change of shape. Nearly all of their stars are the same.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/OwnVertices.h"
#include "Hierarchy/StarCache.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace quadrille
{

/// One phase 2 at a time uses it.
class SharedStars
{
public:
  /// Empty where the stars before were those of another cost.
  StarCache& cacheFor(DecimationCost cost);
  /// What the vertices of a level are called: by the ids that are shared, and else by their places and the features of
  /// their surface.
  std::vector<Index> namesOf(const Level& level, const OwnVertices& own);
  std::size_t bytes() const { return cache_.bytes(); }

private:
  std::map<std::pair<std::uint64_t, std::array<double, 3>>, Index>
    added_; ///< names by features and places
  DecimationCost cost_ = DecimationCost::Gaussian;
  StarCache cache_;
};

} // namespace quadrille
