// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Surface.h"

#include "Base/Angles.h"
#include "Base/Clock.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/EdgeRuns.h"
#include "Mesh/Features.h"
#include "Mesh/Repair.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/Triangulate.h"

namespace quadrille
{

namespace
{

void checkOptions(const PrepareOptions& options)
{
  if (options.featureAngle && !(*options.featureAngle > 0 && *options.featureAngle <= kPi))
  {
    throw InvalidInput("the feature angle must be above 0 and at most 180 degrees.");
  }
}

void requireFaces(const PreparedSurface& surface)
{
  if (surface.mesh.origin.empty())
  {
    throw InvalidInput("no face is left of the surface after repair (" + surface.repair.text() +
      "): all polygons are degenerate.");
  }
}

void markFeatures(
  PreparedSurface& surface, const SurfaceInput& input, const PrepareOptions& options)
{
  if (!input.patchIds.empty())
  {
    markFeaturesByPatch(surface, input.patchIds);
  }
  if (options.featureAngle && input.detectedFeatures.empty())
  {
    surface.facets =
      markCreases(surface.mesh, *options.featureAngle, options.threads, input.precision);
  }
  makeFlagsSymmetric(surface.mesh);
}

void measure(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  surface.area = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
  {
    pollNowAndThen(h);
    surface.area += mesh.edgeVector(h).cross(mesh.edgeVector(h + 1)).norm() / 2;
  }
  Vector3 low = mesh.position.front();
  Vector3 high = low;
  for (const Vector3& p : mesh.position)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  surface.boundingBoxDiagonal = (high - low).norm();
}

} // namespace

std::string FacetReport::text() const
{
  if (edges == 0)
  {
    return {};
  }
  return std::to_string(edges) + " sharp edges, one of them near " + placeText(place) +
    ", do not stand out from their surroundings, as the facets of a coarse or noisy surface do "
    "not: they were not used as features "
    "(mark edges to have them followed: Feature Edges, Curves)";
}

SourceLocation PreparedSurface::locate(Index f, const std::array<double, 3>& weights) const
{
  SourceLocation location;
  location.polygon = sourcePolygon[f];
  location.points = sourcePoints[f];
  location.weights = weights;
  if (!refinedEntry.empty() && refinedEntry[f] != kInvalidIndex)
  {
    const auto& corners = cornerWeights[refinedEntry[f]];
    for (std::size_t k = 0; k < 3; ++k)
    {
      location.weights[k] =
        weights[0] * corners[0][k] + weights[1] * corners[1][k] + weights[2] * corners[2][k];
    }
  }
  return location;
}

PreparedSurface prepareSurface(const SurfaceInput& input, const PrepareOptions& options)
{
  PreparedSurface surface;
  Stopwatch watch;
  checkOptions(options);
  report(options.progress, 0, "Checking the surface");
  checkInput(input, options.threads);
  poll();
  triangulate(input, surface);
  requireFaces(surface);
  double repairSeconds = watch.lap();

  report(options.progress, 0.2, "Ordering the surface");
  orderSurface(surface, options.threads);
  surface.repair.isolatedPoints = input.points.size() - surface.mesh.vertexCount();
  const double orderSeconds = watch.lap();

  report(options.progress, 0.5, "Connecting the surface");
  EdgeRuns runs(surface.mesh.origin, surface.mesh.vertexCount(), options.threads);
  const double connectivitySeconds = watch.lap();
  repairSurface(surface, std::move(runs), options.threads);
  poll();
  requireFaces(surface);
  repairSeconds += watch.lap();

  report(options.progress, 0.8, "Finding features");
  markFeatures(surface, input, options);
  measure(surface);
  collectRequests(input, surface, options.threads);
  collectSizing(input, surface);
  surface.hash = contentHash(surface.mesh, options.threads);
  report(options.progress, 1, "Surface prepared");
  surface.seconds = { { "repair", repairSeconds }, { "order", orderSeconds },
    { "connectivity", connectivitySeconds + watch.lap() } };
  return surface;
}

} // namespace quadrille
