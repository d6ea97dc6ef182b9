// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Phase 1 in the orders of [Ebke et al. 2016], for comparison with the sweeps of UniformDecimation.h: the vertex with
/// the least E_uni next, by a heap (Section 5.3), or the best of a few vertices drawn at random (Section 7).
///
/// Only quadrille-bench and tests ask for them. Guards, end condition and log are those of the sweeps. On one thread;
/// each round of the log is one block.
#pragma once

#include "Hierarchy/UniformDecimation.h"

namespace quadrille
{

/// Decimates in the exact order of E_uni: the shortest edge at a vertex.
void decimateByHeap(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log);

/// Draws vertices and removes the one with the least E_uni of each draw, as long as there are at least
/// draws.exactBelow vertices and draws find any; then decimateByHeap().
void decimateByDraws(
  DecimationMesh& mesh, const UniformOptions& options, const RandomDraws& draws, LogBuilder& log);

} // namespace quadrille
