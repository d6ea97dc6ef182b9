// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Straight paths between places of a mesh.
#pragma once

#include "Requests/MeshPlaces.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

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

struct MeshCourse
{
  std::vector<Vector3> points;  ///< the polyline's, and where it passes from face to face
  std::vector<std::size_t> own; ///< of each of the polyline's points: its place there
  /// Of the polyline's points those that lie on another component than the next one; the course is straight between
  /// them.
  std::vector<std::size_t> tornBehind;

  /// Those on each component, from one tear to the next, that have a length.
  std::vector<std::vector<Vector3>> parts() const;
};

/// By paths from each point of a polyline near the mesh to the next.
MeshCourse courseOnMesh(const Mesh& mesh, const std::vector<Vector3>& points, int threads = 1);

} // namespace quadrille
