// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The first stage of an integer-grid map: a seamless one along the field, without inverted triangles.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/MapCheck.h"
#include "GridMap/PreviousMap.h"

#include <vector>

namespace quadrille
{

struct SeamlessOptions
{
  double edgeLength = 0; ///< length on the surface that one uv unit stands for; > 0
  /// 0, or the area that the map is scaled to in the end; scaling changes nothing else of it.
  double targetQuads = 0;
  /// An earlier map in the charts of the field, or null: where a start near it has nothing inverted, it takes the place
  /// of the Poisson equation's solution.
  const CarriedMap* previous = nullptr;
  double anisotropyLimit = 0; ///< as in GridMapOptions
  ProgressCallback progress;
};
struct SeamlessResult
{
  std::vector<FixedVec2> uv; ///< #H; best effort when the status is not ok
  Status status;
  std::vector<Index> inverted; ///< faces left with !(det > 0)
  std::vector<Index>
    failedAt;              ///< vertices round which the triangulation, or the field, leaves no map
  FailedFaces failedFaces; ///< where these defects are
  int newtonSteps = 0;
  bool startedFromPrevious = false;
};
/// A seamless map without inverted triangles that follows the field: transitions are quarter turns plus any
/// translation, constrained edges lie on isolines (of any value). Exact on the fixed-point grid.
SeamlessResult computeSeamlessMap(
  const Mesh& mesh, const CrossField& field, const SeamlessOptions& options);

} // namespace quadrille
