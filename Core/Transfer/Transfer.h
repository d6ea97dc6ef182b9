// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Coarse-to-fine mapping: the decimation log backwards on fixed-point uv [Ebke et al. 2016, Section 6].
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Hierarchy/Hierarchy.h"

#include <vector>

namespace quadrille
{

struct TransferOptions
{
  /// Memory of a map that nobody needs any more, of whatever size and contents; it is taken. Fresh memory for two
  /// million faces takes a twentieth of an edit. Null: none.
  std::vector<FixedVec2>* spare = nullptr;
  int threads = 0;
  ProgressCallback progress;
};

struct TransferResult
{
  std::vector<FixedVec2> uv;     ///< #H of the finest mesh
  std::size_t invertedStars = 0; ///< un-collapses whose interpolated vertex inverted its star
  std::size_t movedToKernel =
    0; ///< of these, mended by moving the vertex into the kernel of its ring
  std::size_t withoutKernel = 0;     ///< of these, left inverted by the replay
  std::size_t replayNotPositive = 0; ///< triangles with !(det > 0) that the replay left
  std::size_t mendedPatches = 0;     ///< patches re-embedded afterwards
  std::size_t notPositive = 0;       ///< triangles with !(det > 0) in the end
  /// Vertices of these triangles or, if there are none, of those at vertices of wrong turns, sorted. Empty when the
  /// coarse map was invalid already. Where the finest mesh has too few triangles between irregular
  /// vertices or corners for what the coarse map asks there, no replay can be valid; keeping these vertices on
  /// the coarse level (HierarchyOptions::keepVertices) shows its map what there is.
  std::vector<Index> defectVertices;
};

/// Carries a map of the coarse level to the finest mesh. coarseUv: #H of coarse.mesh. Throws
/// InvalidInput when sizes or the log's mesh do not fit.
TransferResult transferMap(const Mesh& fine, const Level& coarse, const DecimationLog& log,
  const std::vector<FixedVec2>& coarseUv, const TransferOptions& options);

/// The map of the coarse level on a level between: that to which the log's first `rounds` rounds lead, as
/// Hierarchy::intermediate with log.intermediateRounds. #H of level.mesh. As the replay leaves it: nothing is
/// counted or mended. Throws InvalidInput when sizes or rounds do not fit.
std::vector<FixedVec2> transferToLevel(const Level& coarse, const Level& level, std::size_t rounds,
  const DecimationLog& log, const std::vector<FixedVec2>& coarseUv, const TransferOptions& options);

/// Carries a map of a level between, as transferToLevel makes it, to the finest mesh, and mends what is not positive
/// there or was not on the level. uv: #H of level.mesh; turns: #V
/// of the finest mesh, what the map should wind round each vertex. Throws InvalidInput when sizes or rounds do not fit.
TransferResult transferFromLevel(const Mesh& fine, const Level& level, std::size_t rounds,
  const DecimationLog& log, const std::vector<FixedVec2>& uv, const std::vector<int>& turns,
  const TransferOptions& options);

} // namespace quadrille
