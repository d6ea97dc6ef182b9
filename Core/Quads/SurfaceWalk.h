// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Moving points on a triangle mesh: straight over its faces, or along its constrained curves.
#pragma once

#include "Mesh/Mesh.h"

#include <array>
#include <optional>
#include <vector>

namespace quadrille
{

/// A constrained curve that bends by more than this at a vertex of the mesh has a corner there, where the quads have a
/// point: 30 degrees.
constexpr double kCurveCorner = 0.5235987755982988;

struct SurfacePoint
{
  Index face = kInvalidIndex;
  std::array<double, 3> weights{}; ///< barycentric, sum 1
};

Vector3 positionOf(const Mesh& mesh, const SurfacePoint& point);

/// Walks straight from the point by the part of `displacement` that is tangential there, unfolding
/// over edges. None when it would meet a constrained edge or a degenerate triangle, or cross more
/// faces than there are.
std::optional<SurfacePoint> walkSurface(const Mesh& mesh, SurfacePoint from, Vector3 displacement);

/// The constrained edges at the vertex of corner h, each by the lower of its two half-edges.
std::vector<Index> constrainedEdgesAt(const Mesh& mesh, Index h);

/// A place on the edge of half-edge h: position (1 - t) origin + t target.
struct CurvePoint
{
  Index h = kInvalidIndex;
  double t = 0;

  SurfacePoint onSurface() const;
};

/// Where a point of a constrained edge lies; none when it lies on no such edge or on a vertex.
std::optional<CurvePoint> locateOnCurve(const Mesh& mesh, const SurfacePoint& point);

/// The constrained edge other than `edge` at the vertex where it is left; none at ends and forks.
std::optional<Index> continueCurve(const Mesh& mesh, Index edge, bool atTarget);

/// Walks along the curve of constrained edges by `length` (backwards when negative; forwards is the
/// direction of h). None where the curve ends or forks, or more edges are passed than there are faces.
std::optional<CurvePoint> walkCurve(const Mesh& mesh, CurvePoint from, double length);

} // namespace quadrille
