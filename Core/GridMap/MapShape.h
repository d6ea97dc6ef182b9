// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The shape that the map should give a triangle: itself, seen in the frame of the field.
#pragma once

#include "CrossField/CrossField.h"
#include "GridMap/PreviousMap.h"
#include "Mesh/Mesh.h"
#include "Numerics/Untangler.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The edges [p1 - p0, p2 - p0] of face f in a plane whose first axis is half-edge 3f, over the sizes that the mesh
/// wants there; needles are made a little higher, so that the matrix is never singular unless the face is a point.
Eigen::Matrix2d flattenFace(const Mesh& mesh, Index f);

/// The same edges of the face in a map; uv: #H.
Eigen::Matrix2d mappedEdges(const std::vector<FixedVec2>& uv, Index f);
/// Signed area of the face in a map, in quads.
double mappedArea(const std::vector<FixedVec2>& uv, Index f);

/// The share of the area, over the sizes that the mesh wants, of faces whose two stretches (the singular values of the
/// map's Jacobian) have a ratio above `limit`; faces without a positive determinant count as such. uv: #H. Throws
/// InvalidInput unless limit >= 1 and finite, or where sizes disagree.
double shareBeyondRatio(const Mesh& mesh, const std::vector<FixedVec2>& uv, double limit);

/// Throws InvalidInput unless the limit is 0 (none) or a number from 1 on.
void checkAnisotropyLimit(double limit);

/// What the field's stretch makes of the area of face f; 1 without it.
double areaStretch(const CrossField& field, Index f);

/// Area over the sizes, and stretched by the field: what the map should give its quads to.
double stretchedArea(const Mesh& mesh, const CrossField& field);

/// Length of an edge over its size; where the field stretches its faces, by the mean of what they make of it.
double stretchedLength(const Mesh& mesh, const CrossField& field, Index h);

/// Appends face f to the problem: its points, its reference (in units of edgeLength times the size that the mesh wants
/// there, stretched by the field, in the chart of the face turned by `quarterTurns`), its weight, which is its area
/// in quads, and its guide.
void addTriangle(UntangleProblem& problem, const std::array<Index, 3>& points, const Mesh& mesh,
  const CrossField& field, Index f, int quarterTurns, double edgeLength);

/// Weight of a guard against a face of its size: enough to forbid, too little to shape the map.
constexpr double kGuardWeight = 0.05;

/// An edge of the problem that has to run along an axis of its chart.
struct GuardedEdge
{
  Index from = 0, to = 0; ///< points
  int axis = 0;           ///< quarter turns of the direction (1, 0)
  double length = 0;      ///< wanted, > 0
};

/// Those of a mesh, one half-edge each: the other one follows through the seam. pointOf: of a corner; turnsOf: quarter
/// turns of the problem's chart of a face against that of the field.
template <class PointOf, class TurnsOf>
std::vector<GuardedEdge> guardedEdges(const Mesh& mesh, const CrossField& field, double edgeLength,
  const PointOf& pointOf, const TurnsOf& turnsOf)
{
  std::vector<GuardedEdge> edges;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const double length = stretchedLength(mesh, field, h) / edgeLength;
    if (mesh.isConstrained(h) && (mesh.isBoundary(h) || h < mesh.twin[h]) && length > 0)
    {
      edges.push_back({ pointOf(h), pointOf(Mesh::next(h)),
        field.alignment[h] + turnsOf(Mesh::face(h)), length });
    }
  }
  return edges;
}

/// An axis of a vertex's chart in that of a corner which is rotated against it: along one of the two coordinates.
struct CornerAxis
{
  int coordinate = 0; ///< 0: u, 1: v
  double sign = 1;
};
CornerAxis cornerAxis(int axis, int rotation);

/// Appends a triangle for each edge, after those of the faces, that is positive when the edge runs along its
/// axis and inverted when it runs against it: a feature or a boundary can fold over at a vertex though
/// all faces are positive. Its third point hangs on `from` by a constant offset.
void guardEdges(UntangleProblem& problem, const std::vector<GuardedEdge>& edges);

/// The problem with other references for the faces that an earlier map knows: the shape that they have in `uv`, one of
/// the maps of `carried`, turned with the field. Its fit (fitReferences) is a start near that map. quarterTurns: #F, of
/// the problem's charts against those of the field, or empty. scale: of the problem's unit against the map's.
UntangleProblem referToMap(const UntangleProblem& problem, const CarriedMap& carried,
  const std::vector<FixedVec2>& uv, const std::vector<std::uint8_t>& quarterTurns, double scale);

} // namespace quadrille
