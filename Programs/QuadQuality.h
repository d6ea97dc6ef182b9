// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Element quality and irregular vertices of a quad mesh, for reports.
#pragma once

#include <cstddef>
#include <map>

class vtkPolyData;

namespace quadrille
{

struct QuadQuality
{
  double meanScaledJacobian = 0;
  double minimumScaledJacobian = 0;
  std::size_t notPositive = 0;       ///< quads with a scaled Jacobian <= 0
  std::size_t irregularVertices = 0; ///< interior with valence other than 4, boundary other than 3
  std::size_t irregularOther = 0;    ///< interior irregular ones of valence other than 3 and 5
  std::map<int, std::size_t> valences; ///< of interior vertices
  double meanEdgeLength = 0;
};

/// The scaled Jacobian is Verdict's: the least over the corners of n . (e1 x e2) / (|e1| |e2|) with n the
/// normal at the quad's centre. Needs the point arrays Valence and OnBoundary.
QuadQuality measureQuads(vtkPolyData* quads);

} // namespace quadrille
