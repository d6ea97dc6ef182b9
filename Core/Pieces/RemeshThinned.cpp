// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Pieces/RemeshInPieces.h"
#include "Pieces/SurfacePiece.h"
#include "Pieces/ThinnedSurface.h"
#include "Pipeline/ConnectionEnds.h"
#include "Pipeline/DropSteps.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/Run.h"
#include "Pipeline/RunResult.h"
#include "Pipeline/SizedSurface.h"

#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// The surface in the frame, thinned out. input: what is drawn is left of it; options: get the number of quads.
ThinnedSurface thinOut(SurfaceInput& input, RemeshOptions& options, SizedSurface& sized)
{
  PreparedSurface fine =
    prepareDrawn(input, options, subProgress(options.progress, 0.0, 0.25, "Preparing: "), sized);
  const std::size_t faces = fine.mesh.faceCount();
  Stopwatch watch;
  PieceOptions piece = pieceOptionsOf(options, fine.area, fine.boundingBoxDiagonal);
  piece.threads = options.threads;
  piece.progress = subProgress(options.progress, 0.25, 0.6, "Thinning: ");
  sized.edgeLength = piece.quadEdge;
  dropSteps(fine, options, sized); // thinned, it is made of cells no more
  ThinnedSurface thinned(std::move(fine), piece);
  sized.stages.add("thin", watch.lap(), faces, thinned.faceCount());
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
  SizedSurface sized;
  ThinnedSurface thinned = thinOut(framed.input, options, sized);
  result.pieces = 1;
  result.joinedTriangles = thinned.faceCount();
  const std::vector<Vector3> userPoints = thinned.userPoints(frame, framed.points);
  options.progress = subProgress(given.progress, 0.6, 0.9);
  std::vector<SmallDetail> closed;
  PreparedSurface surface = thinned.surface(options.threads, closed);
  sized = sizePrepared(std::move(surface), framed.input.drawn, options, std::move(sized));
  remeshSized(sized, frame, options, nullptr, false, made);
  tellClosedHandles(closed, made);
  putOnUserSurface(sized, { frame, {}, userPoints }, options, false, made);
  carryToInput(thinned, userPoints, framed.points, given, made, result);
  if (given.edgeLength && !options.quads)
  {
    made.targetEdgeLength = *given.edgeLength;
  }
}

PiecesResult thinnedOnce(SurfaceInput input, const RemeshOptions& options)
{
  PiecesResult made;
  made.remeshed = guardedRun(input, options, nullptr,
    [&](const RemeshOptions& asked, ResultStore*, PlaceScope& places, RemeshResult& remeshed)
    {
      EnteredInput entered = enterFrame(std::move(input), asked, nullptr);
      runThinned(entered.framed, asked, places, remeshed, made);
    });
  return made;
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
  return remeshWithEnds(
    input, options, thinnedOnce, [](PiecesResult& made) -> RemeshResult& { return made.remeshed; });
}

} // namespace quadrille
