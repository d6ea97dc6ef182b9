// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The seams of a wedge's quads (see Requests/SeamRequests.h): which points of its two cuts are each other's images, by
/// the order along them and not by distance, and where they lie.
#pragma once

#include "Base/Error.h"
#include "Mesh/Requests.h"
#include "Symmetry/Copies.h"
#include "Symmetry/ImageFit.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Along all seams. Not ok, with none, where the two parts of a seam do not have the same number of edges.
struct WedgeSeams
{
  Status status;
  std::vector<SamePoints> pairs; ///< ascending by `first`, each once; one of both is a pole
};
/// quads: of the wedge, without polygons; mesh: that their lines are of.
WedgeSeams pairSeams(const QuadMesh& quads, const Mesh& mesh,
  const std::vector<SeamRequest>& requests, const Isometry& rotation);

/// Moves the points of pairs to between their two places, those round them along, and evens them out; all stay on the
/// surface, on its features and its boundary. Where quads were sound and would not be, all stays as it was. Returns
/// which points were moved (#points).
std::vector<std::uint8_t> fitSeams(QuadMesh& quads, const CutQuads& cut, const Isometry& rotation,
  const SearchedSurface& whole, double tolerance);

} // namespace quadrille
