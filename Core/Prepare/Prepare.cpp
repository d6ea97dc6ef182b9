// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Prepare.h"

#include "Base/Angles.h"
#include "Base/Clock.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Features/Features.h"
#include "Mesh/ContentHash.h"
#include "Mesh/EdgeRuns.h"
#include "Mesh/PointSets.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/Triangulate.h"
#include "Prepare/CellFaces.h"
#include "Prepare/DegenerateFaces.h"
#include "Prepare/Repair.h"
#include "Requests/Guides.h"

#include <algorithm>

namespace quadrille
{

namespace
{

void checkOptions(const PrepareOptions& options)
{
  refuseIf(options.featureAngle && !(*options.featureAngle > 0 && *options.featureAngle <= kPi),
    "the feature angle must be above 0 and at most 180 degrees.");
}

void requireFaces(const PreparedSurface& surface)
{
  if (surface.mesh.origin.empty())
  {
    throw InvalidInput("give a surface whose polygons have area: no face is left after repair (" +
      surface.repair.text() + "), as all polygons are degenerate.");
  }
}

/// With the points at the corners of each triangle.
std::vector<KnownCurvature> knownCurvatures(const SurfaceInput& input)
{
  std::vector<KnownCurvature> known = input.curvatures;
  refuseIf(!known.empty() && known.size() != input.polygonOffsets.size() - 1,
    "the array of known curvatures has ", known.size(), " values for ",
    input.polygonOffsets.size() - 1, " polygons");
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const Index begin = input.polygonOffsets[i];
    if (input.polygonOffsets[i + 1] - begin == 3)
    {
      std::copy_n(input.polygonPoints.begin() + begin, 3, known[i].points.begin());
    }
  }
  return known;
}

void markFeatures(
  PreparedSurface& surface, const SurfaceInput& input, const PrepareOptions& options)
{
  surface.facets.isDesigned = input.isDesigned;
  if (!input.patchIds.empty())
  {
    markFeaturesByPatch(surface, input.patchIds);
  }
  if (options.featureAngle && input.detectedFeatures.empty())
  {
    surface.facets =
      markCreases(surface.mesh, *options.featureAngle, options.threads, input.precision);
    surface.facets.isOfCells = isMadeOfCells(surface.mesh);
  }
  if (!input.patchIds.empty() || !input.featureEdges.empty())
  {
    makeFlagsSymmetric(surface.mesh); // features by angle are already
  }
}

/// The sum in the order of the faces.
double sumOfAreas(const Mesh& mesh, int threads)
{
  constexpr std::size_t kFacesAtOnce = std::size_t{ 1 } << 19;
  std::vector<double> areas(std::min<std::size_t>(kFacesAtOnce, mesh.faceCount()));
  double area = 0;
  for (std::size_t first = 0; first < mesh.faceCount(); first += kFacesAtOnce)
  {
    const std::size_t count = std::min(kFacesAtOnce, mesh.faceCount() - first);
    parallelForEach(count, kLightChunk, threads,
      [&](std::size_t i)
      {
        const Index h = static_cast<Index>(3 * (first + i));
        areas[i] = mesh.edgeVector(h).cross(mesh.edgeVector(h + 1)).norm() / 2;
      });
    for (std::size_t i = 0; i < count; ++i)
    {
      area += areas[i];
    }
  }
  return area;
}

void measureBox(PreparedSurface& surface, int threads)
{
  const PointBox box = boxOfPoints(surface.mesh.position, threads);
  surface.boundingBoxDiagonal = (box.high - box.low).norm();
}

/// Needs the box.
void mendCaps(PreparedSurface& surface, int threads)
{
  surface.repair.flippedCaps = flipCaps(surface, threads);
  if (surface.repair.flippedCaps > 0)
  {
    orderSurface(surface, threads);
  }
}

} // namespace

PreparedSurface prepareSurface(const SurfaceInput& input, const PrepareOptions& options)
{
  return prepareSurface(SurfaceInput(input), options);
}

PreparedSurface prepareSurface(SurfaceInput&& input, const PrepareOptions& options)
{
  PreparedSurface surface;
  Stopwatch watch;
  checkOptions(options);
  report(options.progress, 0, "Checking the surface");
  checkInput(input, options.threads);
  poll();
  triangulate(input, surface, options.threads);
  requireFaces(surface);
  surface.curvatures = knownCurvatures(input);
  const std::size_t points = input.points.size();
  surface.mesh.position.swap(input.points);
  input.polygonOffsets.clear();
  input.polygonPoints.clear();
  const double repairSeconds = watch.lap();

  report(options.progress, 0.2, "Ordering the surface");
  orderSurface(surface, options.threads);
  surface.repair.isolatedPoints = points - surface.mesh.vertexCount();
  const double orderSeconds = watch.lap();

  report(options.progress, 0.5, "Connecting the surface");
  repairSurface(surface, EdgeRuns(surface.mesh.origin, surface.mesh.vertexCount(), options.threads),
    options.threads);
  poll();
  requireFaces(surface);

  measureBox(surface, options.threads);
  mendCaps(surface, options.threads);
  surface.area = sumOfAreas(surface.mesh, options.threads);
  report(options.progress, 0.8, "Finding features");
  markFeatures(surface, input, options);
  collectRequests(input, surface, options.threads);
  collectSizing(input, surface);
  surface.hash = contentHash(surface.mesh, options.threads);
  report(options.progress, 1, "Surface prepared");
  surface.seconds = { { "repair", repairSeconds }, { "order", orderSeconds },
    { "connectivity", watch.lap() } };
  return surface;
}

} // namespace quadrille
