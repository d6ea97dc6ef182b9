// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Half of a surface, its map and its quads together with their mirror images. What is in the plane is there once, by
/// identity and not by distance: along the edges where the half was cut, it and its image are one.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Extraction/Extraction.h"
#include "Symmetry/MirrorPlane.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Images come behind: face f of the half has the image #F + f, whose corners 0 1 2 are the images of its corners
/// 0 2 1, see reversedCorner.
struct DoubledMesh
{
  Mesh mesh;
  Index halfVertices = 0, halfFaces = 0;
  std::vector<Index> image; ///< per vertex of `mesh`; of those in the plane they themselves
  std::vector<std::uint8_t> isGlued; ///< per half-edge of the half: a boundary in the plane

  Index imageOfCorner(Index h) const;
};
/// Boundary edges with both ends within `tolerance` of the plane are glued, and these ends put into it.
DoubledMesh doubleMesh(const Mesh& half, const MirrorPlane& plane, double tolerance);

/// The map of the doubled mesh: in the images u and v are exchanged, so that triangles stay positive and the boundary
/// in the plane, an isoline, has the same one on both sides, with a transition by a quarter turn.
std::vector<FixedVec2> doubleMap(const DoubledMesh& doubled, std::vector<FixedVec2> uv);
/// Its turns; those of both sides in the plane.
std::vector<int> doubleTurns(const DoubledMesh& doubled, const std::vector<int>& turns);

/// Valences and boundary of quads. Returns a point of an edge with more than two quads, kInvalidIndex where there is
/// none.
Index countEdges(QuadMesh& quads);

struct DoubledQuads
{
  /// Not ok where an edge of the half joins two points in the plane through the inside, so that its image would be the
  /// same edge.
  Status status;
  QuadMesh quads;           ///< images behind; quad q of the half has the image #Q + q
  std::vector<Index> image; ///< per point; an involution
  Index halfPoints = 0;     ///< of the half itself, before those of images
  Index halfQuads = 0;
};
/// half: of the mesh that was doubled, without polygons. Sources of images are in the images of their faces. Lines in
/// the plane are lines no more, unless they are features of the half.
DoubledQuads doubleQuads(
  const QuadMesh& half, const DoubledMesh& doubled, const MirrorPlane& plane);

} // namespace quadrille
