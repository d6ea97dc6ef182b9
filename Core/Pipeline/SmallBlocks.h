// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Components with less area than a closed block of quads, left out while the surface is sized.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Pipeline/SizedSurface.h"

#include <string>

namespace quadrille
{

/// On request, or where their blocks alone would be more quads than are asked for; before anything depends on them.
/// sized: its details tell them. Returns what to tell; empty where none was left out.
std::string dropSmallComponents(
  PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized);

} // namespace quadrille
