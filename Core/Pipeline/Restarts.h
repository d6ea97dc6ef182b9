// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How attempts begin again where none has had quads.
#pragma once

#include "Pipeline/History.h"
#include "Pipeline/SettledSurface.h"

#include <optional>

namespace quadrille
{

struct Restart
{
  Plan plan;
  History history;       ///< of the attempts to come
  Try what;              ///< is tried by it, beside what has made the plan
  bool isCounted = true; ///< false: nothing else than that plan is otherwise
};

/// Of all attempts at a surface, before any has failed.
WorkBound boundOf(const SizedSurface& sized);

/// The first attempts. What is left of the bound is for those without details that were left.
History firstHistory(
  const Settled& settled, const SizedSurface& sized, const RemeshOptions& options);

/// Without the details that were left for attempts to resolve. Where all would fail again but the last resort, on the
/// same surface, or where features alone leave no area to so many triangles, that comes first. None where nothing would
/// end otherwise. first: of the settled surface, before and afterwards.
std::optional<Restart> withoutRest(Settled& settled, SizedSurface& sized,
  const RemeshOptions& options, ResultStore* store, Plan& first, const History& before);

} // namespace quadrille
