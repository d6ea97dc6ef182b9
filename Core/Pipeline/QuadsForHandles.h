// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether a surface has more handles and holes than quads of the size that was asked for can go round.
#pragma once

#include "Base/Error.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SizedSurface.h"

namespace quadrille
{

/// A surface with more handles and holes than so many quads can go round ends in minutes of attempts that fail:
/// Infeasible, with the place. isCut: whether what can be simplified was. What is ok is kept in the store, if any.
Status judgeHandles(const SizedSurface& sized, bool isCut, int threads, ResultStore* store);

} // namespace quadrille
