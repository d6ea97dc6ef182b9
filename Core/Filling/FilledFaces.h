// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads for faces without a map: points along the curves round them, then each face by itself.
#pragma once

#include "Filling/FaceCurves.h"
#include "Filling/FaceFilling.h"
#include "Quads/QuadMesh.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

struct FilledFaces
{
  /// Points: those given, in their order, then others. Quads have no place in a map, so that quadSourceWeights are
  /// zero. Lines: along all curves, those that were given are on no boundary.
  QuadMesh quads;
  std::vector<Vector3> failedAt; ///< in faces that could not be filled; empty where all is well
};

/// The numbers of the curves must have been chosen, and all faces be even. A face between two edges that lie on each
/// other gets no quads. quadsOf: see fillFace.
FilledFaces fillFaces(
  const Mesh& mesh, const FaceCurves& curves, double edgeLength, const QuadsOfFace& quadsOf = {});

} // namespace quadrille
