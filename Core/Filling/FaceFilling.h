// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads for one face of a body whose boundary is given, without a map. It is the answer that always exists: a face
/// can be filled with quads whenever its boundary has an even number of edges. Where the face has quads by itself, as
/// of a map of its own, they are made to fit; else its shapes are those of paired triangles.
#pragma once

#include "Mesh/Mesh.h"
#include "Quads/QuadMesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace quadrille
{

/// Quads that a face has by itself, with points of their own on its boundary, see fitBoundary; without any where it has
/// none. Its sizes are those that its pins ask for, too.
using QuadsOfFace = std::function<QuadMesh(const Mesh& face)>;

struct FaceFill
{
  std::vector<Vector3> points;   ///< inner points; point i has the id mesh.vertexCount() + i
  std::vector<Index> sourceFace; ///< per inner point: face of the mesh
  std::vector<std::array<double, 3>> sourceWeights; ///< per inner point: barycentric in it
  /// Of vertices of the mesh that are pins, and inner points; counterclockwise like the faces.
  std::vector<std::array<Index, 4>> quads;
};

/// Pairs the triangles of an isotropic triangulation [Botsch and Kobbelt 2004] and improves the quads by local changes
/// and smoothing. One thread; the same bytes each time.
/// face: a connected manifold without isolated vertices and with at least one boundary loop; several loops are holes,
/// and it may have handles.
/// isPin: #V, 1 for the vertices of the boundary that the quads have (only boundary vertices are pins). The boundary
/// edges of the quads join consecutive pins of each loop. Each loop has at least 3 pins, all loops together an even
/// number, and 4 at least.
/// edgeLength: that the quads should have, > 0, in units of the mesh; times the face's sizes where it has some (see
/// Mesh/Sizing.h). Edges come to be about a twentieth shorter. Near pins that stand closer together the quads are
/// smaller.
/// A disc with 4 pins becomes one quad, if that is not turned over.
/// quadsOf: empty, or tried first.
/// None where the face or the pins are not as said. Else there is an answer: the quads are a manifold with the face's
/// Euler characteristic, and that is checked. Single quads may be turned over where pins stand several edge lengths
/// apart on a curved boundary, so that the lines between them leave the face.
std::optional<FaceFill> fillFace(const Mesh& face, const std::vector<std::uint8_t>& isPin,
  double edgeLength, const QuadsOfFace& quadsOf = {});

} // namespace quadrille
