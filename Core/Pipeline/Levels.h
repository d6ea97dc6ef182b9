// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The levels that the attempts of a run work on.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/StageRecords.h"
#include "Pipeline/SurfaceVersion.h"

#include <memory>
#include <vector>

namespace quadrille
{

/// What phase 1 depends on beside the surface.
struct Phase1
{
  double edgeLength = 0;
  std::vector<Index> kept; ///< HierarchyOptions::keepVertices
};

/// Phase 1 of a surface, from which phase 2 can be made again and again. The surface must have its marks on when that
/// is done.
struct StoredLevels
{
  std::shared_ptr<PreparedSurface> surface; ///< that they refer to
  ResultKey surfaceKey = 0;
  Phase1 phase1;
  std::unique_ptr<Redecimation> levels;
  ResultKey made = 0; ///< of the options of phase 2, when the coarse level was made last

  std::size_t bytes() const;
};

/// One hierarchy at a time: with its log it is a tenth of all memory.
class Levels
{
public:
  /// store: null: none. anyKept: phase 1 may have kept other vertices than it is asked to, so that the levels are only
  /// nearly what a run without a store makes.
  Levels(RunSurface& surface, ResultStore* store, bool anyKept);
  ~Levels() { letGo(); }
  Levels(const Levels&) = delete;
  Levels& operator=(const Levels&) = delete;

  /// Both levels of the surface as it is now. before: phase 1 of an attempt before, on the same surface, or null. Where
  /// that has left all vertices that are to be kept the levels are made from its intermediate one.
  const Hierarchy& make(const HierarchyOptions& options, const Phase1* before);
  /// What was made last.
  const Hierarchy& hierarchy() const { return held_->levels->hierarchy(); }
  bool has() const { return held_ != nullptr; }
  const Phase1& phase1() const { return phase1_; } ///< of what was made last
  /// To the store, where there is one.
  void letGo();
  /// Gives away what was made last; not where there is a store.
  Hierarchy take();

  int decimations() const { return decimations_; } ///< runs of phase 1
  bool recalled() const { return recalled_; }      ///< whether phase 1 was in the store
  /// Of the last make(): seconds and sizes of what was computed.
  const StageRecords& stages() const { return stages_; }

private:
  ResultKey key(const Phase1& phase1) const;
  void obtain(const HierarchyOptions& options, const Phase1& phase1);
  bool recall(const Phase1& phase1);
  bool recallAny(const HierarchyOptions& options);
  void decimate(HierarchyOptions options, const Phase1& phase1);

  RunSurface& surface_;
  ResultStore* store_;
  bool anyKept_;
  std::shared_ptr<StoredLevels> held_;
  ResultKey heldKey_ = 0;
  Phase1 phase1_;
  int decimations_ = 0;
  bool recalled_ = false;
  StageRecords stages_;
};

} // namespace quadrille
