// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which irregular vertices of a result are those that operations lead to.
#pragma once

#include "Session/Constraints.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

struct IrregularMatch
{
  std::vector<std::optional<std::size_t>> actual; ///< of each expected one
  std::vector<std::size_t> unexpected;            ///< of the actual ones, ascending
};

/// Pairs of the same valence at most `reach` apart, the nearest ones first, each vertex in one pair at most.
IrregularMatch matchIrregular(const std::vector<IrregularVertex>& expected,
  const std::vector<IrregularVertex>& actual, double reach);

/// The same of vertices on features and boundaries, by the turns of their sectors together: places of those of either
/// list that have no partner.
std::vector<Vector3> differencesOnFeatures(
  const std::vector<HeldVertex>& expected, const std::vector<HeldVertex>& actual, double reach);

} // namespace quadrille
