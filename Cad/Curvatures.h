// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curvatures of exact surfaces and curves. Only the sources of Cad include this, and with it Open CASCADE.
#pragma once

#include "Base/Types.h"
#include "Cad/Shape.h"
#include "Cad/Tessellation.h"

#include <Adaptor3d_Surface.hxx>

#include <array>
#include <optional>

namespace quadrille
{

struct SurfaceBend
{
  Vector3 normal = Vector3::Zero(); ///< unit, that of the two parameters
  /// The larger and the smaller one, 1 over the unit of the shape, positive where it bends towards the normal.
  std::array<double, 2> curvatures{};
};

/// None where the surface has no normal, as at a pole.
std::optional<SurfaceBend> bendOf(const Adaptor3d_Surface& surface, const Vector2& uv);

/// Fills CadSurface::curvatures and CadEdge::curvatures. surface: of tessellate(shape), with any options.
void addCurvatures(const CadShape& shape, CadSurface& surface);

} // namespace quadrille
