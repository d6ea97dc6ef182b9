// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which faces of a surface strokes guide.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// The faces that strokes cross, and those within a quarter of a quad of their radii, as quads across the border turn
/// only as far as what they lie on; each with the direction of the nearest part of the path, which is straight in
/// each face from one of the stroke's points to the next, see pathOnMesh; ascending by face. A part between two
/// points on different components is left out. Where strokes overlap that of the highest order counts, then the later
/// one. edgeLength: of quads where the size is 1. threads: 0: all; the result does not depend on it.
std::vector<StrokeFace> facesOfStrokes(
  const Mesh& mesh, const std::vector<StrokeRequest>& strokes, double edgeLength, int threads);

} // namespace quadrille
