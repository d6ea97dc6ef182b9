// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Phase 1: uniform decimation until the edges exceed s/2 [Ebke et al. 2016, Section 5.3].
///
/// Where we differ: no heap. Thresholds rise towards s/2; for each one sweeps in storage order remove vertices that
/// have a shorter edge, never two neighbours in one sweep, so that the surface thins out evenly. Blocks of
/// consecutive faces are swept in parallel; a vertex may go if its ring vertices have all their faces in the
/// block; the borders move by half a block from round to round.
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
  /// Per vertex factor on edgeLength (smaller for small components); empty: 1.
  std::vector<float> scale;
  double curveTolerance = 0; ///< see RemovalGuards
  std::vector<Index> keepVertices;
  int threads = 0;
  ProgressCallback progress;
};

/// Decimates; every round goes to the log.
void decimateUniformly(DecimationMesh& mesh, const UniformOptions& options, LogBuilder& log);

} // namespace quadrille
