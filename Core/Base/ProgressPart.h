// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A stage reports its own fraction; whoever calls it knows what part of all that is.
#pragma once

#include "Base/Progress.h"

#include <string>

namespace quadrille
{

/// The callback for a stage that is the part [begin, end] of all, whose texts get a prefix. A fraction outside of [0, 1] counts as the
/// nearest one in it. Empty where `progress` is.
ProgressCallback progressPart(
  const ProgressCallback& progress, double begin, double end, const std::string& prefix = {});

} // namespace quadrille
