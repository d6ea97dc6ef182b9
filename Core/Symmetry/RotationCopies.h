// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quads of a wedge and those turned by 1 to n - 1 steps. What lies in the cuts is there once, by the order along
/// them and not by distance: where one part of a seam (see Requests/SeamRequests.h) of a wedge meets the other one of
/// the next.
#pragma once

#include "Symmetry/CopiedRun.h"
#include "Symmetry/RotationAxis.h"

namespace quadrille
{

/// A point of a wedge in the first half plane, and the one in the second that is its image; one of both is a pole.
struct SeamPoints
{
  Index first = 0, second = 0;
};

/// Along all seams. Not ok, with none, where the two parts of a seam do not have the same number of edges.
struct WedgeSeams
{
  Status status;
  std::vector<SeamPoints> pairs; ///< ascending by `first`, each once
};
/// quads: of the wedge, without polygons; mesh: that their lines are of.
WedgeSeams pairSeams(const QuadMesh& quads, const Mesh& mesh,
  const std::vector<SeamRequest>& requests, const MadeRotation& rotation);

/// Moves the points of pairs to between their two places, those round them along, and evens them out; all stay on the
/// surface, on its features and its boundary. Where quads were sound and would not be, all stays as it was. Returns
/// which points were moved (#points).
std::vector<std::uint8_t> fitSeams(QuadMesh& quads, const std::vector<SeamPoints>& pairs,
  const MadeRotation& rotation, const SearchedSurface& whole, double tolerance);

/// Images behind; quad q of the wedge turned by k steps is k #Q + q. `image` of a point is it turned by one step. Not
/// ok where a wedge is so narrow that edges of it and of its images would be the same. mesh: that the lines of the
/// wedge are of; those in a cut are lines no more, unless they are features.
DoubledQuads turnQuads(const QuadMesh& wedge, const Mesh& mesh,
  const std::vector<SeamPoints>& pairs, const MadeRotation& rotation);

/// n times the mesh with its map, not joined.
CopiedMesh turnMesh(const Mesh& wedge, const std::vector<FixedVec2>& uv,
  const std::vector<int>& turns, const MadeRotation& rotation);

} // namespace quadrille
