// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What one plan leads to: a map of the surface, and its quads. Values, with their own notices and stage records.
#pragma once

#include "Base/Error.h"
#include "Base/TryCount.h"
#include "Pipeline/Levels.h"
#include "Pipeline/Options.h"
#include "Pipeline/Plan.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/RunMap.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/SmallParts.h"
#include "Pipeline/StageRecords.h"
#include "Transfer/PackedMap.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// What all attempts of a run share.
struct RunContext
{
  RemeshOptions options;        ///< lengths in the frame; progress tells `tried`
  double edgeLength = 0;        ///< s, in the frame
  std::size_t targetQuads = 0;  ///< asked for, or predicted from s
  PlannedSurface surface;       ///< without a plan
  ResultStore* store = nullptr; ///< null: none
  Levels levels;
  ShortLoops shortLoops = {};        ///< of the surface before any plan
  std::vector<FixedVec2> spare = {}; ///< see TransferOptions
  /// Whether many details are left that can be taken out where a round has no quads: better than other rounds.
  bool hasCrowd = false;
  bool hasBeside = false; ///< see SizedSurface
  /// Which attempt this is, and why; empty for the first one.
  std::shared_ptr<std::string> tried = std::make_shared<std::string>();
};
RunContext makeRun(const SizedSurface& sized, const RemeshOptions& options, ResultStore* store);

/// What a part of an attempt tells.
struct AttemptLog
{
  TryCounts tries; ///< of its making, whether in this run or in an earlier one
  std::vector<std::string> notices;
  std::vector<std::string> reused;  ///< names of stages that were not computed
  std::vector<std::string> started; ///< names of those that were, from an earlier map
  StageRecords stages;
};

/// What the store has, with its stages as reused, after those that led to it.
template <typename Part>
std::shared_ptr<Part> asReused(const Part& found, const std::vector<std::string>& before)
{
  auto part = std::make_shared<Part>(found);
  part->reused = before;
  for (const StageRecord& record : found.stages.all())
  {
    part->reused.push_back(record.stage);
  }
  part->started.clear();
  part->stages = {};
  return part;
}

/// A map of the coarse level, carried to the surface where there is one.
struct MapAttempt
  : RunMap
  , AttemptLog
{
  ResultKey key = 0;
  Status status;                           ///< of the coarse map
  bool hopeless = false;                   ///< no other triangulation can mend it
  std::vector<std::uint8_t> coarseInteger; ///< #V of coarse.mesh, see integerVertices
  std::vector<Index> failedAt;             ///< vertices of the surface, where the status is not ok
  std::vector<Vector3> failedPlaces;       ///< their positions
  FailedFaces failedFaces;        ///< faces of the surface in which that was, where it was in faces
  std::vector<Index> failedIn;    ///< a vertex of each component of the surface that has no map
  std::size_t work = 0;           ///< see Base/WorkCount.h; of the map of the coarse level
  std::size_t workOfCarrying = 0; ///< of the way to the surface
  bool isInterrupted = false;     ///< as the work was spent

  bool isCarried = false;                  ///< to the surface
  PackedMap packed;                        ///< in place of uv
  std::vector<std::uint8_t> integerVertex; ///< #V of the surface
  std::vector<FaceGuide> guides;           ///< of the surface, for the smoothing, see GuidedMap.h

  /// Of the map on the surface: what keeps it from being valid.
  std::size_t defects() const;
  void pack(const Mesh& surface);
  void unpack(const Mesh& surface);
  std::size_t bytes() const;
};

/// The quads of a map, solved again before on request.
struct QuadAttempt
  : RunQuads
  , AttemptLog
{
  Status status;
  /// Where the map was solved again.
  std::optional<PackedMap> uv;
  std::optional<Certificate> certificate;
  std::vector<Index> failedFaces; ///< of the surface, where the quads are no surface
  std::size_t invertedQuads = 0;
  bool invertedAtFolds = false; ///< some of them where the map has folds

  std::size_t bytes() const;
};

struct Attempt
{
  Plan plan;
  std::shared_ptr<MapAttempt> map;
  std::shared_ptr<const QuadAttempt> quads; ///< null: none were made
};

/// What a plan asks of the levels.
HierarchyOptions levelOptions(const RunContext& run, const Plan& plan);

/// Of all that a map depends on. surface, here and below: with the plan.
ResultKey mapKey(const RunContext& run, const PlannedSurface& surface, const Plan& plan);
/// The map of the store, as a run without one would make it, with its stages as reused; null where there is none.
std::shared_ptr<MapAttempt> findMap(const RunContext& run, ResultKey key, std::size_t allowance);
/// Whether the levels are those of the map: such that were made again may be others than those that a preview has left
/// a map of.
bool isMapOf(const MapAttempt& map, const Hierarchy& levels);
/// Field, seamless map and integers on the coarse level. allowance: work that they may take; a map that would take more
/// is interrupted and has failed.
std::shared_ptr<MapAttempt> makeCoarseMap(RunContext& run, const PlannedSurface& surface,
  const Hierarchy& levels, const Plan& plan, ResultKey key, std::size_t allowance);
/// The map with status ok on the surface.
void carryToSurface(
  RunContext& run, const PlannedSurface& surface, const Hierarchy& levels, MapAttempt& made);
/// In the store, if there is one.
void keepMap(const RunContext& run, const Mesh& surface, MapAttempt& map);

/// The quads of a map that was carried to the surface; the levels are let go.
std::shared_ptr<const QuadAttempt> makeQuads(
  RunContext& run, const PlannedSurface& surface, const Plan& plan, MapAttempt& map);

/// What quads of a map keep of what was asked for. All of these stay for as long as the options do.
ExtractionOptions extractionOptions(
  const PreparedSurface& surface, const RunMap& map, const RemeshOptions& run);

/// The same on the intermediate level, for a preview.
std::shared_ptr<const QuadAttempt> makePreview(
  RunContext& run, const PlannedSurface& surface, const Plan& plan, const MapAttempt& map);

/// Positions of vertices.
std::vector<Vector3> positionsOf(const Mesh& mesh, const std::vector<Index>& vertices);

/// Vertices of the surface where an attempt has failed: those by which its components are told.
std::vector<Index> failedVertices(const Attempt& attempt, const Mesh& surface);
/// Whether p is less than `radius` from one of the places.
bool isNear(const Vector3& p, const std::vector<Vector3>& places, double radius);

} // namespace quadrille
