// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which collapses a level of a patch may do, and what they cost.
#pragma once

#include "Transfer/LevelMesh.h"

#include <cstddef>
#include <optional>
#include <utility>

namespace quadrille
{

/// Of the level as it is whenever one is asked for.
class CollapseCosts
{
public:
  explicit CollapseCosts(const LevelMesh& mesh) : mesh_(mesh) {}

  /// The cost and the half-edge from v that is collapsed for least; none where v stays.
  std::optional<std::pair<double, Index>> best(Index v) const;

private:
  std::size_t sectorWithout(Index v, Index without) const;
  std::optional<double> costOf(Index h) const;

  const LevelMesh& mesh_;
};

} // namespace quadrille
