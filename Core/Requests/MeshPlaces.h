// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where points lie on a mesh, and straight paths between such places.
#pragma once

#include "Mesh/Mesh.h"

#include <array>
#include <optional>
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

/// A path leaves a face over an edge.
struct EdgeCrossing
{
  Index halfEdge = kInvalidIndex; ///< of the face that the path leaves
  double share = 0;               ///< of the edge, from the origin of the half-edge; in [0, 1]

  Vector3 point(const Mesh& mesh) const
  {
    return mesh.position[mesh.origin[halfEdge]] + share * mesh.edgeVector(halfEdge);
  }
};

struct MeshPath
{
  Index face = kInvalidIndex; ///< in which it begins
  std::vector<EdgeCrossing> crossings;
};

/// The path from one place to another: straight in each face and, where faces are laid out side by side in the plane,
/// from face to face. It begins with the faces along which the straight segment in space is nearest, found by the A*
/// algorithm [Hart, Nilsson, Raphael 1968]; in them it is the shortest one [Lee, Preparata 1984], and they give way
/// where another side of a vertex makes it shorter [Xin, Wang 2007]. None where the places are on different components.
std::optional<MeshPath> pathOnMesh(const Mesh& mesh, const MeshPlace& from, const MeshPlace& to);

} // namespace quadrille
