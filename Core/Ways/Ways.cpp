// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ways/Ways.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Pieces/PieceCut.h"
#include "Pieces/SurfacePiece.h"
#include "Quads/PolygonUnder.h"
#include "Requests/SurfacePlaces.h"
#include "Session/DrawnRun.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

/// The triangles of a surface that has nothing else.
class InputTriangles : public TriangleSource
{
public:
  explicit InputTriangles(const SurfaceInput& input) : input_(input) {}

  std::size_t pointCount() const override { return input_.points.size(); }
  std::size_t triangleCount() const override { return input_.polygonOffsets.size() - 1; }
  void corners(std::size_t begin, std::size_t end, Index* ids) const override
  {
    std::copy(input_.polygonPoints.data() + 3 * begin, input_.polygonPoints.data() + 3 * end, ids);
  }
  void positions(const Index* ids, std::size_t count, Vector3* places) const override
  {
    std::transform(ids, ids + count, places, [this](Index id) { return input_.points[id]; });
  }

private:
  const SurfaceInput& input_;
};

bool hasOnlyTriangles(const SurfaceInput& input)
{
  for (std::size_t i = 0; i < input.polygonOffsets.size(); ++i)
  {
    if (input.polygonOffsets[i] != 3 * i)
    {
      return false;
    }
  }
  return true;
}

/// What pieces do not have.
bool asksForMore(const SurfaceInput& input)
{
  return !input.featureEdges.empty() || !input.patchIds.empty() || !input.guideDirections.empty() ||
    !input.targetValences.empty() || !input.sizing.empty() || !input.curves.empty() ||
    !input.drawn.empty() || !input.held.empty() || !input.seams.empty() || !input.straight.empty();
}

void requirePossible(const QuadProblem& problem)
{
  refuseIf(problem.options.preview && problem.symmetry,
    "there is no preview of symmetric quads: switch Preview or Symmetry off");
  refuseIf(problem.options.preview && problem.options.method == MapMethod::Seamless,
    "the method 'seamless' makes no quads, so there is nothing to preview: switch Preview off or "
    "choose another method");
}

/// Why quads need the surface in one place, or the map on its triangles; empty: they do not.
std::string whyInOnePlace(const QuadProblem& problem)
{
  return problem.symmetry                           ? "symmetric quads need the whole surface"
    : problem.options.method == MapMethod::Seamless ? "the method 'seamless' makes no quads"
    : problem.cellsByArea ? "cell data by area need all cells under a quad"
                          : "";
}

std::string whyWhole(const QuadProblem& problem)
{
  const std::string why = whyInOnePlace(problem);
  return !why.empty() ? why
    : problem.options.mergeCharts
    ? "the mapped surface is that of the whole (Compute Mapped Surface)"
    : problem.options.finalQuality == FinalQuality::Input
    ? "final quality on the input needs the map of the whole surface"
    : "";
}

/// Whether thinned triangles would be far fewer. measure: area and diagonal of the surface.
template <class Measure>
bool isFine(double triangles, const RemeshOptions& options, const Measure& measure)
{
  if (options.quads)
  {
    return triangles >= kTrianglesOfQuad * static_cast<double>(*options.quads);
  }
  const auto [area, diagonal] = measure();
  const double s = pieceOptionsOf(options, area, diagonal).edgeLength / kEdgeOfPiece;
  return triangles >= kTrianglesOfQuad * (area / (s * s));
}

/// The triangles of a surface that is cut into pieces, or null.
std::unique_ptr<TriangleSource> trianglesToCut(const QuadProblem& problem)
{
  const GivenSurface& surface = problem.surface;
  const bool isAsked = problem.thinning == Thinning::Always;
  const std::size_t least =
    problem.store != nullptr ? kTrianglesWorthMoreThanLevels : kTrianglesWorthPieces;
  if (problem.thinning == Thinning::Never || (!isAsked && surface.polygons < least))
  {
    return nullptr;
  }
  std::string why = whyWhole(problem);
  why = why.empty() ? surface.whyNotCut : why;
  std::unique_ptr<TriangleSource> triangles = why.empty() ? surface.triangles() : nullptr;
  if (!isAsked)
  {
    const auto measure = [&]
    {
      const SourceExtent extent = extentOf(*triangles, problem.options.threads);
      return std::pair(extent.area, extent.diagonal());
    };
    const bool isWorthIt =
      triangles && isFine(static_cast<double>(surface.polygons), problem.options, measure);
    return isWorthIt ? std::move(triangles) : nullptr;
  }
  why = triangles || !why.empty()
    ? why
    : "it has polygons that are no triangles, or points that are not float or double";
  refuseIf(!triangles, "the surface cannot be cut into pieces: ", why,
    "; set Pieces to Automatic or Never");
  return triangles;
}

/// Of a surface that is not cut, why it is not thinned out as a whole; empty: it is.
std::string whyNotThinned(const QuadProblem& problem, const SurfaceInput& input, bool hasMoves)
{
  std::string why = whyWhole(problem);
  if (!why.empty())
  {
    return why;
  }
  if (problem.store != nullptr)
  {
    return "the levels that are kept for the next edit are those of the whole surface";
  }
  if (hasMoves || !input.held.empty())
  {
    return "irregular vertices are held where they are on the whole surface";
  }
  if (!input.guideDirections.empty() || !input.drawn.strokes.empty())
  {
    return "directions of guides need the freedom that all triangles give";
  }
  const double triangles = static_cast<double>(input.polygonPoints.size()) -
    2 * static_cast<double>(problem.surface.polygons);
  const auto measure = [&]
  {
    requirePolygons(input);
    return std::pair(areaOfPolygons(input), diagonalOf(input.points));
  };
  return problem.thinning != Thinning::Automatic ? "it is to be kept whole"
    : triangles < kTrianglesWorthThinning || !isFine(triangles, problem.options, measure)
    ? "it has few triangles, or few for each quad"
    : "";
}

RemeshOptions optionsOf(const QuadProblem& problem, bool leavesOutFailed, bool hasMoves)
{
  RemeshOptions options = problem.options;
  options.leavesOutFailed = options.leavesOutFailed && leavesOutFailed;
  options.keepsPositions = options.keepsPositions || options.mergeCharts || problem.symmetry ||
    problem.cellsByArea || hasMoves;
  return options;
}

/// Of all of the surface, its triangles thinned out, or the part of a symmetry.
UncutResult remeshUncut(
  SurfaceInput input, const RemeshOptions& options, const QuadProblem& problem, bool isThinned)
{
  if (problem.symmetry)
  {
    return { remeshSymmetric(std::move(input), options, *problem.symmetry, problem.store), {} };
  }
  UncutResult made;
  if (isThinned)
  {
    PiecesResult thinned = remeshThinned(std::move(input), options);
    made.remeshed = std::move(thinned.remeshed);
    made.thinning = std::move(static_cast<MadeThinning&>(thinned));
    return made;
  }
  made.remeshed = problem.store != nullptr ? remesh(std::move(input), options, *problem.store)
                                           : remesh(std::move(input), options);
  return made;
}

/// With a symmetry, or a map that starts from another one, quads depend on more than input and options.
KnownOfMoves knownOfMoves(const QuadProblem& problem)
{
  const bool isAll = !problem.symmetry && !problem.options.warmStart;
  return { isAll ? problem.store : nullptr, problem.places ? problem.places() : nullptr };
}

} // namespace

GivenSurface given(SurfaceInput& input)
{
  GivenSurface surface;
  surface.polygons = input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
  surface.triangles = [&input]
  { return hasOnlyTriangles(input) ? std::make_unique<InputTriangles>(input) : nullptr; };
  surface.whyNotCut = asksForMore(input) ? "what is asked of it constrains the whole surface" : "";
  surface.whole = [&input] { return std::move(input); };
  return surface;
}

std::string whyNotSpread(const QuadProblem& problem)
{
  const std::string why = whyInOnePlace(problem);
  return why.empty() && problem.options.preview ? "a preview has no quads on the surface" : why;
}

QuadsMade remesh(const QuadProblem& problem)
{
  requirePossible(problem);
  QuadsMade made;
  if (const std::unique_ptr<TriangleSource> triangles = trianglesToCut(problem))
  {
    made.way = Way::Pieces;
    PiecesResult result = remeshInPieces(*triangles, optionsOf(problem, false, false));
    made.remeshed = std::move(result.remeshed);
    made.thinning = std::move(static_cast<MadeThinning&>(result));
    return made;
  }
  SurfaceInput input = problem.surface.whole();
  const bool hasMoves = problem.placed != nullptr && asksForMoves(*problem.placed);
  const RemeshOptions options = optionsOf(problem, !problem.symmetry, hasMoves);
  made.whyNotThinned = whyNotThinned(problem, input, hasMoves);
  const bool isThinned = made.whyNotThinned.empty();
  made.way = isThinned ? Way::Thinned : problem.symmetry ? Way::Symmetric : Way::Whole;
  const auto run = [&problem, isThinned](SurfaceInput surface, const RemeshOptions& how)
  { return remeshUncut(std::move(surface), how, problem, isThinned); };
  const bool hasDrawn = problem.placed != nullptr && !problem.placed->empty();
  UncutResult result = hasDrawn
    ? remeshWithDrawn(input, options, run, knownOfMoves(problem), *problem.placed, made.warnings)
    : run(std::move(input), options);
  made.remeshed = std::move(result.remeshed);
  made.thinning = std::move(result.thinning);
  if (problem.symmetry)
  {
    made.symmetry = std::move(static_cast<MadeSymmetry&>(result));
  }
  return made;
}

std::vector<SourceLocation> QuadsMade::pointSources(int threads) const
{
  const QuadMesh& quads = remeshed.quads;
  if (symmetry || thinning)
  {
    return symmetry ? symmetry->pointSources : sourcesOfPoints(*thinning, quads);
  }
  std::vector<SourceLocation> sources(quads.points.size());
  parallelForEach(sources.size(), kMediumChunk, threads,
    [&](std::size_t p)
    { sources[p] = remeshed.surface.locate(quads.sourceFace[p], quads.sourceWeights[p]); });
  return sources;
}

std::vector<Index> QuadsMade::quadPolygons(const std::vector<SourceLocation>& sources) const
{
  const QuadMesh& quads = remeshed.quads;
  if (symmetry)
  {
    return symmetry->quadPolygons;
  }
  std::vector<Index> polygons(quads.quads.size());
  for (std::size_t q = 0; q < polygons.size(); ++q)
  {
    polygons[q] = thinning ? sourceOfQuad(*thinning, quads, sources, q)
                           : polygonUnder(remeshed.surface, quads, q);
  }
  return polygons;
}

Index QuadsMade::polygonOf(Index face) const
{
  const Index polygon = remeshed.surface.sourcePolygon[face];
  return thinning && polygon < thinning->polygonBeside.size() ? thinning->polygonBeside[polygon]
                                                              : polygon;
}

} // namespace quadrille
