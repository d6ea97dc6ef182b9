// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Phase 2: decimation to a number of vertices in the order of a cost [Ebke et al. 2016, Section 5.1].
///
/// E_G itself: GaussianCurvatureCost.h. Where we differ: E_G alone does not care for triangles without curvature and
/// for their shape, on which the map's freedom depends; so a little of the star's area, of bad shape and of odd
/// valences is added, and removals that make slivers wait until nothing else is left that costs little.
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/StarCache.h"

#include <string>
#include <vector>

namespace quadrille
{

struct BudgetOptions
{
  Index vertices = 1000; ///< 0: as many as the curvature needs, see kCurvatureShift
  double edgeLength = 0; ///< s; for vertices = 0 only
  DecimationCost cost = DecimationCost::Gaussian;
  std::vector<Index> keepVertices;
  /// #V: what the cache calls the vertices, so that it serves meshes that share vertices under other ids.
  const std::vector<Index>* names = nullptr; ///< null: their ids
  std::vector<float> inputDefect; ///< #V angle defects of the input; for GaussianMemory only
  double curveTolerance = 0;      ///< see RemovalGuards
  int threads = 0;
  ProgressCallback progress;
};

struct BudgetResult
{
  RecordWriter records; ///< one block
  std::string notice;   ///< empty, or why more vertices are left than asked
  CacheReport cache;
  double curvatureShift =
    0; ///< see kCurvatureShift, in units of the mesh; for costs that know curvature
};

/// Decimates. What the cache holds must come from calls with the same cost in which vertices of one name had the same
/// positions and curves (guides may differ); the result does not depend on it.
BudgetResult decimateToBudget(DecimationMesh& mesh, const BudgetOptions& options, StarCache& cache);

} // namespace quadrille
