// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All that a run made of one block, on its way to the outputs.
#pragma once

#include "Constraints/Constraints.h"
#include "Convert/PolyData.h"
#include "Ways/Ways.h"

namespace quadrille
{

/// What is written of one block.
struct RunOfBlock
{
  const ConvertedSurface& converted;
  const AskedConstraints& asked;
  const QuadsMade& made;
};

} // namespace quadrille
