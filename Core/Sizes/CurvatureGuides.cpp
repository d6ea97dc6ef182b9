// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizes/CurvatureGuides.h"

#include "Mesh/Surface.h"
#include "Sizes/Curvature.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

/// Radians over an edge from which on a bend counts in full; guides of less weight than the last are none.
constexpr double kFullBend = 0.1;
constexpr double kLeastConfidence = 0.05;

double confidenceOf(const PatchCurvature& curvature, double edgeLength, double leastAnisotropy)
{
  const double bend = std::abs(curvature.largest) * edgeLength;
  return (curvature.anisotropy() - leastAnisotropy) / (1 - leastAnisotropy) *
    std::min(1.0, bend / kFullBend);
}

} // namespace

std::size_t addCurvatureGuides(
  PreparedSurface& surface, double edgeLength, double leastAnisotropy, int threads)
{
  const Mesh& mesh = surface.mesh;
  const SurfacePatches patches = findPatches(mesh, edgeLength / 2, threads);
  const std::vector<PatchCurvature> curvatures =
    patchCurvatures(mesh, patches, edgeLength, threads);
  std::vector<double> confidence;
  confidence.reserve(curvatures.size());
  for (const PatchCurvature& curvature : curvatures)
  {
    confidence.push_back(confidenceOf(curvature, edgeLength, leastAnisotropy));
  }
  Index polygons = 0;
  for (const Index polygon : surface.sourcePolygon)
  {
    polygons = std::max(polygons, polygon + 1);
  }
  // Of the faces of a polygon the first of the largest confidence counts.
  std::vector<Index> best(polygons, kInvalidIndex);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Index patch = patches.patchOf[f];
    Index& chosen = best[surface.sourcePolygon[f]];
    if (confidence[patch] >= kLeastConfidence &&
      (chosen == kInvalidIndex || confidence[patch] > confidence[chosen]))
    {
      chosen = patch;
    }
  }
  for (const PolygonGuide& guide : surface.polygonGuides)
  {
    if (guide.polygon < polygons)
    {
      best[guide.polygon] = kInvalidIndex;
    }
  }
  const std::size_t before = surface.polygonGuides.size();
  for (Index polygon = 0; polygon < polygons; ++polygon)
  {
    const Index patch = best[polygon];
    if (patch != kInvalidIndex && !curvatures[patch].direction.isZero(0))
    {
      surface.polygonGuides.push_back({ polygon, curvatures[patch].direction,
        static_cast<float>(std::min(confidence[patch], 1.0)) });
    }
  }
  std::sort(surface.polygonGuides.begin(), surface.polygonGuides.end(),
    [](const PolygonGuide& a, const PolygonGuide& b) { return a.polygon < b.polygon; });
  return surface.polygonGuides.size() - before;
}

} // namespace quadrille
