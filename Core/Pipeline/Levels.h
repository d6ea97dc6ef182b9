// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The levels that the attempts of a run work on.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/StageRecords.h"

#include <memory>
#include <vector>

namespace quadrille
{

/// Phase 1 of a surface, from which phase 2 can be made again and again. The surface must have its marks on when that
/// is done.
struct StoredLevels
{
  std::unique_ptr<Redecimation> levels;
  ResultKey made = 0;   ///< of the options of phase 2, when the coarse level was made last
  ResultKey guided = 0; ///< of these and of the guides, when they were put on the levels last

  std::size_t bytes() const;
};

/// One hierarchy at a time: with its log it is a tenth of all memory.
class Levels
{
public:
  /// store: null: none.
  explicit Levels(ResultStore* store) : store_(store) {}
  ~Levels() { letGo(); }
  Levels(Levels&&) = default;
  Levels& operator=(Levels&&) = delete;

  /// The intermediate level, as phase 1 leaves it whatever is to be kept. Valid until the next call.
  const Level& makeIntermediate(const PlannedSurface& surface, const HierarchyOptions& options);
  /// All three levels.
  const Hierarchy& make(const PlannedSurface& surface, const HierarchyOptions& options);
  /// What was made last.
  const Hierarchy& hierarchy() const { return held_->levels->hierarchy(); }
  /// To the store, where there is one.
  void letGo();
  /// What was made last, which goes to the store, too, where there is one.
  Hierarchy take();

  int decimations() const { return decimations_; } ///< runs of phase 1
  bool recalled() const { return recalled_; }      ///< whether phase 1 was in the store
  /// Of the last make(): seconds and sizes of what was computed.
  const StageRecords& stages() const { return stages_; }

private:
  void obtain(const PlannedSurface& surface, const HierarchyOptions& options);
  bool recall(ResultKey wanted);
  void decimate(const PlannedSurface& surface, const Mesh& mesh, const HierarchyOptions& options,
    ResultKey key);

  ResultStore* store_;
  std::shared_ptr<StoredLevels> held_;
  ResultKey heldKey_ = 0;
  int decimations_ = 0;
  bool recalled_ = false;
  StageRecords stages_;
};

} // namespace quadrille
