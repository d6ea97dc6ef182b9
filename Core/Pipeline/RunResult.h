// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What of the parts of a run becomes its result, and is told.
#pragma once

#include "Pipeline/History.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/SettledSurface.h"
#include "Pipeline/SizedSurface.h"

namespace quadrille
{

/// Of the sized surface, before small details are looked for.
void takeSized(const SizedSurface& sized, RemeshResult& result);

/// Components that became blocks.
void takeBlocks(const SizedSurface& sized, RemeshResult& result);

/// What was found of small details, and what that took.
void takeDetails(const Settled& settled, RemeshResult& result);

/// The attempt that counts, and what all of them took. The surface of `sized` is the one that it has mapped.
/// quadsAlone: the map on the surface may stay packed.
void takeAttempts(const History& history, RunContext& run, const Frame& frame,
  const RemeshOptions& options, bool quadsAlone, SizedSurface& sized, RemeshResult& result);

/// Charts of the map and its anisotropy, where they are asked for.
void measureMap(const Mesh& mesh, const RemeshOptions& options, RemeshResult& result);

/// Brings the result to the user's surface. quadsAlone: without the mapped mesh.
void putOnUserSurface(SizedSurface& sized, const FramedInput& framed, const RemeshOptions& options,
  bool quadsAlone, RemeshResult& result);

} // namespace quadrille
