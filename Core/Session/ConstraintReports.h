// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A word on each constraint of a session, measured in the quads.
#pragma once

#include "Session/ComposedInput.h"
#include "Session/Session.h"
#include "Symmetry/Symmetry.h"

#include <vector>

namespace quadrille
{

/// made: for the composed input; without quads where there are none. result: irregular vertices, also those on
/// features, are those that were made. isOfNumber: a number of quads was asked for, so that sizes count against the
/// number that there is.
std::vector<ConstraintReport> reportConstraints(const SurfaceInput& surface,
  const SurfacePlaces& places, const SessionConstraints& constraints, const ComposedInput& composed,
  const RemeshResult& made, const SessionResult& result, const SymmetricResult* symmetric,
  bool isOfNumber);

} // namespace quadrille
