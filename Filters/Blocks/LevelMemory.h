// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a remeshing keeps of a block: the levels of its run and its mapped surface.
#pragma once

#include "Blocks/Blocks.h"
#include "Convert/MappedOutput.h"
#include "Pipeline/ResultStore.h"

namespace quadrille
{

/// What a block keeps for its next execution.
struct LevelMemory : BlockMemory
{
  ResultStore levels;
  MappedOutput mapped;
};

} // namespace quadrille
