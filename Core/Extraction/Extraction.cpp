// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/Extraction.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Extraction/FreeBoundary.h"
#include "Extraction/HoleFilling.h"
#include "Extraction/QuadAssembly.h"
#include "Filling/QuadRepair.h"
#include "Quads/QuadSmoothing.h"
#include "Quads/QuadTopology.h"
#include "Quads/QuadUntangling.h"
#include "Quads/SurfaceShape.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

void checkCorners(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  refuseIf(mesh.faceCount() == 0, "extraction: the mesh has no faces");
  refuseIf(uv.size() != mesh.origin.size() || mesh.twin.size() != mesh.origin.size() ||
      mesh.flags.size() != mesh.origin.size(),
    "extraction: ", uv.size(), " uv for ", mesh.origin.size(), " corners");
}

void checkOutOfRange(const MapCheck& check)
{
  refuseIf(check.outOfRange != kInvalidIndex, "extraction: the map of face ", check.outOfRange / 3,
    ", corner ", check.outOfRange % 3, ", is beyond the range of exact coordinates (2^20 quads)");
}

/// Refuses what would make too many quads, or a map that is nearly all slivers far longer than a
/// quad.
Status checkSize(const MapCheck& check, const Mesh& mesh, const ExtractionOptions& options)
{
  // Four ports a quad have to fit an Index.
  const double limit = std::min(static_cast<double>(options.maximumNumberOfQuads), 5e8);
  std::ostringstream text;
  // An integer-grid map holds a whole number of them; its area is a sum.
  if (std::round(check.area) > limit)
  {
    text << "ask for larger quads, or raise the limit: the map holds about "
         << std::llround(check.area) << " quads, more than the limit of "
         << static_cast<std::size_t>(limit);
  }
  else if (check.extent > 64 * (limit + mesh.faceCount()))
  {
    text << "the map's triangles are " << check.extent / mesh.faceCount()
         << " quads wide on average; it is no map of this surface";
  }
  return { text.str().empty() ? StatusCode::Ok : StatusCode::TooLarge, text.str() };
}

void note(std::string& text, const std::string& more)
{
  text += (text.empty() || more.empty() ? "" : "; ") + more;
}

/// Not ok, with what in the map explains it; ok where there is no problem.
Status statusOf(const std::string& isNot, const std::string& problem, const MapCheck& check)
{
  const std::string cause = check.text();
  return problem.empty() ? Status{}
                         : Status{ StatusCode::NotConverged,
                             isNot + problem + (cause.empty() ? "" : ". The map has " + cause) };
}

/// Of the first few.
std::string describePoints(const QuadMesh& mesh, const std::vector<Index>& points)
{
  const std::vector<Index> few(points.begin(),
    points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), kMostTold)));
  return joined(few, kMostTold, [&](Index p) { return placeText(mesh.points[p]); });
}

/// Compares with the input surface, of whose boundary loops some are covered. Empty when the quad
/// mesh is the same surface.
std::string compareTopology(const TopologySummary& wanted, const QuadMesh& quads,
  const QuadTopology& found, std::size_t coveredLoops)
{
  std::string problem;
  if (!found.manifold())
  {
    note(problem, found.text() + " near " + describePoints(quads, found.defectPoints));
  }
  const auto differ = [&problem](const char* what, long long has, long long should)
  {
    if (has != should)
    {
      note(problem,
        std::string(what) + " " + std::to_string(has) + " instead of " + std::to_string(should));
    }
  };
  const auto covered = static_cast<long long>(coveredLoops);
  differ("Euler characteristic", found.eulerCharacteristic, wanted.eulerCharacteristic + covered);
  differ("components", static_cast<long long>(found.components), wanted.components);
  if (found.manifold())
  {
    differ("boundary loops", static_cast<long long>(found.boundaryLoops),
      wanted.boundaryLoops - covered);
  }
  return problem;
}

CurveGraph lineGraph(const QuadMesh& quads)
{
  std::vector<std::pair<Index, Index>> edges;
  for (const QuadLine& line : quads.lines)
  {
    edges.emplace_back(line.a, line.b);
  }
  return { edges, quads.points.size() };
}

/// Every unit of a constrained isoline must be a line of the quad mesh. Empty when so.
std::string compareLines(
  const CurveGraph& wanted, const QuadMesh& quads, const QuadTopology& found, const MapCheck& check)
{
  std::string problem;
  const auto boundary = static_cast<std::size_t>(std::count_if(
    quads.lines.begin(), quads.lines.end(), [](const QuadLine& line) { return line.boundary; }));
  if (boundary != found.boundaryEdges)
  {
    note(problem,
      std::to_string(found.boundaryEdges) + " boundary edges, of which " +
        std::to_string(boundary) + " lie on the input's boundary");
  }
  // In a fold the length of an edge's image counts there and back.
  const bool folded = check.count[kNotPositive] > 0;
  if (!folded && static_cast<double>(quads.lines.size()) != check.constrainedLength)
  {
    note(problem,
      std::to_string(quads.lines.size()) + " feature and boundary edges instead of " +
        std::to_string(check.constrainedLength));
  }
  if (!(lineGraph(quads) == wanted))
  {
    note(problem, "features or boundaries are interrupted");
  }
  return problem;
}

/// Is this an integer-grid map with a few folds? Only then is a small hole the trace of a fold; in
/// anything else closing holes would make a surface out of noise.
bool isNearlyValid(const MapCheck& check, const Mesh& mesh)
{
  return check.count[kResidual] == 0 && check.count[kFractional] == 0 &&
    check.count[kNotPositive] <= mesh.faceCount() / 50;
}

bool usesFoldedPath(ExtractionPath path, const MapCheck& check)
{
  const bool positive = check.count[kNotPositive] == 0;
  if (path == ExtractionPath::Fast && !positive)
  {
    throw InvalidInput(
      "extraction: the fast path needs a map that is positive everywhere, but it has " +
      check.text() + "; choose the folded path");
  }
  return path == ExtractionPath::Folded || !positive;
}

/// A walk crosses a triangle once on each side of an isoline, where the transitions are whole: so often do isolines of
/// both directions meet the widths of the triangles, which check.extent bounds.
std::size_t largestNumberOfSteps(
  const ExactMap& map, const GridVertices& grid, const MapCheck& check)
{
  return 8 * (static_cast<std::size_t>(check.extent) + map.mesh.faceCount() + grid.portCount());
}

Status windsRound(const MapCheck& check)
{
  return { StatusCode::NotConverged,
    "the isolines wind round the surface without end, no quads were extracted: the map has " +
      check.text() };
}

/// Judges the result: what is wrong with it, and what in the map explains it.
Status judge(const Mesh& mesh, const SurfaceShape& wanted, const MapCheck& check,
  const QuadTopology& found, const ExtractionResult& result)
{
  std::string problem = compareTopology(wanted.topology, result.mesh, found, 0);
  note(problem, compareLines(wanted.curves, result.mesh, found, check));
  if (check.count[kOffIsoline] > result.features.offIsolines.size())
  {
    note(problem,
      "the boundary is off the isolines, where cells that it cuts can be trimmed or kept as "
      "polygons "
      "(boundary mode)");
  }
  if (!result.features.offIsolines.empty())
  {
    note(problem, "features are not reproduced");
  }
  if (problem.empty())
  {
    return {};
  }
  if (result.openPorts > 0 || result.droppedFaces > 0)
  {
    note(problem,
      std::to_string(result.openPorts) + " open grid edges, " +
        std::to_string(result.droppedFaces) + " dropped faces");
  }
  note(problem, result.features.text(mesh));
  return statusOf("the quad mesh is not the input surface: ", problem, check);
}

/// The same where the boundary is free.
Status judgeFree(const Mesh& mesh, const MapCheck& check, const QuadTopology& found,
  const ExtractionResult& result, const FreeBoundaryReport& report,
  const ExtractionOptions& options)
{
  std::string problem;
  if (options.boundary == BoundaryMode::Polygons)
  {
    problem = compareTopology(
      summarizeTopology(mesh, options.threads), result.mesh, found, report.loopsInCells.size());
  }
  else if (!found.manifold())
  {
    problem = found.text() + " near " + describePoints(result.mesh, found.defectPoints);
  }
  else if (result.mesh.quads.empty())
  {
    problem = "no cell of the map is whole";
  }
  // A trimmed mesh cannot be held against the input, so the map must be nearly free of folds.
  if (options.boundary == BoundaryMode::Trimmed && !isNearlyValid(check, mesh))
  {
    note(problem, "the map is no integer-grid map with a few folds");
  }
  const auto count = [&problem](std::size_t number, const char* what)
  {
    if (number > 0)
    {
      note(problem, std::to_string(number) + " " + what);
    }
  };
  count(report.dropped, "cells at the boundary have no simple polygon");
  count(result.droppedFaces, "cells inside are no quads");
  if (check.count[kResidual] + check.count[kFractional] > 0)
  {
    count(result.openPorts, "grid edges end, at the boundary or inside");
  }
  if (!result.features.offIsolines.empty())
  {
    note(problem, result.features.text(mesh));
  }
  return statusOf("the quad mesh is not the input surface up to its boundary: ", problem, check);
}

/// Exact pieces of cells need an exact map without folds.
Status checkForPolygons(const MapCheck& check)
{
  if (check.count[kNotPositive] + check.count[kResidual] + check.count[kFractional] == 0)
  {
    return {};
  }
  return { StatusCode::NotConverged,
    "trim the cells at the free boundary: they can only be kept as polygons where the map is "
    "valid, and it has " +
      check.text() };
}

} // namespace

std::vector<std::pair<std::string, std::size_t>> namedCounts(const ExtractionCounts& counts)
{
  return { { "open_ports", counts.openPorts }, { "zero_sides", counts.zeroSides },
    { "merged_vertices", counts.mergedVertices }, { "zipped_sides", counts.zippedSides },
    { "cancelled_quads", counts.cancelledQuads }, { "dropped_outlines", counts.droppedFaces },
    { "filled_holes", counts.filledHoles } };
}

ExtractionResult extractQuads(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, const ExtractionOptions& options)
{
  checkCorners(mesh, uv);
  const ExactMap map{ mesh, uv };
  ExtractionResult result;

  report(options.progress, 0, "checking the map");
  const MapCheck check = checkMap(map, options.mapIsCertified, options.threads);
  checkOutOfRange(check);
  result.status = checkSize(check, mesh, options);
  if (!result.status.ok())
  {
    return result;
  }

  if (options.boundary == BoundaryMode::Polygons)
  {
    result.status = checkForPolygons(check);
    if (!result.status.ok())
    {
      return result;
    }
  }
  const bool folded =
    options.boundary != BoundaryMode::Polygons && usesFoldedPath(options.path, check);

  report(options.progress, 0.3, "finding grid vertices");
  const GridVertices grid(map, options.threads);

  report(options.progress, 0.5, "following the grid");
  TracingOptions tracing;
  tracing.folded = folded;
  tracing.valid = !folded && check.valid();
  tracing.maximumSteps = largestNumberOfSteps(map, grid, check);
  tracing.threads = options.threads;
  const CellCorners cells = traceCells(map, grid, tracing);
  if (cells.exhausted)
  {
    result.status = windsRound(check);
    return result;
  }

  report(options.progress, 0.7, "assembling quads");
  std::vector<Index> pointOf = assembleQuads(map, grid, cells, { folded, options.threads }, result);
  const bool free = options.boundary != BoundaryMode::Aligned;
  FreeBoundaryReport boundary;
  if (free)
  {
    boundary = treatFreeBoundary(map, grid, cells, options.boundary, pointOf, result);
  }
  else if ((folded || result.droppedFaces > 0) && isNearlyValid(check, mesh))
  {
    result.filledHoles = fillHoles(result.mesh);
  }

  report(options.progress, 0.9, "checking the quads");
  QuadTopology topology = result.mesh.polygonOffsets.empty()
    ? analyzeQuads(result.mesh.quads, result.mesh.points.size(), options.threads)
    : analyzeCells(result.mesh);
  if (free || check.count[kOffIsoline] > 0)
  {
    result.features = findFeatureEnds(map);
  }
  result.status = free
    ? judgeFree(mesh, check, topology, result, boundary, options)
    : judge(mesh, options.shape ? *options.shape : shapeOf(mesh, options.threads), check, topology,
        result);
  result.mesh.valence = std::move(topology.valence);
  result.mesh.onBoundary = std::move(topology.onBoundary);
  if (result.status.ok())
  {
    improveShape(mesh, options, result.mesh);
  }
  report(options.progress, 1, "extraction done");
  return result;
}

void improveShape(const Mesh& mesh, const ExtractionOptions& options, QuadMesh& quads)
{
  SmoothingOptions smoothing;
  smoothing.steps = options.smoothingSteps;
  smoothing.threads = options.threads;
  smoothing.fixedVertices = options.fixedVertices;
  smoothing.progress = [&options](double fraction, const std::string& text)
  { return !options.progress || options.progress(0.9 + 0.1 * fraction, text); };
  smoothing.guides = options.guides;
  smoothQuads(mesh, quads, smoothing);
  if (options.smoothingSteps > 0)
  {
    untangleQuads(mesh, quads, { options.fixedVertices, options.threads });
    if (options.replacesBad)
    {
      repairQuads(mesh, quads, { options.fixedVertices, options.keptChains, options.threads });
      loosenQuads(mesh, quads, { options.fixedVertices, options.threads });
    }
  }
}

} // namespace quadrille
