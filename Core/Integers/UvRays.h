// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Lines along an axis of a map, followed exactly from face to face, and edges made of them.
///
///          x            from the corner `h` at a, along axis k of the chart of its face, through next(h) into
///        / | \          the next face, until a vertex lies on the line, or a curve ends it
///   a -->--|-->--- b
///        \ | /
#pragma once

#include "Integers/UvMesh.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// A place on a line and its way on.
struct UvDirection
{
  Index corner =
    kInvalidIndex; ///< half-edge that leaves the vertex; the line runs in its face, or along it
  int axis = 0;    ///< quarter turns from +u in the chart of that face
};

struct UvRay
{
  std::vector<Index> crossed; ///< half-edges through which the line leaves its faces, in order
  UvDirection
    end; ///< at the vertex that it meets: a corner of the last face, the axis in its chart
  Index curve = kInvalidIndex; ///< or the half-edge of a curve or boundary that it meets first
  std::int64_t length = 0;     ///< to the vertex, in units of 2^-24; 0 where it meets none

  bool meetsVertex() const { return end.corner != kInvalidIndex; }
};

/// The lines that leave v along an axis, counterclockwise from mesh.outgoing[v]; one that runs along a half-edge counts
/// for the face on its left.
std::vector<UvDirection> axisDirections(const UvMesh& mesh, Index v);

/// Follows a line up to the first vertex or, with stopAtCurves, curve; boundaries always end it. Gives up, meeting
/// nothing, after maximumLength.
UvRay followLine(
  const UvMesh& mesh, UvDirection start, std::int64_t maximumLength, bool stopAtCurves);

/// The line straight on beyond a vertex that is regular, from the end of a ray that meets it; none on a boundary.
std::optional<UvDirection> straightOn(const UvMesh& mesh, UvDirection end);

/// Makes the line from `start` to the vertex that it meets an edge, by flips. Edges that only stay straight on the
/// surface give way, curves do not. The edge, as a half-edge and the axis in its chart, or none where a curve, or no
/// vertex, is met.
std::optional<UvDirection> makeEdgeAlong(
  UvMesh& mesh, UvEditor& editor, UvDirection start, std::int64_t maximumLength);

} // namespace quadrille
