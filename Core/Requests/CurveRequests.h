// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curves that a user draws where lines of the quads' edges should run [Ebke et al. 2016, Section 4: layout
/// constraints].
#pragma once

#include "Mesh/Requests.h"

#include <cstddef>
#include <string>

namespace quadrille
{

struct SurfaceInput;

/// "connection 2 from (0, 0, 1) to (1, 0, 0)", "cycle 0 through (0, 0, 1)"; places are those of PlaceText.h.
std::string curveText(const CurveRequest& curve, std::size_t id);

/// Throws InvalidInput, naming the curve by `id`, where it has too few points, a point that is not finite, or no
/// length.
void checkCurve(const CurveRequest& curve, std::size_t id);
/// The same for all of an input. Throws InvalidInput, naming the curve, where one has too few points, a point that is
/// not finite, or no length.
void checkCurves(const SurfaceInput& input);

} // namespace quadrille
