// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curves that a user draws where lines of the quads' edges should run [Ebke et al. 2016, Section 4: layout
/// constraints]. The course of a curve says which way round irregular vertices, handles and holes the line goes; it is
/// straight in the map, so it follows the curve only about.
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct SurfaceInput;

enum class CurveKind : std::uint8_t
{
  Connection, ///< joins the irregular vertex, or the feature or boundary, nearest to each end
  Cycle       ///< closes on itself, from the last point back to the first
};

struct CurveRequest
{
  CurveKind kind = CurveKind::Connection;
  std::vector<Vector3> points; ///< a polyline on or near the surface; at least 2, of a cycle 3
};

/// "connection 2 from (0, 0, 1) to (1, 0, 0)", "cycle 0 through (0, 0, 1)"; places are those of PlaceText.h.
std::string curveText(const CurveRequest& curve, std::size_t id);

/// Throws InvalidInput, naming the curve by `id`, where it has too few points, a point that is not finite, or no
/// length.
void checkCurve(const CurveRequest& curve, std::size_t id);
/// The same for all of an input. Throws InvalidInput, naming the curve, where one has too few points, a point that is
/// not finite, or no length.
void checkCurves(const SurfaceInput& input);

} // namespace quadrille
