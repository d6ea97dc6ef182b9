// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Topology and element quality of a quad mesh, for reports and tests.
#pragma once

#include "Base/Types.h"

#include <array>
#include <map>
#include <vector>

namespace quadrille
{

struct Statistics
{
  double minimum = 0;
  double mean = 0;
  double maximum = 0;
  double deviation = 0; ///< standard deviation of the population
};

struct QuadQuality
{
  std::size_t quads = 0;
  std::size_t vertices = 0; ///< used by a quad
  std::size_t edges = 0;
  std::size_t components = 0;
  std::size_t boundaryLoops = 0; ///< 0 where the mesh is no manifold: then they are not defined
  long long eulerCharacteristic = 0;
  bool manifold = false; ///< consistent orientation included
  bool closed = false;

  std::map<int, std::size_t> interiorValences; ///< number of interior vertices per valence
  std::size_t irregularVertices = 0;           ///< interior ones with a valence other than 4

  Statistics scaledJacobian;            ///< per quad, see scaledJacobian()
  std::size_t nonPositiveJacobians = 0; ///< quads with scaled Jacobian <= 0
  Statistics edgeLength;
  Statistics area; ///< per quad, of its two triangles at the diagonal from corner 0
};

/// Linear in quads. Throws InvalidInput for a corner beyond the points.
QuadQuality evaluateQuads(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads);

} // namespace quadrille
