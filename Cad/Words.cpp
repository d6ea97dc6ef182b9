// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Tessellation.h"

namespace quadrille
{

const char* wordOf(CadEdgeKind kind)
{
  static constexpr std::array<const char*, 6> kWords{ "sharp", "tangent", "seam", "free", "pole",
    "wire" };
  return kWords[static_cast<std::size_t>(kind)];
}

const char* wordOf(CadSurfaceKind kind)
{
  static constexpr std::array<const char*, 11> kWords{ "plane", "cylinder", "cone", "sphere",
    "torus", "bezier", "spline", "revolution", "extrusion", "offset", "other" };
  return kWords[static_cast<std::size_t>(kind)];
}

} // namespace quadrille
