// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which faces of the mapped mesh lie under each quad, and with how much of its area.
#pragma once

#include "Extraction/Extraction.h"

#include <vector>

namespace quadrille
{

/// A face under a quad.
struct FaceShare
{
  Index face = kInvalidIndex;
  double weight = 0; ///< part of the quad's area in the map, in (0, 1]
};

struct QuadCoverage
{
  std::vector<std::size_t> first; ///< #quads + 1 offsets into shares
  /// Per quad; the face under its centre comes first; the weights sum to 1. Beside a vertex of
  /// valence 2 a face may come twice.
  std::vector<FaceShare> shares;
};

/// Cuts the faces with the unit square that each quad is in the map, before smoothing moved its points. Searches from
/// the face under the centre on over the edges that cross the square, never over a constrained edge, so that nothing
/// from beyond a feature counts. In a fold only faces of the orientation of the one under the centre count. A quad
/// without a square (QuadMesh::quadSourceWeights) has its one face. uv: #H, the map that the quads come from, in
/// whatever charts. Linear in the shares; parallel, the result does not depend on the number of threads.
QuadCoverage coverQuads(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, const QuadMesh& quads, int threads);

} // namespace quadrille
