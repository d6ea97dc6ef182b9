// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The third stage of an integer-grid map: the map with its integers, without inverted triangles.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/LockedMap.h"
#include "GridMap/MapCheck.h"
#include "GridMap/PreviousMap.h"
#include "Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace quadrille
{

struct EmbedOptions
{
  double edgeLength = 0; ///< as in SeamlessOptions
  /// The valid seamless map that the integers were made for; when given, embedding falls back on
  /// following a continuous way from there.
  const std::vector<FixedVec2>* seamlessUv = nullptr;
  /// An earlier map in the charts of the field, or null: a start near it is tried first.
  const CarriedMap* previous = nullptr;
  double anisotropyLimit = 0; ///< as in GridMapOptions
  /// Where embedding other integers failed, ascending: if it fails at just these again, it is told at once, as the way
  /// from the seamless map was gone in vain then.
  std::vector<Index> failedBefore;
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
  bool startedFromPrevious = false;
};
/// Moves everything but integers (integer vertices, isoline values, translations) so that every det > 0.
/// Throws InvalidInput, naming the element, when integerUv is fractional or contradicts the field.
EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options);

struct ContinuationResult
{
  /// Unknowns of the integer map; none when the way was blocked.
  std::optional<Eigen::VectorXd> y;
  int newtonSteps = 0;
  double reached = 0;         ///< how far it came, 1 is the end
  std::vector<Index> blocked; ///< the faces that could not be mended when it was blocked
};

/// seamlessUv and the map of `integers` have transitions with the same rotations and lock the same vertices.
ContinuationResult continueToIntegers(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const LockedMap& integers,
  const ProgressCallback& progress);

} // namespace quadrille
