// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The last resort of re-embedding: the seamless map, which is valid, is carried over to the integers in small
/// steps, each of which starts so near to a valid map that what inverts is mended without changing the winding.
#pragma once

#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/LockedMap.h"
#include "Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace quadrille
{

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
