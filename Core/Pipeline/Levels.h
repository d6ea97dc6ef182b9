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
  ResultKey made = 0; ///< of the options of phase 2, when the coarse level was made last
  std::shared_ptr<SharedStars> stars; ///< that lie in the store beside it; null: none
  ResultKey starsKey = 0;

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

  /// Levels that have followed a change by which the surface was made (Redecimation::follow) are others than those that
  /// phase 1 makes of it. So that it does not matter what a store still has, they count only until they are let go.
  /// Gives the levels of the surface without a plan away, from before a change; null where others are held.
  std::unique_ptr<Redecimation> giveToFollow(
    const PlannedSurface& surface, const HierarchyOptions& options);
  /// Takes them back, of a surface that has followed. options: those of makeIntermediate. isStored: whether they are
  /// from the store.
  void follow(std::shared_ptr<StoredLevels> followed, bool isStored, const PlannedSurface& surface,
    const HierarchyOptions& options);
  bool hasFollowed() const { return hasFollowed_; }
  /// The same from the store; null where it has none.
  static std::shared_ptr<StoredLevels> findFollowed(
    ResultStore& store, ResultKey surfaceKey, double edgeLength);

  int decimations() const { return decimations_; } ///< runs of phase 1
  bool recalled() const { return recalled_; }      ///< whether phase 1 was in the store
  /// Of the last make(): seconds and sizes of what was computed.
  const StageRecords& stages() const { return stages_; }

private:
  void obtain(const PlannedSurface& surface, const HierarchyOptions& options);
  ResultKey plainKey(const PlannedSurface& surface, const HierarchyOptions& options) const;
  bool recall(ResultKey wanted);
  void decimate(const PlannedSurface& surface, const Mesh& mesh, const HierarchyOptions& options,
    ResultKey key);

  ResultStore* store_;
  std::shared_ptr<StoredLevels> held_;
  ResultKey heldKey_ = 0;
  int decimations_ = 0;
  bool recalled_ = false;
  bool hasFollowed_ = false;
  StageRecords stages_;
};

} // namespace quadrille
