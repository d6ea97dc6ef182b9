// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Division.h"

#include "Mesh/ComponentSizes.h"
#include "Mesh/SurfaceParts.h"
#include "Pipeline/Strategies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// By component: whether it has one of the vertices.
std::vector<std::uint8_t> componentsOf(
  const std::vector<Index>& vertices, const Mesh& mesh, const ComponentSizes& sizes)
{
  std::vector<Index> componentOfVertex(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    componentOfVertex[mesh.origin[h]] = sizes.componentOfFace[Mesh::face(h)];
  }
  std::vector<std::uint8_t> isHit(sizes.area.size(), 0);
  for (const Index v : vertices)
  {
    isHit[componentOfVertex[v]] = 1;
  }
  return isHit;
}

/// Each that has failed by itself, the others together.
std::vector<Index> failedAlone(const std::vector<std::uint8_t>& isFailed)
{
  const auto failed =
    static_cast<Index>(std::count(isFailed.begin(), isFailed.end(), std::uint8_t{ 1 }));
  std::vector<Index> partOf(isFailed.size(), failed);
  Index next = 0;
  for (std::size_t c = 0; c < isFailed.size(); ++c)
  {
    if (isFailed[c] != 0)
    {
      partOf[c] = next++;
    }
  }
  return partOf;
}

/// Two or more components in two parts, of which each has one.
std::vector<Index> halves(const std::vector<double>& area)
{
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  std::vector<Index> partOf(area.size(), 1);
  double first = 0;
  for (std::size_t c = 0; c + 1 < area.size() && (c == 0 || first + area[c] <= all / 2); ++c)
  {
    partOf[c] = 0;
    first += area[c];
  }
  return partOf;
}

} // namespace

SizedPart partOf(const SizedSurface& whole, ComponentPart part, double share)
{
  SizedPart made;
  made.share = share;
  made.curves = std::move(part.curves);
  SizedSurface& sized = made.sized;
  sized.edgeLength = whole.edgeLength;
  sized.quadsOfWhole = whole.quadsOfAll();
  sized.targetQuads = static_cast<std::size_t>(
    std::max(1.0, std::round(share * static_cast<double>(whole.targetQuads))));
  sized.key = KeyMaker(whole.key).add(part.surface.hash).key();
  sized.surface = std::make_shared<const PreparedSurface>(std::move(part.surface));
  return made;
}

bool isDivided(const SizedSurface& sized, const History& history)
{
  return sized.surface->components > 1 && !history.hasResult() && !isTooLarge(history.last());
}

std::vector<SizedPart> divide(
  const SizedSurface& whole, const std::vector<Index>& failed, int threads)
{
  const PreparedSurface& surface = *whole.surface;
  const ComponentSizes sizes = measureComponents(surface.mesh, threads);
  const std::vector<Index> partOf =
    failed.empty() ? halves(sizes.area) : failedAlone(componentsOf(failed, surface.mesh, sizes));
  const std::size_t count = std::size_t{ *std::max_element(partOf.begin(), partOf.end()) } + 1;
  std::vector<Index> partOfFace(surface.mesh.faceCount());
  std::transform(sizes.componentOfFace.begin(), sizes.componentOfFace.end(), partOfFace.begin(),
    [&](Index c) { return partOf[c]; });
  std::vector<ComponentPart> surfaces = splitSurface(surface, partOfFace, count, threads);

  const double all = std::accumulate(sizes.area.begin(), sizes.area.end(), 0.0);
  std::vector<double> share(count, 0);
  for (Index c = 0; c < partOf.size(); ++c)
  {
    share[partOf[c]] += sizes.area[c] / all;
    ++surfaces[partOf[c]].surface.components;
  }
  std::vector<SizedPart> parts;
  for (std::size_t i = 0; i < count; ++i)
  {
    parts.push_back(quadrille::partOf(whole, std::move(surfaces[i]), share[i]));
    parts.back().sized.hasBeside = whole.hasBeside;
  }
  return parts;
}

} // namespace quadrille
