// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// E_G, by which phase 2 orders the removals [Ebke et al. 2016, Section 5.1]: how much Gaussian curvature one of them
/// changes.
///
///   E_G(v)     = |K(v)| + sum over the ring vertices w of |K'(w) - K(w)|
///   E_G,mem(v) = |K0(v)| + sum over the ring vertices w of |K'(w) - K0(w)|
///
/// K: angle defect on the current mesh, K': after the removal, K0: on the input. The defect of a vertex is 2 pi, on the
/// boundary pi, less its angles. Curvature does not vanish: by the theorem of Gauss and Bonnet what leaves v arrives at
/// its ring, so E_G is at least 2 |K(v)|.
///
/// Where we differ: at vertices of a feature curve, and of a ring that one passes, the defect is taken on each side of
/// it apart, against pi, so that a sharp edge does not count as curvature.
#pragma once

#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/VertexRemoval.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// #V, radians: 2 pi, or pi on the boundary, less the sum of angles; 0 at vertices without faces, like removed ones.
std::vector<float> angleDefects(const Mesh& mesh);
std::vector<float> angleDefects(const DecimationMesh& mesh);

/// E_G in radians of a planned removal, whose change was measured; ringSize: number of its ring vertices.
double gaussianCurvatureCost(const VertexRemoval::Change& change, int ringSize);

} // namespace quadrille
