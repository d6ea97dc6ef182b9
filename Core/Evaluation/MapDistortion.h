// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How far a map is from an isometry of the surface, up to one scale for all of it; where the surface asks for sizes,
/// lengths on it are taken over them.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// Means are over the area of the triangles with a positive determinant and an area. With the singular values a, b of
/// the Jacobian:
struct MapDistortion
{
  double mean =
    0; ///< of (a^2 + b^2 + 1/a^2 + 1/b^2) / 4, the symmetric Dirichlet energy; 1 for an isometry
  double median =
    0; ///< of the same, over the area; and where nine tenths and 99 hundredths of the area lie below
  double p90 = 0;
  double p99 = 0;
  double angle = 0;     ///< mean of (a/b + b/a) / 2; 1 where the map keeps angles
  double size = 0;      ///< mean of |log2(a b)|; 0 where the map keeps areas
  std::size_t left = 0; ///< triangles that are not counted
};

/// uv: #H. The scale is that of the whole mapped area. Throws InvalidInput when sizes disagree.
MapDistortion measureDistortion(const Mesh& mesh, const std::vector<FixedVec2>& uv);

} // namespace quadrille
