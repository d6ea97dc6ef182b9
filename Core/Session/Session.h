// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A session: a surface, what is asked of it, and every state that it has been through.
#pragma once

#include "Base/TryCount.h"
#include "Pipeline/Pipeline.h"
#include "Session/Constraints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// A word on one constraint. What could not be measured is not a number.
struct ConstraintReport
{
  int id = 0;
  std::string kind;
  std::string text;                ///< "valence 3", what messages call it
  Vector3 place = Vector3::Zero(); ///< where it deviates most
  bool isMet = false;
  double deviation = 0;   ///< in unit
  double deviation95 = 0; ///< the 95th percentile of what deviation is the mean of
  std::string unit;       ///< "degrees", "edge lengths", "valence", "factor", "diagonals"
  std::string reason;     ///< why it is not met; empty where it is
  /// What else is to be known of it, met or not: how far a chain is from its line, which point lies off the surface.
  std::string remark;
  /// A point that was drawn lies farther than half an edge length off the surface; the remark and a notice say which.
  bool isOffSurface = false;
};

/// What an update did.
struct SessionReport
{
  Status status;                   ///< not ok: there are no quads
  std::vector<StageRecord> stages; ///< that ran, of all runs together
  std::vector<std::string> reused; ///< stages whose results were there; "all": nothing was to do
  /// Of the pipeline: none where nothing was to do, more than one where constraints had to be left out.
  int runs = 0;
  TryCounts tries; ///< of all of them, see Base/TryCount.h
  /// Stopped with the best quads so far, see RemeshResult::stopped: what was still being tried. The next update makes
  /// the state's result.
  std::string stopped;
  double seconds = 0;
  std::vector<std::string> notices;
  std::vector<ConstraintReport> constraints; ///< in the order of the session
};

/// What was made of one state.
struct SessionResult
{
  SessionReport report;
  QuadMesh quads;
  std::vector<IrregularVertex> irregular; ///< in the order of places
  FixedPlaces fixed;
  std::vector<HeldVertex> onFeatures; ///< ends, corners and bends of these, ascending by point
  std::vector<JoinedEnds> joined;     ///< by the connections that have a line
  double targetEdgeLength = 0;
  std::size_t targetQuads = 0;
  std::vector<Index> mirrorPoint;  ///< per point of symmetric quads: its mirror image; else empty
  std::vector<Index> rotatedPoint; ///< the same for a rotation: its image turned by one step

  std::size_t bytes() const;
};

/// By what two states differ.
struct StateComparison
{
  std::vector<std::string> settings;               ///< names, with both values: "quads: 1000, 2000"
  std::vector<int> onlyFirst, onlySecond, changed; ///< ids of constraints
  /// Where both have results.
  struct Results
  {
    std::size_t quads[2] = {}, irregular[2] = {};
    /// The least sum of quarter turns times straight distance that takes the irregular vertices of one to those of the
    /// other; none where they are too many to tell.
    std::optional<double> distance;
    long long unmatched = 0; ///< quarter turns without a partner
  };
  std::optional<Results> results;
};

struct SessionData;

/// Constraints have ids that never change. Every change makes a state, to which one can go back; what was made of a
/// state is remembered, so that going back makes nothing. update() makes what the present state needs, see
/// ResultStore. What is made depends on surface, settings and constraints only, unless warmStart is on.
///
/// Constraints that contradict each other: of two that cannot both be met, the later one is left out, and its word
/// says by which it is kept out. Of guides and sizes the later one counts where they overlap, as paint over paint.
/// Irregular operations act on the irregular vertices that there are when they are added; then all others stay, until
/// a valence is asked for afterwards that the sum of indices does not allow with them: then all that no one names are
/// free.
///
/// A symmetry that the surface has not is left out as others that cannot be met.
///
/// Not for several threads at once.
class Session
{
public:
  /// Throws InvalidInput for an input without polygons, ids out of range, coordinates that are not finite, and
  /// settings as checkOptions does.
  Session(SurfaceInput surface, RemeshOptions settings);
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  const SurfaceInput& surface() const;
  const RemeshOptions& settings() const;
  void setSettings(const RemeshOptions& settings);
  /// What no result depends on: threads, memoryLimit and progress of the settings; they are no state, and those of
  /// settings() and setSettings() do not count.
  int threads() const;
  void setThreads(int threads);
  std::optional<double> memoryLimit() const;
  void setMemoryLimit(std::optional<double> bytes);
  void setProgress(ProgressCallback progress);
  /// Returns its id. Throws InvalidInput as checkConstraint does; an irregular operation is applied to the quads of
  /// the present state, which are made where they are not, and refused where its places or the sum of indices do not
  /// allow it.
  int add(ConstraintContent content);
  /// Its content is replaced, by one of the same kind. Throws InvalidInput for an id that is not there.
  void edit(int id, ConstraintContent content);
  void remove(int id);
  const std::vector<std::shared_ptr<const SessionConstraint>>& constraints() const;

  /// Makes what is not there. A failure of the run is the report's status. A stop on request leaves the state with the
  /// best quads so far, where there are any by then, until another update makes its result; else without one. Throws
  /// InvalidInput for what checkOptions and the surface do not allow.
  const SessionReport& update();
  /// Of the present state; null before its update. After a stop it may be that of the best quads so far, which its
  /// report tells.
  std::shared_ptr<const SessionResult> result() const;
  /// Quads of the present state from the intermediate level, see RemeshOptions::preview, with a report that has no
  /// words on constraints; no irregular vertices. They are not the state's result, but an update() afterwards starts
  /// from their map. A failure, a stop included, is the report's status. Throws InvalidInput as update(), and where a
  /// symmetry is asked for.
  SessionResult preview();

  /// False where there is nothing to go back, or forward, to.
  bool undo();
  bool redo();
  bool canUndo() const;
  bool canRedo() const;

  /// Gives the present state a name; one that is there already is given away.
  void nameState(const std::string& name);
  /// Throws InvalidInput for a name that is not there. Can be undone.
  void goTo(const std::string& name);
  std::vector<std::string> stateNames() const;
  /// Names of states; an empty one is the present state. Throws as goTo.
  StateComparison compare(const std::string& first, const std::string& second) const;

  /// One file with constraints, settings and named states, which refers to the surface by its contents. A file of that
  /// name is replaced at once, or stays as it was. Throws std::runtime_error with the system's reason.
  void save(const std::string& path) const;
  /// Throws InvalidInput, naming the file, for one that is no session, of a later version, damaged, or of another
  /// surface; std::runtime_error where it cannot be read. threads, memoryLimit and progress are not in it.
  static Session load(const std::string& path, SurfaceInput surface);

private:
  explicit Session(std::unique_ptr<SessionData> data);

  std::unique_ptr<SessionData> data_;
};

/// 64 bits over all of the input.
std::uint64_t surfaceHash(const SurfaceInput& surface, int threads);

} // namespace quadrille
