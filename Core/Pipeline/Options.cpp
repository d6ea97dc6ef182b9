// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Options.h"

#include "Base/Error.h"
#include "GridMap/MapShape.h"

#include <cmath>

namespace quadrille
{

void checkOptions(const RemeshOptions& options)
{
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (options.coarsestIntegers && options.method != MapMethod::ScaleAware)
  {
    throw InvalidInput("the coarsest integers need the scale aware method");
  }
  if (options.quads && *options.quads < 1)
  {
    throw InvalidInput("the target number of quads must be at least 1");
  }
  if (options.edgeLength && !positive(*options.edgeLength))
  {
    throw InvalidInput("the target edge length must be a positive number");
  }
  if (!options.quads && !options.edgeLength && !positive(options.relativeEdgeLength))
  {
    throw InvalidInput("the relative target edge length must be a positive number");
  }
  if (options.featureAngle && !(*options.featureAngle > 0 && *options.featureAngle <= kPi))
  {
    throw InvalidInput("the feature angle must be above 0 and at most 180 degrees");
  }
  if (options.memoryLimit && !positive(*options.memoryLimit))
  {
    throw InvalidInput("the memory limit must be a positive number of bytes");
  }
  checkAdaptiveSizes(options.sizes);
  if (options.curvatureGuides && !(*options.curvatureGuides >= 0 && *options.curvatureGuides < 1))
  {
    throw InvalidInput("the least anisotropy of curvature for guides must be from 0 to below 1");
  }
  checkAnisotropyLimit(options.anisotropyLimit);
  if (options.anisotropyLimit > 0 &&
    (options.method == MapMethod::MixedInteger || options.method == MapMethod::QuadCover))
  {
    throw InvalidInput("an anisotropy limit needs the scale aware or the seamless method");
  }
  if (!(options.smallestDetail >= 0 && std::isfinite(options.smallestDetail)))
  {
    throw InvalidInput("the smallest detail must be 0 or a positive number of edge lengths");
  }
  if (options.coarseVertices != 0 && options.coarseVertices < 4)
  {
    throw InvalidInput(
      "the coarse level needs at least 4 vertices, or 0 for as many as the curvature needs");
  }
}

bool isRounded(MapMethod method)
{
  return method == MapMethod::MixedInteger || method == MapMethod::QuadCover;
}

} // namespace quadrille
