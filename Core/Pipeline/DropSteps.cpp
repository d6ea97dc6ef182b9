// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DropSteps.h"

#include "Base/Lists.h"
#include "Details/CellSteps.h"
#include "Features/CreaseCurves.h"
#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Topology.h"
#include "Pipeline/ResultStore.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Runs of a curve are straight: their edges differ by less than 45 degrees in direction.
const double kStraight = std::sqrt(0.5);

/// Whether most of the curve is in straight runs shorter than `smallest`, as the rim of a cylinder of voxels.
bool isJagged(const Mesh& mesh, const CreaseCurve& curve, double smallest)
{
  double all = 0, jagged = 0, run = 0;
  const auto endRun = [&]
  {
    jagged += run < smallest ? run : 0;
    run = 0;
  };
  Vector3 before = Vector3::Zero();
  for (const Index h : curve.halfEdges)
  {
    const Vector3 edge = mesh.edgeVector(h);
    const double length = edge.norm();
    if (std::abs(edge.dot(before)) < kStraight * length * before.norm())
    {
      endRun();
    }
    run += length;
    all += length;
    before = edge;
  }
  endRun();
  return 2 * jagged > all;
}

std::vector<Index> jaggedFeatures(const Mesh& mesh, double edgeLength, double smallest, int threads)
{
  std::vector<Index> features;
  for (const CreaseCurve& curve : traceCreases(mesh, edgeLength, threads))
  {
    if (isJagged(mesh, curve, smallest))
    {
      append(features, curve.halfEdges);
    }
  }
  return features;
}

/// Held vertices without a feature or a boundary are held no more.
void letVerticesGo(PreparedSurface& surface)
{
  const std::vector<std::uint8_t> isOnCurve = constrainedVertices(surface.mesh);
  eraseIf(surface.sectorRequests,
    [&](const SectorRequest& request) { return isOnCurve[request.vertex] == 0; });
}

std::size_t countDetected(const Mesh& mesh)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += isDetectedFeature(mesh, h) ? 1 : 0;
  }
  return count;
}

} // namespace

bool dropSteps(PreparedSurface& surface, const RemeshOptions& options, SizeReport& sized)
{
  const double smallest = options.smallestDetail * sized.edgeLength;
  if (!surface.facets.isOfCells || smallest <= 0)
  {
    return false;
  }
  Mesh& mesh = surface.mesh;
  const std::vector<Index> steps = stepsBelow(mesh, smallest);
  if (steps.empty())
  {
    return false;
  }
  const std::vector<std::uint8_t> before = mesh.flags;
  unmarkFeatures(mesh, steps);
  unmarkFeatures(mesh, jaggedFeatures(mesh, sized.edgeLength, smallest, options.threads));
  FeatureFilterReport filtered = removeUnresolvedFeatures(mesh, smallest, options.threads);
  if (judgesCreases(options))
  {
    removeFalseCreases(mesh, sized.edgeLength, options.threads, filtered);
  }
  surface.facets.isDesigned = false;
  surface.hash = contentHash(mesh, options.threads);
  letVerticesGo(surface);
  const std::vector<Index> lost = lostFeatures(mesh, before);
  append(
    sized.givenUpFeatures, givenUpCurves(mesh, lost, sized.edgeLength, FeatureLoss::Unresolved));
  sized.notices.push_back(std::to_string(lost.size()) +
    " sharp edges are steps between the cells that the surface is made of, lower than these quads, "
    "and no features (" +
    std::to_string(countDetected(mesh)) +
    " are kept): ask for more quads, or lower Smallest Detail (--smallest-detail), to have them "
    "followed");
  return true;
}

void dropSteps(SizedSurface& sized, const RemeshOptions& options)
{
  if (!sized.surface->facets.isOfCells)
  {
    return; // and no copy of the surface is made, which other runs have no use for
  }
  PreparedSurface changed = *sized.surface;
  if (!dropSteps(changed, options, sized))
  {
    return;
  }
  sized.key = KeyMaker(sized.key).add(changed.hash).key();
  sized.surface = std::make_shared<const PreparedSurface>(std::move(changed));
}

} // namespace quadrille
