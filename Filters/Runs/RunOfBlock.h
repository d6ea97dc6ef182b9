// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All that a run made of one block, on its way to the outputs.
#pragma once

#include "Constraints/Constraints.h"
#include "Convert/PolyData.h"
#include "Pieces/RemeshInPieces.h"
#include "Pipeline/Pipeline.h"
#include "Symmetry/Symmetry.h"

namespace quadrille
{

/// What is written of one block.
struct RunOfBlock
{
  const ConvertedSurface& converted;
  const AskedConstraints& asked;
  const RemeshResult& result;
  const SymmetricResult* symmetric; ///< null where nothing symmetric was asked for
  const PiecesResult* pieces;       ///< null where the surface was not cut
};

} // namespace quadrille
