// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where strokes run on a surface, and which faces they guide.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

struct PlacedStrokes
{
  /// Of each stroke: straight in each face, from one of its points to the next, see pathOnMesh. A part between two
  /// points on different components is left out.
  std::vector<std::vector<Vector3>> paths;
  /// The faces that strokes cross, and those within their radii, each with the direction of the nearest part of the
  /// path; ascending by face. Where strokes overlap that of the highest order counts, then the later one.
  std::vector<StrokeFace> faces;
};

/// threads: 0: all; the result does not depend on it.
PlacedStrokes strokesOnMesh(
  const Mesh& mesh, const std::vector<StrokeRequest>& strokes, int threads);

} // namespace quadrille
