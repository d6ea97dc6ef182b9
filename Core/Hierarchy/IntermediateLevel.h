// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The intermediate level of a hierarchy [Ebke et al. 2016, Section 5.3]: what phase 1 leaves of the finest mesh, with
/// vertices that come back to it (VertexRestoration.h).
#pragma once

#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/VertexRestoration.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// How far a curve of a coarser level may lie from the input's, in s: a tenth of a quad is not seen in the
/// quads, while a circle of radius s still gets an edge per 0.9 s.
constexpr double kCurveTolerance = 0.1;

class IntermediateLevel
{
public:
  /// Phase 1 with the vertices to keep of the options. hierarchy gets level and log, and stays for as long as this
  /// object does. Throws as Redecimation does.
  IntermediateLevel(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options,
    Hierarchy& hierarchy);

  const Mesh& fine() const { return fine_; }
  double edgeLength() const { return edgeLength_; } ///< s
  /// As phase 2 begins on it: small and without gaps.
  const DecimationMesh& mesh() const { return *mesh_; }
  /// See Redecimation::intermediateOfPhase1().
  const Level& ofPhase1() const { return aside_ ? aside_->level : hierarchy_.intermediate; }
  void setSizes(SharedArray<float> sizing) { fine_.sizing = std::move(sizing); }

  /// Puts these vertices (ascending) on the level, and as many as the sizes ask for that the finest mesh has now. All
  /// else is as phase 1 has left it.
  void put(const std::vector<Index>& vertices, const HierarchyOptions& options);
  /// Brings the guides of the options to the level, where they have changed.
  void carryGuides(const HierarchyOptions& options);
  /// Takes the coarse level and what leads to it from the hierarchy.
  void dropCoarse();
  /// See Redecimation::bytesAside().
  std::size_t bytesAside() const;

private:
  /// What the level was made for.
  struct Wanted
  {
    std::vector<Index> kept;   ///< ascending
    SharedArray<float> sizing; ///< of the finest mesh

    bool is(const std::vector<Index>& vertices, const Mesh& fine) const
    {
      return kept == vertices && sizing == fine.sizing;
    }
  };
  /// The level of phase 1 while vertices are back that it has removed.
  struct Aside
  {
    Level level;
    std::unique_ptr<DecimationMesh> mesh;
    DecimationLog::End end;
    std::vector<std::pair<std::size_t, BlockRecords>> blocks; ///< that records were taken from
  };
  struct ThinnedAgain;

  void thinOut(std::uint64_t fineHash, const HierarchyOptions& options);
  void makeMesh(const FeatureCurves& fineCurves, const std::vector<float>& curveError,
    const std::vector<Index>& ids);
  void restore(const std::vector<LoggedRemoval>& removals, const std::vector<Index>& vertices,
    const HierarchyOptions& options);
  ThinnedAgain thinOutAgain(const RestoredLevel& restored, const std::vector<Index>& vertices,
    const HierarchyOptions& options) const;
  void putThere(ThinnedAgain again);
  void returnToPhase1();
  void finish();

  Hierarchy& hierarchy_;
  Mesh fine_;
  double edgeLength_ = 0;
  std::unique_ptr<DecimationMesh> mesh_; ///< on the positions of hierarchy_.intermediate
  DecimationLog::End end_;
  bool anySmallComponent_ = false; ///< see VertexScales
  Wanted byPhase1_;
  Wanted byRestoration_; ///< where something is set aside
  std::optional<Aside> aside_;
  FeatureCurves fineCurves_;      ///< for vertices that come back, when first needed
  std::vector<FaceGuide> guides_; ///< that the level has
};

} // namespace quadrille
