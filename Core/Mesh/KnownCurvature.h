// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curvatures that are known where the triangles of a surface would only show them roughly, as those of a CAD file.
#pragma once

#include "Base/Types.h"

#include <array>
#include <limits>

namespace quadrille
{

/// Of the exact surface that a triangle of the input stands for; 1 over the units of the points. NaN: not known.
struct KnownCurvature
{
  /// Of the input, at the corners; prepareSurface sets them.
  std::array<Index, 3> points{ kInvalidIndex, kInvalidIndex, kInvalidIndex };
  std::array<float, 3> atCorner{};  ///< the largest absolute normal curvature there, >= 0
  std::array<float, 3> alongSide{}; ///< of the curve from a corner to the next one, >= 0
};

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
constexpr KnownCurvature kNoCurvature{ { kInvalidIndex, kInvalidIndex, kInvalidIndex },
  { kNotKnown, kNotKnown, kNotKnown }, { kNotKnown, kNotKnown, kNotKnown } };

} // namespace quadrille
