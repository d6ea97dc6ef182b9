// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleStages.h"

#include "Base/Error.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/Frame.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace quadrille
{

namespace
{

double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The surface's area over its sizes.
double areaInSizes(const PreparedSurface& surface)
{
  return surface.mesh.sizing.empty() ? surface.area : sizedArea(surface.mesh);
}

} // namespace

StageClock::StageClock() : last_(now()) {}

void StageClock::lap(const std::string& stage, std::size_t in, std::size_t out)
{
  const double time = now();
  records.push_back({ stage, time - last_, in, out });
  last_ = time;
}

void StageClock::add(const std::string& stage, double seconds, std::size_t in, std::size_t out)
{
  records.push_back({ stage, seconds, in, out });
  last_ = now();
}

TargetSize chooseTarget(const PreparedSurface& surface, const RemeshOptions& options)
{
  TargetSize target;
  if (options.quads)
  {
    target.quads = *options.quads;
    target.edgeLength =
      roundedLength(std::sqrt(areaInSizes(surface) / static_cast<double>(target.quads)));
    return target;
  }
  target.edgeLength =
    options.edgeLength.value_or(
      roundedLength(options.relativeEdgeLength * surface.boundingBoxDiagonal));
  if (!(target.edgeLength > 0) || !std::isfinite(target.edgeLength))
  {
    throw InvalidInput("the target edge length must be a positive number");
  }
  target.quads = predictedQuads(surface, target.edgeLength);
  return target;
}

std::size_t predictedQuads(const PreparedSurface& surface, double edgeLength)
{
  const double quads = areaInSizes(surface) / (edgeLength * edgeLength);
  return static_cast<std::size_t>(std::clamp(quads, 1.0, 1e15));
}

PreparedSurface prepareFromRecipe(const SurfaceInput& input, const SurfaceRecipe& recipe,
  int threads, const ProgressCallback& progress, StageClock& clock)
{
  PrepareOptions options;
  options.featureAngle = recipe.featureAngle;
  options.threads = threads;
  options.progress = progress;
  PreparedSurface surface = prepareSurface(input, options);
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  for (const auto& [name, seconds] : surface.seconds)
  {
    clock.add(name, seconds, polygons, surface.mesh.faceCount());
  }
  return surface;
}

SizingReport refineFromRecipe(PreparedSurface& surface, const SurfaceRecipe& recipe,
  const ProgressCallback& progress, StageClock& clock)
{
  const std::size_t before = surface.mesh.faceCount();
  const SizingReport limited = limitSizeGrowth(surface.mesh, recipe.edgeLength);
  removeUnresolvedFeatures(surface.mesh, recipe.edgeLength);
  refineSurface(surface, recipe.edgeLength, progress);
  clock.lap("refine", before, surface.mesh.faceCount());
  return limited;
}

} // namespace quadrille
