// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The third stage of an integer-grid map: the map with its integers, without inverted triangles.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/MapCheck.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct EmbedOptions
{
  double edgeLength = 0;      ///< as in SeamlessOptions
  double anisotropyLimit = 0; ///< as in GridMapOptions
  ProgressCallback progress;
};
struct EmbedResult
{
  std::vector<FixedVec2> uv;
  Status status;
  std::vector<Index> inverted; ///< faces left with !(det > 0)
  std::vector<Index>
    failedAt; ///< vertices round which the triangulation leaves no map with these integers
  FailedFaces failedFaces; ///< where these defects are
  int newtonSteps = 0;
};
/// Moves everything but integers (integer vertices, isoline values, translations) so that every det > 0, and the map
/// has little distortion. Where the given map is positive already that takes a few steps, see quantizeMap().
/// Throws InvalidInput, naming the element, when integerUv is fractional or contradicts the field.
EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options);

} // namespace quadrille
