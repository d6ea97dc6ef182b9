// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way of a run into its frame (see Prepare/Frame.h), which a store makes short: of points and polygons that it
/// knows no coordinate is looked at again.
#pragma once

#include "Pipeline/SizedSurface.h"
#include "Prepare/Frame.h"

namespace quadrille
{

struct EnteredInput
{
  FramedInput framed; ///< without points in the frame where the store has the prepared surface
  KnownInput known;   ///< for sizeSurface
};

/// Throws InvalidInput as checkInput does.
EnteredInput enterFrame(SurfaceInput input, const RemeshOptions& options, ResultStore* store);

} // namespace quadrille
