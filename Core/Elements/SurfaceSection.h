// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The middle of ways between two places of a surface, over its faces or along edges of it.
#pragma once

#include "Quads/SurfaceWalk.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// The point with weights as exact as `point` has them in another face that has all of its vertices with a weight;
/// none where `face` lacks one.
std::optional<SurfacePoint> inFace(const Mesh& mesh, const SurfacePoint& point, Index face);

/// All faces that the point lies in: one, two on an edge, the fan of a vertex. Weights of 1e-9 and less count as zero.
std::vector<Index> facesAt(const Mesh& mesh, const SurfacePoint& point);

/// The section of the surface with the plane through both places that contains `normal`, where it crosses the plane
/// halfway between them that is perpendicular to their connection; of several points the one nearest to the middle. The
/// section is followed from face to face, so that the other side of a thin wall is never met. None where it leaves the
/// surface over a boundary, or is longer than three times the distance of the places.
std::optional<SurfacePoint> middleOnSection(
  const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, const Vector3& normal);

/// Walks from the place straight towards `target` over the faces as long as that leads nearer to it; stays on features
/// and boundaries that it meets.
SurfacePoint approach(const Mesh& mesh, SurfacePoint from, const Vector3& target);

/// A way along edges of a surface. Segment i runs from points[i] to points[i + 1] on the edge of halfEdges[i].
struct CurveChain
{
  std::vector<CurvePoint> points; ///< two for each segment: its ends on its own half-edge
  double length = 0;

  /// Where it crosses the plane halfway between its ends that is perpendicular to their connection; of several points
  /// the one nearest to the middle.
  CurvePoint middle(const Mesh& mesh) const;
  /// The place of the chain nearest to p; of several the first.
  CurvePoint nearest(const Mesh& mesh, const Vector3& p) const;
};

/// The way along edges between two places on edges or vertices. boundaryOnly: along the boundary alone. Else the way
/// with the least sum of lengths, where edges that are no features count up to five times, the flatter the surface is
/// there: so a way along a crease is taken although another one is shorter. None where a place lies inside of a face
/// (see facesAt), or the way is ten times as long as the distance of the places.
std::optional<CurveChain> chainBetween(
  const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, bool boundaryOnly);

} // namespace quadrille
