// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All runs of the pipeline that a state of a session needs.
#pragma once

#include "Session/SessionData.h"

#include <memory>

namespace quadrille
{

/// What the runs of one state have made; null where they were stopped, with the status that says so.
struct MadeState
{
  std::shared_ptr<SessionResult> result;
  Status stopped;
};

MadeState runState(SessionData& data, const SessionState& state, bool isPreview = false);

} // namespace quadrille
