// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Phase 1: uniform decimation until the edges exceed s/2 [Ebke et al. 2016, Section 5.3].
///
/// Where we differ: no heap. Thresholds rise towards s/2; for each one sweeps in storage order remove vertices that
/// have a shorter edge, never two neighbours in one sweep, so that the surface thins out evenly. Blocks of
/// consecutive live vertices are swept in parallel; a vertex may go if its ring lies in the block. Then its star
/// does, too, and all that a removal writes belongs to edges with both ends in the block. The borders move by half
/// a block from round to round.
///
/// A vertex whose star has not changed since it was looked at is passed over: its edges are too long for
/// thresholds up to the one that was noted, or its removal was refused.
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/LogBuilder.h"

#include <vector>

namespace quadrille
{

struct UniformOptions
{
  double edgeLength = 0; ///< s / 2
  /// Per vertex factor on edgeLength (smaller for small components, and by the sizes that are asked for); empty: 1.
  std::vector<float> scale;
  double curveTolerance = 0; ///< see RemovalGuards
  std::vector<Index> keepVertices;
  /// Empty: all vertices. Else only these may go, ascending: a part of a mesh that is thinned out already.
  std::vector<Index> candidates;
  /// Ends where few edges are still short in place of none, at borders of blocks and where stars are folded.
  bool isRough = false;
  bool isExact = false; ///< see HierarchyOptions
  int threads = 0;
  ProgressCallback progress;
};

/// Decimates; every round goes to the log.
void decimateUniformly(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log);

} // namespace quadrille
