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

  /// Of all that its result depends on, beside the surface.
  ResultKey key() const;
  /// Throws InvalidInput, with the ids that there are.
  SessionConstraints::iterator find(int id);

private:
  friend struct SessionData;
  mutable std::optional<ResultKey> key_;
};

/// What no result depends on.
struct RunLimits
{
  int threads = 0;
  std::optional<double> memoryLimit;
  ProgressCallback progress;
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
  /// Of the surface under the quads.
  std::shared_ptr<const OnCurves> onCurvesOf(const MadeSurface& made);
  std::shared_ptr<SessionResult> resultOf(const SessionState& state);
  void keep(const SessionState& state, std::shared_ptr<SessionResult> result);
  /// Irregular operations of the present state that are in force.
  std::vector<IrregularEdit::Link> linksInForce() const;

  SurfaceInput surface;
  RunLimits limits;
  int nextId = 1;
  std::vector<std::shared_ptr<SessionState>> history;
  std::size_t at = 0; ///< of the present one
  std::map<std::string, std::shared_ptr<SessionState>> names;
  ResultStore store;   ///< of the runs' stages
  ResultStore results; ///< of states, by their keys
  LinePlacements lines;
  SessionReport stopped; ///< of an update that was
  /// Of one that was stopped with quads; it counts until its state has a result.
  struct
  {
    std::shared_ptr<SessionResult> result;
    ResultKey state = 0;
  } soFar;

private:
  std::unique_ptr<SurfacePlaces> places_; ///< these are made when they are needed first
  std::unique_ptr<SurfacePaths> paths_;
  double area_ = 0, diagonal_ = 0;
};

} // namespace quadrille
