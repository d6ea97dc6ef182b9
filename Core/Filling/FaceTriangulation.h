// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The isotropic triangulation of a face whose triangles are paired to quads: rounds of collapses, splits, flips and
/// relaxation [Botsch and Kobbelt 2004].
#pragma once

#include "Filling/FaceGround.h"
#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

struct FaceTriangles
{
  /// Vertices of the face that are left keep their ids. Removed faces keep their slots (see SurfaceEdit.h). The sources
  /// of the faces say nothing.
  PreparedSurface surface;
  std::vector<Vector3> normals; ///< per vertex: of the face there
};

/// The boundary vertices that are left are the pins; two equilateral triangles of the edge length that is aimed at have
/// the area of the quad that is wanted. Triangles are turned over only where the lines between pins leave no other way.
FaceTriangles triangulateFace(const Mesh& face, const FaceGround& ground);

} // namespace quadrille
