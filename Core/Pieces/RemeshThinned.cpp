// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Pieces/RemeshInPieces.h"
#include "Pieces/SurfacePiece.h"
#include "Pieces/ThinnedSurface.h"
#include "Pipeline/DrawnOnSurface.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/Run.h"
#include "Pipeline/RunResult.h"
#include "Prepare/Prepare.h"

#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// What is drawn as features and sizes, on the surface itself. asked: of which the rest is there no more.
void draw(PreparedSurface& surface, const SurfaceInput& asked, const RemeshOptions& options,
  StageRecords& stages, std::vector<std::string>& notices)
{
  if (!changesSurface(asked.drawn))
  {
    return;
  }
  Stopwatch watch;
  const std::size_t before = surface.mesh.faceCount();
  const double edgeLength =
    targetEdgeLength(options, areaOverSizes(surface), surface.boundingBoxDiagonal);
  drawOn(surface, asked, edgeLength, options.threads, notices);
  stages.add("draw", watch.lap(), before, surface.mesh.faceCount());
}

/// The surface in the frame, thinned out. input: what is drawn is left of it.
ThinnedSurface thinOut(SurfaceInput& input, const RemeshOptions& options, StageRecords& stages,
  std::vector<std::string>& notices)
{
  PrepareOptions prepare;
  prepare.featureAngle = options.featureAngle;
  prepare.threads = options.threads;
  prepare.progress = subProgress(options.progress, 0.0, 0.25, "Preparing: ");
  const std::size_t polygons = input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
  SurfaceInput later;
  later.drawn = input.drawn;
  later.sizingOrders = input.sizingOrders;
  PreparedSurface fine = prepareSurface(std::move(input), prepare);
  input = std::move(later);
  for (const auto& [name, seconds] : fine.seconds)
  {
    stages.add(name, seconds, polygons, fine.mesh.faceCount());
  }
  draw(fine, input, options, stages, notices);
  const std::size_t faces = fine.mesh.faceCount();
  Stopwatch watch;
  PieceOptions piece = pieceOptionsOf(options, fine.area, fine.boundingBoxDiagonal);
  piece.threads = options.threads;
  piece.progress = subProgress(options.progress, 0.25, 0.6, "Thinning: ");
  ThinnedSurface thinned(std::move(fine), piece);
  stages.add("thin", watch.lap(), faces, thinned.faceCount());
  return thinned;
}

/// Points of the quads go from the thinned surface, where result has them, to that of the user.
void carryToInput(ThinnedSurface& thinned, const std::vector<Vector3>& userPoints,
  const std::vector<Vector3>& points, const RemeshOptions& options, RemeshResult& made,
  PiecesResult& result)
{
  result.polygonBeside = thinned.polygonsBeside();
  thinned.putOnInput(made.failed);
  if (!made.status.ok() || options.preview)
  {
    return;
  }
  Stopwatch watch;
  ThinnedSurface::Places places = thinned.carry(made.quads, made.surface, userPoints,
    options.threads, subProgress(options.progress, 0.9, 1.0, "Carrying points: "));
  putOnInput(places.ofPoints, points, made.quads.points);
  result.pointSource = std::move(places.ofPoints);
  result.quadSource = std::move(places.ofQuads);
  made.stages.push_back(
    { "carry", watch.lap(), result.pointSource.size(), result.quadSource.size() });
}

/// What is in the frame already. result: all but what remesh() makes.
void runThinned(FramedInput& framed, const RemeshOptions& given, PlaceScope& places,
  RemeshResult& made, PiecesResult& result)
{
  const Frame& frame = framed.frame;
  places.set(frame.centre, frame.unit, frame.sign);
  RemeshOptions options = optionsInFrame(given, frame);
  options.mergeCharts = false;
  StageRecords stages;
  std::vector<std::string> notices;
  ThinnedSurface thinned = thinOut(framed.input, options, stages, notices);
  result.pieces = 1;
  result.joinedTriangles = thinned.faceCount();
  const std::vector<Vector3> userPoints = thinned.userPoints(frame, framed.points);
  options.progress = subProgress(given.progress, 0.6, 0.9);
  std::vector<SmallDetail> closed;
  PreparedSurface surface = thinned.surface(options.threads, closed);
  SizedSurface sized =
    sizePrepared(std::move(surface), framed.input.drawn.valences, stages, options);
  sized.notices.insert(sized.notices.begin(), notices.begin(), notices.end());
  remeshSized(sized, frame, options, nullptr, false, made);
  tellClosedHandles(closed, made);
  putOnUserSurface(sized, { frame, {}, userPoints }, options, false, made);
  carryToInput(thinned, userPoints, framed.points, given, made, result);
  if (given.edgeLength && !options.quads)
  {
    made.targetEdgeLength = *given.edgeLength;
  }
}

} // namespace

PiecesResult remeshThinned(SurfaceInput input, const RemeshOptions& options)
{
  refuseIf(!input.guideDirections.empty() || !input.drawn.strokes.empty(),
    "directions of guides need the freedom that all triangles give: do not have the surface "
    "thinned out.");
  refuseIf(!input.held.empty() || !input.seams.empty() || !input.straight.empty(),
    "vertices that are held, and parts of the boundary that are straight or images of each other, "
    "are those of the whole surface: do not have it thinned out.");
  PiecesResult made;
  made.remeshed = guardedRun(input, options, nullptr,
    [&](const RemeshOptions& asked, ResultStore*, PlaceScope& places, RemeshResult& remeshed)
    {
      EnteredInput entered = enterFrame(std::move(input), asked, nullptr);
      runThinned(entered.framed, asked, places, remeshed, made);
    });
  made.estimate = made.remeshed.estimate;
  return made;
}

} // namespace quadrille
