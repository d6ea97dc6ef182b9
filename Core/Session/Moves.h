// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Moves of irregular vertices that are drawn: they need the quads without them, in which the vertices are found.
#pragma once

#include "Pieces/RemeshInPieces.h"
#include "Pipeline/ResultStore.h"
#include "Prepare/InputPlaces.h"
#include "Requests/DrawnConstraints.h"
#include "Symmetry/Symmetry.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Of a surface in one piece.
struct UncutResult : SymmetricResult
{
  std::optional<MadeThinning> thinning; ///< where the surface was thinned out
};

/// remesh(), remeshSymmetric() or remeshThinned().
using RemeshRun = std::function<UncutResult(SurfaceInput, const RemeshOptions&)>;

bool asksForMoves(const std::vector<PlacedConstraint>& placed);

/// Of how many connected components of an input have no quads.
ResultKey keyOfFailed(const SurfaceInput& input, const RemeshOptions& options);

/// What earlier calls have found out, all of it of this input.
struct KnownOfMoves
{
  ResultStore* store =
    nullptr; ///< of the run; null: none, as the run depends on more than input and options
  const InputPlaces* places = nullptr; ///< null: none
};

/// Makes the quads of the input, finds the irregular vertex nearest to the begin of each move, and makes the quads with
/// it at the end instead; all other irregular vertices stay where they are. The moves are done in their order, each in
/// what those before it have left. Those that cannot be met, together with what else is asked for, or with which more
/// connected components have no quads than without moves, are left out, the last one first.
/// placed: of its moves the path becomes the vertex's old place and its new one, the place of the surface nearest to
/// what was drawn or that of another vertex shown there, and they get the valence that is to be there and all irregular
/// vertices; or whyNot. notices: what is not done.
UncutResult remeshWithMoves(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, const KnownOfMoves& known, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices);

} // namespace quadrille
