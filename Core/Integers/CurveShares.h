// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What curves that bend ask of whole numbers: rounded to the nearest, a quarter of a circle that is 1.4 quads long
/// would get one edge, and its hole would be a square.
#pragma once

#include "CrossField/CrossField.h"
#include "Integers/IntegerMap.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// #H of `decimated`, a seamless map of the mesh without some of its vertices: what an edge of a curve should get, so
/// that quads stay near the curve (see quadsAlongCurves). seamlessUv: #H of the mesh, whose isolines lie as those of
/// the decimated map. edgeLength: s, in units of the mesh.
std::vector<CurveShare> sharesOfCurves(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, double edgeLength, const UvMesh& decimated);

} // namespace quadrille
