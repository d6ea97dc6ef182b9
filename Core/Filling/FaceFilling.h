// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads for one face of a body whose boundary is given, without a map. It is the answer that always exists: a face
/// can be filled with quads whenever its boundary has an even number of edges. Its shapes are those of paired
/// triangles, so a map is to be asked first.
#pragma once

#include "Mesh/Mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

struct FaceFill
{
  std::vector<Vector3> points;   ///< inner points; point i has the id mesh.vertexCount() + i
  std::vector<Index> sourceFace; ///< per inner point: face of the mesh
  std::vector<std::array<double, 3>> sourceWeights; ///< per inner point: barycentric in it
  /// Of vertices of the mesh that are pins, and inner points; counterclockwise like the faces.
  std::vector<std::array<Index, 4>> quads;
};

/// Pairs the triangles of an isotropic triangulation [Botsch and Kobbelt 2004] and raises the shapes of the quads.
/// face: a connected manifold with at least one boundary loop; several loops are holes, and it may have handles.
/// isPin: #V, 1 for the vertices of the boundary that the quads have (only boundary vertices are pins). The boundary
/// edges of the quads join consecutive pins of each loop. Each loop has at least 3 pins, all loops together an even
/// number, and 4 at least.
/// edgeLength: that the quads should have, > 0, in units of the mesh; times the face's sizes where it has some (see
/// Mesh/Sizing.h). Near pins that stand closer together the quads are smaller.
/// A disc with 4 pins becomes one quad, if that is not turned over. None where the pins or the face are not as said, or where all of the face has
/// no area. The quads are always a manifold with the face's Euler characteristic. They may be turned over where pins
/// are so far apart that the lines between them cross, as across a slot that is narrower than they are apart.
std::optional<FaceFill> fillFace(
  const Mesh& face, const std::vector<std::uint8_t>& isPin, double edgeLength);

} // namespace quadrille
