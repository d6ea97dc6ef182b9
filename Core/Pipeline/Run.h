// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run by its parts, for those who begin with another surface than that of the input: the sized surface to the quads
/// in the frame, and these to the user's surface.
#pragma once

#include "Base/PlaceText.h"
#include "Pipeline/Options.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/Frame.h"

#include <functional>

namespace quadrille
{

/// What a run does once there is the memory for it. store: null also where there is no room for both it and the run;
/// places: to be set to the frame.
using RunBody = std::function<void(
  const RemeshOptions& options, ResultStore* store, PlaceScope& places, RemeshResult& result)>;

/// Checks the options, estimates the cost, and calls `run` where there is the memory for it. A stop on request before
/// there are quads is the status Cancelled. Throws InvalidInput.
RemeshResult guardedRun(
  const SurfaceInput& input, RemeshOptions options, ResultStore* store, const RunBody& run);

/// The options with lengths in the frame.
RemeshOptions optionsInFrame(RemeshOptions options, const Frame& frame);

/// From the sized surface to the result in the frame. options: in the frame. quadsAlone: without the mapped mesh.
void remeshSized(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store, bool quadsAlone, RemeshResult& result);

} // namespace quadrille
