// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The attempts of a run: which of them counts, and what of them the choice of the next one needs.
#pragma once

#include "Pipeline/Attempt.h"
#include "Pipeline/WorkBound.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

/// Attempts come in rounds: maps until one holds or no other would, then its quads. Of the maps of the surface at most
/// two are held, one of them packed: the last one, and that of the result so far.
class History
{
public:
  History() = default;
  /// work, attempts: that were made before, and count as if they were the history's own.
  explicit History(const WorkBound& bound, std::size_t work = 0, std::size_t attempts = 0)
    : bound_(bound), work_(work), attemptsBefore_(attempts)
  {
  }

  void addMap(const Plan& plan, std::shared_ptr<MapAttempt> map);
  /// Of the last map, or null where it has failed; ends the round.
  void addQuads(std::shared_ptr<const QuadAttempt> quads);
  /// Before another map takes its memory.
  void packMaps(const Mesh& surface);

  const Attempt& last() const { return last_; }
  bool hasMap() const { return last_.map != nullptr && last_.map->status.ok(); } ///< the last one
  /// How many attempts of the round were made by this step.
  std::size_t inRound(const std::string& step) const;

  /// The attempt that has quads, of several the one with the fewest that are inverted: a later one counts only where
  /// it has at most half as many, as what it changed has a price. Without any, that of the last round.
  const Attempt& result() const { return result_.quads ? result_ : last_; }
  bool hasResult() const { return result_.quads != nullptr; }

  std::size_t work() const { return work_; } ///< of all attempts
  std::size_t attempts() const { return attemptsBefore_ + steps_.size(); }
  const WorkBound& bound() const { return bound_; }
  /// Whether no attempt may begin any more. Where there are quads, or a map that they can be made of, half of
  /// what the last one took has to be left, as what was kept often makes another one shorter.
  bool isSpent() const;
  /// From now on what was reserved for the last resort may be spent.
  void beginLastResort();
  /// What the map of the next attempt may take.
  std::size_t allowance() const;
  /// Of the last map or quads that have failed in faces; empty where none have, or it is not known where.
  const FailedFaces& failedFaces() const { return failedFaces_; }
  /// Of all attempts, the first one's "first".
  const std::vector<std::string>& steps() const { return steps_; }
  int replays() const { return replays_; } ///< maps that were carried to the surface
  /// Of all attempts, with those that led to the result.
  TryCounts tries() const;
  /// Sizes of the result's stages, with the seconds of all attempts. Stages that only others have had are one,
  /// "retries".
  StageRecords stages() const;
  double seconds() const; ///< of all attempts
  /// Stages that some attempt has taken over.
  const std::vector<std::string>& reused() const { return all_.reused; }
  /// Stages that the result has computed from an earlier map.
  std::vector<std::string> started() const
  {
    return result().map ? result().map->started : std::vector<std::string>{};
  }

private:
  bool hasSomething() const { return hasResult() || hasMap(); }
  void take(const AttemptLog& log);

  Attempt last_, result_;
  FailedFaces failedFaces_;
  bool roundIsOver_ = true;
  std::size_t beforeRound_ = 0; ///< attempts before this round
  std::vector<std::string> steps_;
  AttemptLog all_; ///< without notices; tries: taken

  WorkBound bound_;
  std::size_t work_ = 0;
  std::size_t workOfLast_ = 0;
  std::size_t attemptsBefore_ = 0;
  int replays_ = 0;
};

} // namespace quadrille
