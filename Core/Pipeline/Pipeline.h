// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The only place that orders the stages.
#pragma once

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Extraction/Extraction.h"
#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Frame.h"
#include "Mesh/Handles.h"
#include "Mesh/Surface.h"
#include "Pipeline/Estimate.h"
#include "Pipeline/FinalQuality.h"
#include "Pipeline/RemeshMemory.h"
#include "Transfer/Charts.h"
#include "Transfer/Transfer.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Exactly one of the three sizes is used: quads, else edgeLength, else relativeEdgeLength.
struct RemeshOptions
{
  std::optional<std::size_t> quads; ///< target number of quads, >= 1
  std::optional<double> edgeLength; ///< target edge length in units of the input, > 0
  double relativeEdgeLength = 0.02; ///< target edge length over the bounding-box diagonal, > 0
  std::optional<double> featureAngle =
    0.6981317007977318; ///< radians (40 degrees); none: no detection
  MapMethod method = MapMethod::ScaleAware;
  /// The coarsest layout of quads in place of their size, see computeCoarsestMap; by the scale aware method only. The size asked for sets
  /// what the levels keep and how curves are followed.
  bool coarsestIntegers = false;
  Index coarseVertices = 1000; ///< budget of the coarse level; 0: as many as its curvature needs
  /// Handles that are shorter round or through than so many target edge lengths are cut and closed before they are mapped, see
  /// closeHandles; >= 0, 0: none. Below kQuadsOfLoop there may remain some that quads cannot resolve.
  double closeHandles = 0;
  /// Connected components with less area than the smallest block of quads has (six for a closed one without handles, see quadsOfBlock)
  /// go, unless all are such. Off: each becomes about that many quads. Both are told.
  bool removeSmallComponents = false;
  /// The ratio of the two stretches of a triangle of the coarse level from which on it is brought down where integers and irregular vertices let
  /// it, see GridMapOptions; >= 1, or 0: no limit. By the scale aware and the seamless method only; final quality does not know it.
  double anisotropyLimit = 0;
  /// The level on which the map is solved again with its integers, see improveMap.
  FinalQuality finalQuality = FinalQuality::Coarse;
  /// The shapes of coarse triangles, to which the map fits its quads, are those of the surface that they stand for: see measureStretch.
  bool distortionMetric = false;
  std::size_t maximumNumberOfQuads = 10000000;
  int smoothingSteps = 5; ///< of the quads on the surface, see ExtractionOptions
  /// Bytes that the run may take by the estimate; none: what the machine has free.
  std::optional<double> memoryLimit;
  bool mergeCharts =
    false;         ///< of the map on the surface, for display; the quads do not depend on it
  int threads = 0; ///< 0: all; the result does not depend on it
  /// With a memory only: field, map and phase 1 may start from those of the run before, so that the result may differ from one without
  /// memory. Off: the same bytes as without.
  bool warmStart = false;
  ProgressCallback progress;
};

/// One stage of the run: names are read, repair, order, connectivity, phase1, phase2, field,
/// seamless, quantize, embed, replay, extract (the benchmark's columns), and refine, handles, metric, certify, optimize, charts.
struct StageRecord
{
  std::string stage;
  double seconds = 0;
  std::size_t elementsIn = 0;
  std::size_t elementsOut = 0;
};

/// So many quads a loop needs, at least, round a handle, through it or round a hole: shorter ones are not resolved.
constexpr double kQuadsOfLoop = 3;

/// What quads of the target edge length s cannot resolve. Measured on the intermediate level, whose edges are about s/2 to s long: loops about
/// as long as 3 s come out a tenth too short, those of one or two s up to 40 %.
struct SmallParts
{
  std::size_t handles = 0; ///< genus, the sum over all components
  std::size_t unresolvedHandles =
    0; ///< those with a loop shorter than kQuadsOfLoop s, see findHandles
  /// The shortest loop round or through a handle, in units of the input; 0 without handles. Above kQuadsOfLoop s another one may be
  /// somewhat shorter.
  double shortestLoop = 0;
  Vector3 place = Vector3::Zero(); ///< the middle of that loop
  bool complete = true;            ///< false: too many to look at all
  BoundaryReport boundary;         ///< of the prepared surface
};

struct RemeshResult
{
  Status status;
  QuadMesh quads;
  PreparedSurface surface;   ///< the finest level that uv belongs to; its hash is that of the surface in its frame
  Frame frame;               ///< that the run worked in; all else here is on the user's surface
  std::vector<Vector3> framePositions; ///< #V of surface.mesh, in the frame; empty unless mergeCharts
  std::vector<FixedVec2> uv; ///< #H of surface.mesh
  std::vector<int> turns;    ///< #V of surface.mesh
  Level coarse;              ///< coarse mesh
  std::vector<FixedVec2>
    coarseUv;                    ///< #H of coarse.mesh; also when the status is not ok, for a look
  std::vector<int> coarseTurns;  ///< #V of coarse.mesh
  Certificate coarseCertificate; ///< of the coarse map
  Certificate certificate;       ///< of the map on the input surface
  ChartCounts charts;            ///< of uv; zero unless mergeCharts
  TransferResult transfer;       ///< counts only, uv is moved out
  ExtractionCounts extraction;   ///< what the map on the surface made necessary
  FinalQualityReport finalQuality; ///< zero unless asked for
  /// The share of the coarse level's area whose ratio of stretches is above the limit; 0 without limit.
  double beyondAnisotropyLimit = 0;
  SmallParts smallParts;
  std::vector<StageRecord> stages;
  /// Names of the stages that a memory had the result of (they are not among `stages`, or without time), or that started from what was
  /// there before (they are). "phase1" only where no attempt had to compute one.
  std::vector<std::string> reused;
  RunEstimate estimate; ///< made before the run
  int decimations =
    0; ///< runs of phase 1; more than one where a map lacked freedom that phase 1 had removed
  int replays = 0; ///< maps carried to the input; seconds of stages are sums over all runs
  double targetEdgeLength = 0;
  std::size_t targetQuads = 0; ///< predicted from the edge length where none was asked
  std::vector<std::string>
    notices; ///< what the user should know: repairs, raised budgets, refinement
};

/// Runs everything, in coordinates of its own (see Mesh/Frame.h): of a surface that is shifted, scaled or mirrored it makes the same quads,
/// shifted, scaled or mirrored, up to rounding. Throws InvalidInput for bad input or options; any other failure, cancel included, is a
/// status and leaves `quads` empty. The input's memory (about 30 bytes a triangle) is let go as soon as the surface is prepared:
/// move it in where it is not needed any more.
RemeshResult remesh(SurfaceInput input, const RemeshOptions& options);

/// The same with a memory, which an earlier run has filled or which is empty; it holds this run's stages afterwards, whatever its status.
/// Where there is no room for both the run and the memory, the memory is emptied and a notice says so.
RemeshResult remesh(SurfaceInput input, const RemeshOptions& options, RemeshMemory& memory);

} // namespace quadrille
