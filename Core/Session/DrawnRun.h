// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads with what is drawn on a surface. Where they cannot be made, or more connected components have none than
/// without it, what cannot be met together with all that was drawn before it is left out, as in a session.
#pragma once

#include "Session/Moves.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Of rows 0 to count - 1, those before each of `count` constraints: the last constraint of the shortest row that
/// fails; none where the empty one does, too. fails: whether the first `n` fail together.
template <typename Fails>
std::optional<std::size_t> lastOfShortestFailing(std::size_t count, const Fails& fails)
{
  while (count-- > 0)
  {
    if (!fails(count))
    {
      return count;
    }
  }
  return std::nullopt;
}

/// Why a constraint is left out. before: how many are before it, whose names nameOf(i) gives; reason: of the run with
/// them and it.
template <typename NameOf>
std::string cannotBeMet(std::size_t before, const NameOf& nameOf, const std::string& reason)
{
  std::string others;
  for (std::size_t i = 0; i < before; ++i)
  {
    others += (i == 0 ? " together with " : ", ") + nameOf(i);
  }
  return "it cannot be met" + others + ": " + reason;
}

/// The input without what these ask for. isLeftOut: of each placed one. placed: of the others the curve becomes its
/// place in the result.
SurfaceInput withoutDrawn(const SurfaceInput& input, const std::vector<bool>& isLeftOut,
  std::vector<PlacedConstraint>& placed);

/// As remeshWithMoves, also where nothing is moved. placed: also gets whyNot of what is left out.
UncutResult remeshWithDrawn(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, const KnownOfMoves& known, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices);

} // namespace quadrille
