// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Decimation to the intermediate and the coarse level, and its log [Ebke et al. 2016, Section 5].
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/DecimationLog.h"
#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

enum class DecimationCost
{
  Gaussian,       ///< E_G: change of Gaussian curvature against the current mesh
  GaussianMemory, ///< E_G,mem: against the input mesh
  Quadric,        ///< E_QEM
  Uniform         ///< E_uni: shortest incident edge
};

struct HierarchyOptions
{
  double targetEdgeLength =
    0; ///< s, in units of the mesh; > 0. Phase 1 ends when edges exceed s/2.
  Index coarseVertices = 1000; ///< budget of the coarse level; raised where features, handles or
                               ///< components need more (told in Hierarchy::notice)
  DecimationCost cost = DecimationCost::Gaussian; ///< of phase 2
  /// Vertices of the finest mesh that no phase may remove (index constraints; places where a map needs
  /// more freedom, see TransferResult::offenders).
  std::vector<Index> keepVertices;
  int threads = 0; ///< 0: all; the result does not depend on it
  ProgressCallback progress;
};

/// A coarser mesh whose corners are slots of the finest mesh: corner i of face f is corner i of the
/// finest level's face fineFace[f].
struct Level
{
  Mesh mesh;
  std::vector<Index> fineVertex; ///< #V; id on the finest mesh (levels are subsamplings)
  std::vector<Index> fineFace;   ///< #F
};

struct Hierarchy
{
  Level intermediate;
  Level coarse;
  DecimationLog log;
  std::string notice; ///< empty, or why the coarse level is larger than asked
  double secondsPhase1 = 0;
  double secondsPhase2 = 0;
};

/// Throws InvalidInput when s is not positive and finite. Progress and cancel through the options.
Hierarchy buildHierarchy(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options);

} // namespace quadrille
