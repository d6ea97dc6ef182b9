// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The only place that orders the stages.
#pragma once

#include "Base/Error.h"
#include "Base/TryCount.h"
#include "Features/GivenUpFeatures.h"
#include "Mesh/Surface.h"
#include "Pipeline/Estimate.h"
#include "Pipeline/FailedParts.h"
#include "Pipeline/Options.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/RunMap.h"
#include "Pipeline/SmallDetails.h"
#include "Pipeline/SmallParts.h"
#include "Pipeline/StageRecords.h"
#include "Prepare/Frame.h"
#include "Transfer/Charts.h"

#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

/// The map is that of the attempt that counts; quads of a preview are without all that tells of the
/// mapped mesh, which is then missing.
struct RemeshResult
  : RunMap
  , RunQuads
{
  Status status;
  FailedParts failed; ///< what has no quads
  /// Where the callback asked to stop and there were quads by then, which are the result with status ok: what was still
  /// being tried. Another run may end with others, so who remembers results must not take it for the final one.
  std::string stopped;
  PreparedSurface
    surface; ///< the finest level that uv belongs to; its hash is that of the surface in its frame
  Frame frame; ///< that the run worked in; all else here is on the user's surface
  /// Of remeshQuads: the finest level in the frame, shared with the store; valid until the next run with that.
  std::shared_ptr<const PreparedSurface> framed;
  /// #V of surface.mesh, in the frame; empty unless mergeCharts, or where mapIsKnown.
  SharedArray<Vector3> framePositions;
  /// Of uv and the surface that it belongs to: where it is the same, they are, but for warm starts.
  ResultKey mapKey = 0;
  bool mapIsKnown = false; ///< whether it is that of RemeshOptions::knownMap
  ChartCounts charts;      ///< of uv; zero unless mergeCharts, or where mapIsKnown
  /// The share of the coarse level's area whose ratio of stretches is above the limit; 0 without limit.
  double beyondAnisotropyLimit = 0;
  SmallParts smallParts;
  std::vector<GivenUpCurve> givenUpFeatures; ///< sharp edges that the quads do not follow
  /// What is smaller than the quads: handles and boundary loops shorter than kQuadsOfLoop s, small components.
  std::vector<SmallDetail> details;
  /// Names of the strategies by which the attempts were made, in their order; the first one's is "first". Where they
  /// began again without details, that of the first one then is "fewer details".
  std::vector<std::string> attempts;
  /// What was tried otherwise, in whatever stage, and how often what was tried is used by this result (see
  /// Base/TryCount.h). What a run takes over from an earlier one below its maps is not counted again.
  TryCounts tries;
  std::size_t work = 0;            ///< of all attempts, see Base/WorkCount.h
  std::vector<StageRecord> stages; ///< see StageRecords; seconds are sums over all attempts
  /// Names of the stages that no attempt has computed, as the store had their results, and of those that started from
  /// an earlier map.
  std::vector<std::string> reused;
  RunEstimate estimate; ///< made before the run
  int decimations =
    0; ///< runs of phase 1; more than one where a map lacked freedom that phase 1 had removed
  int replays = 0; ///< maps carried to the input
  double targetEdgeLength = 0;
  std::size_t targetQuads = 0; ///< predicted from the edge length where none was asked
  std::vector<std::string>
    notices; ///< what the user should know: repairs, raised budgets, refinement

  /// On request, with quads or without.
  bool wasStopped() const { return status.code == StatusCode::Cancelled || !stopped.empty(); }
  /// Whether it could succeed with other constraints: it has failed, and neither on request nor as it would be too
  /// large.
  bool failsAsAsked() const
  {
    return !status.ok() && status.code != StatusCode::Cancelled &&
      status.code != StatusCode::TooLarge;
  }
  /// What a run is that was stopped before it had the quads that were asked for; the estimate stays.
  void becomeStopped()
  {
    const RunEstimate estimated = estimate;
    *this = {};
    estimate = estimated;
    status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
  }
};

/// Runs everything, in coordinates of its own (see Prepare/Frame.h): of a surface that is shifted, scaled or mirrored
/// it makes the same quads, shifted, scaled or mirrored, up to rounding. Throws InvalidInput for bad input or options;
/// any other failure, a stop before there are quads included, is a status and leaves `quads` empty; a stop later keeps
/// the best quads so far, see RemeshResult::stopped. The input's memory (about 30 bytes a triangle) is let go as soon
/// as the surface is prepared: move it in where it is not needed any more. A copy shares it.
RemeshResult remesh(SurfaceInput input, const RemeshOptions& options);

/// The same with a store: what earlier runs have left there is not computed again, and it holds this run's stages
/// afterwards, whatever its status. The result is the same, bit for bit, unless options.warmStart is on. Where there is
/// no room for both the run and the store, that is emptied and a notice says so.
RemeshResult remesh(SurfaceInput input, const RemeshOptions& options, ResultStore& store);

/// The quads alone, for who changes one thing after the other: `surface`, `uv`, `coarse` and what else is of the mapped
/// mesh stay empty, and nothing is copied that the store holds. options: mergeCharts and knownMap do not count. Quads,
/// errors and messages are those of remesh(); sourceFace is that of `framed`, whose corners 1 and 2 change places where
/// its faces run the other way round, as in sourceWeights.
RemeshResult remeshQuads(SurfaceInput input, const RemeshOptions& options, ResultStore& store);

} // namespace quadrille
