// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A part of a surface, its map and its quads together with their images. What parts have in common is there once, by
/// identity and not by distance: along the edges where the part was cut.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Extraction/Extraction.h"
#include "Symmetry/Isometry.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Images come behind, those by one step first: face f of the part has the images k #F + f. Corners 0 1 2 of a mirror
/// image are the images of corners 0 2 1, see reversedCorner. Of a mirror plane both sides are joined along it; those
/// of a rotation are not joined, as the triangles of the two cuts differ.
struct CopiedMesh
{
  Mesh mesh;
  Index partVertices = 0, partFaces = 0;
  std::vector<Index>
    image; ///< per vertex of `mesh`, by one step; of those in the plane they themselves
  std::vector<std::uint8_t> isGlued; ///< per half-edge of the part: a boundary in the mirror plane
  std::vector<FixedVec2> uv;         ///< empty until copyMap()
  std::vector<int> turns;            ///< in the mirror plane those of both sides
};
/// Boundary edges with both ends within `tolerance` of a mirror plane are glued, and these ends put into it.
CopiedMesh copyMesh(
  const Mesh& part, const std::vector<int>& turns, const Isometry& isometry, double tolerance);

/// The map of the copied mesh: in mirror images u and v are exchanged, so that triangles stay positive and the boundary
/// in the plane, an isoline, has the same one on both sides, with a transition by a quarter turn.
std::vector<FixedVec2> copyMap(
  const CopiedMesh& copied, const Isometry& isometry, std::vector<FixedVec2> uv);

/// Valences and boundary of quads. Returns a point of an edge with more than two quads, kInvalidIndex where there is
/// none.
Index countEdges(QuadMesh& quads);

/// A point of a part of which a point of the same part is the image by one step, or it itself, as on an axis and in a
/// mirror plane.
struct SamePoints
{
  Index first = 0, second = 0;
};

/// Where the quads of a part meet those of its images.
struct CutQuads
{
  /// Of which boundary a line is.
  enum Line : std::uint8_t
  {
    Own,    ///< of none of the cuts
    First,  ///< of the cut that images are glued to by one step
    Second, ///< of that of the images of the first
  };
  std::vector<SamePoints> pairs;
  std::vector<Line> lines; ///< per line of the quads
};
/// Lines of the boundary that is glued.
CutQuads cutInPlane(const QuadMesh& part, const CopiedMesh& copied);
/// Of both half planes of a wedge: no line across it has both ends on the same side of it.
CutQuads cutAlongSeams(const QuadMesh& part, std::vector<SamePoints> pairs);

struct CopiedQuads
{
  /// Not ok where an edge of the part joins two points of its cuts through the inside, so that its image would be the
  /// same edge.
  Status status;
  QuadMesh quads;           ///< images behind; quad q of the part has the images k #Q + q
  std::vector<Index> image; ///< per point, by one step
  Index partPoints = 0;     ///< of the part itself, before those of images
  Index partQuads = 0;
};
/// part: of the mesh that was copied, without polygons. Sources of images are in the images of their faces. Lines in
/// the cuts are lines no more, unless they are features of the part.
CopiedQuads copyQuads(
  const QuadMesh& part, const CopiedMesh& copied, const CutQuads& cut, const Isometry& isometry);

} // namespace quadrille
