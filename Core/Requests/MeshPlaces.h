// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where points lie on a mesh.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// A point of a mesh.
struct MeshPlace
{
  Index face = kInvalidIndex;
  Vector3 point = Vector3::Zero();
};

/// The nearest place of the mesh for each point; of faces at the same distance that of the lowest id. Made for few
/// points that lie on the mesh up to rounding: one pass over the faces, in parallel, and another one for points that
/// lie off it. The mesh has a face. threads: 0: all; the result does not depend on it.
std::vector<MeshPlace> placesOnMesh(
  const Mesh& mesh, const std::vector<Vector3>& points, int threads);

/// The place of the face that is nearest to a point.
Vector3 nearestOnFace(const Mesh& mesh, Index f, const Vector3& p);

} // namespace quadrille
