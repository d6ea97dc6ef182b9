// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What one plan leads to: a map of the surface, and its quads. Values, with their own notices and stage records.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Base/TryCount.h"
#include "Extraction/Extraction.h"
#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Pipeline/FinalQuality.h"
#include "Pipeline/Levels.h"
#include "Pipeline/Options.h"
#include "Pipeline/Plan.h"
#include "Pipeline/RunSurface.h"
#include "Pipeline/SmallParts.h"
#include "Pipeline/StageRecords.h"
#include "Pipeline/WorkBound.h"
#include "Transfer/PackedMap.h"
#include "Transfer/Transfer.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// What all attempts of a run share.
struct RunContext
{
  const RemeshOptions& options;
  double edgeLength = 0;       ///< s, in the frame
  std::size_t targetQuads = 0; ///< asked for, or predicted from s
  RunSurface& surface;
  Levels& levels;
  ResultStore* store = nullptr;      ///< null: none
  ShortLoops shortLoops;             ///< of the surface before any plan
  std::vector<FixedVec2> spare = {}; ///< see TransferOptions
  /// Whether many details are left that can be taken out where a round has no quads: better than other rounds.
  bool hasCrowd = false;
  std::string tried = {}; ///< which attempt this is, and why; empty for the first one
};

/// A map of the coarse level, carried to the surface where there is one.
struct MapAttempt
{
  ResultKey key = 0;
  Status status;          ///< of the coarse map
  bool hopeless = false;  ///< no other triangulation can mend it
  bool collapsed = false; ///< arcs of features leave some coarse triangles no area
  Level coarse;
  std::vector<FixedVec2> coarseUv;         ///< #H of coarse.mesh; also where the status is not ok
  std::vector<int> coarseTurns;            ///< #V of coarse.mesh
  std::vector<std::uint8_t> coarseInteger; ///< #V of coarse.mesh, see integerVertices
  /// Ends, corners and bends of features and boundaries, by vertex of the surface.
  std::vector<SectorRequest> onFeatures;
  Certificate coarseCertificate;
  std::vector<Index> coarseOffenders;  ///< vertices of the surface, where the status is not ok
  std::vector<Vector3> coarseTroubles; ///< their positions
  std::size_t work = 0;                ///< see Base/WorkCount.h; of the map of the coarse level
  bool isInterrupted = false;          ///< as the work was spent
  std::vector<CurveOutcome> curves;    ///< GridMapResult::curves
  std::vector<Index> curveOffenders; ///< GridMapResult::curveOffenders, as vertices of the surface

  // Where the status is ok and the map was carried to the surface, which for a preview it is not.
  bool isCarried = false;
  std::vector<FixedVec2> uv; ///< #H of the surface; empty while packed
  PackedMap packed;
  std::vector<int> turns;                  ///< #V of the surface
  std::vector<std::uint8_t> integerVertex; ///< #V of the surface
  Certificate certificate;
  TransferResult transfer; ///< but for uv

  TryCounts tries; ///< of its making, whether in this run or in an earlier one
  std::vector<std::string> notices;
  std::vector<std::string> reused;  ///< names of stages that were not computed
  std::vector<std::string> started; ///< names of those that were, from an earlier map
  StageRecords stages;

  /// Of the map on the surface: what keeps it from being valid.
  std::size_t defects() const;
  /// Connections and cycles that it does not have.
  std::size_t unmetCurves() const;
  void pack(const Mesh& surface);
  void unpack(const Mesh& surface);
  std::size_t bytes() const;
};

/// The quads of a map, solved again before on request.
struct QuadAttempt
{
  Status status;
  QuadMesh quads;
  ExtractionCounts extraction;
  FinalQualityReport finalQuality;
  /// Where the map was solved again.
  std::optional<PackedMap> uv;
  std::optional<Certificate> certificate;
  std::size_t invertedQuads = 0;
  bool invertedAtFolds = false; ///< some of them where the map has folds
  TryCounts tries;
  std::vector<std::string> notices, reused;
  StageRecords stages;

  std::size_t bytes() const;
};

struct Attempt
{
  Plan plan;
  std::shared_ptr<MapAttempt> map;
  std::shared_ptr<const QuadAttempt> quads; ///< null: none were made
};

/// Adds what the surface's guides, valences and curves ask for.
void addRequests(const PreparedSurface& surface, KeyMaker& key);

/// What a plan asks of the levels. The plan is on the surface.
HierarchyOptions levelOptions(const RunContext& run, const Plan& plan);

/// Levels, map, and map of the surface by the plan, which is put on the surface. allowance: work that the map of the
/// coarse level may take; one that would take more is interrupted and has failed.
std::shared_ptr<MapAttempt> makeMap(
  RunContext& run, const Plan& plan, std::size_t allowance = WorkBound::kNoBound);

/// The quads of a map with status ok, whose plan is on the surface; the levels are let go.
std::shared_ptr<const QuadAttempt> makeQuads(RunContext& run, const Plan& plan, MapAttempt& map);

/// The same on the intermediate level, for a preview.
std::shared_ptr<const QuadAttempt> makePreview(
  RunContext& run, const Plan& plan, const MapAttempt& map);

/// Where quads of the coarse map touch themselves: round a small handle or a thin part, where a loop is one or two
/// quads long, that shows on the coarse map already, and only smaller quads can help. None where this is not the cause
/// of a failure.
std::optional<GridTroubles> gridTroubles(const RunContext& run, const MapAttempt& map);

/// Positions of vertices.
std::vector<Vector3> positionsOf(const Mesh& mesh, const std::vector<Index>& vertices);
/// Whether p is less than `radius` from one of the places.
bool isNear(const Vector3& p, const std::vector<Vector3>& places, double radius);

} // namespace quadrille
