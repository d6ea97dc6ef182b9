// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a session holds.
#pragma once

#include "Pipeline/ResultStore.h"
#include "Requests/SurfacePlaces.h"
#include "Session/ComposedInput.h"
#include "Session/IrregularEdits.h"
#include "Session/Session.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

/// Settings and constraints at one time. It does not change once another one has followed it.
struct SessionState
{
  RemeshOptions settings;
  SessionConstraints constraints;

  /// All that its result depends on, beside the surface.
  const std::string& key() const;
  /// Throws InvalidInput, with the ids that there are.
  SessionConstraints::iterator find(int id);

private:
  friend struct SessionData;
  mutable std::string key_;
};

struct SessionData
{
  /// Throws InvalidInput as Session does.
  explicit SessionData(SurfaceInput input);

  SessionState& now() const { return *history[at]; }
  /// The present state, to be changed.
  SessionState next() const;
  void enter(std::shared_ptr<SessionState> state);
  /// Empty: the present one.
  SessionState& named(const std::string& name) const;
  /// For settings of the session. What it refers to lives as long as this.
  PlacesOfSession places(const RemeshOptions& settings);
  /// What a run has left of the surface, for the next lines; null: nothing.
  void keepSurface(std::shared_ptr<const PreparedSurface> made, const Frame& frame);
  /// Of the surface under the quads; kept until another one comes.
  const OnCurves& onCurvesOf(const MadeSurface& made);
  std::shared_ptr<SessionResult> resultOf(const SessionState& state);
  void keep(const SessionState& state, std::shared_ptr<SessionResult> result);
  /// Irregular operations of the present state that are in force.
  std::vector<IrregularEdit::Link> linksInForce() const;

  SurfaceInput surface;
  int threads = 0;
  std::optional<double> memoryLimit;
  ProgressCallback progress;
  int nextId = 1;
  std::vector<std::shared_ptr<SessionState>> history;
  std::size_t at = 0; ///< of the present one
  std::map<std::string, std::shared_ptr<SessionState>> names;
  ResultStore store;
  LinePlacements lines;
  SessionReport stopped; ///< of an update that was
  /// Of one that was stopped with quads, and the key of its state; they count until that has a result.
  std::shared_ptr<SessionResult> soFar;
  std::string stateOfSoFar;

  struct Kept
  {
    std::shared_ptr<SessionResult> result;
    std::uint64_t lastUse = 0;
  };
  std::map<std::string, Kept> results; ///< by SessionState::key
  std::size_t resultBytes = 0, maximumResultBytes = 0;
  std::uint64_t uses = 0;

private:
  std::unique_ptr<SurfacePlaces> places_; ///< these are made when they are needed first
  std::unique_ptr<SurfacePaths> paths_;
  double area_ = 0, diagonal_ = 0;
  std::unique_ptr<OnCurves> onCurves_; ///< of the surface with the hash
  std::uint64_t onCurvesHash_ = 0;
};

} // namespace quadrille
