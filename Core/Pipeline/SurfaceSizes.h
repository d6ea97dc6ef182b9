// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes that the shape of a surface asks for, while it is sized.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Pipeline/SizedSurface.h"

#include <string>

namespace quadrille
{

/// The area over the sizes, where there are any.
double areaOverSizes(const PreparedSurface& surface);

/// Sizes that the shape of the surface asks for. Where a number of quads is asked for, the edge length is the one
/// with which they make as many, and the lengths that the shape asks for stay what they are.
/// sized: its edge length, number of quads and stages change. Returns what to tell of the sizes.
std::string adaptSizes(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized);

} // namespace quadrille
